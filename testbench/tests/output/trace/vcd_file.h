#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace tessera {

/// A value change dump read back; requires it to be well-formed.
struct VcdFile {
    struct Signal {
        unsigned bits = 0;
        std::uint64_t initial = 0;
        std::vector<std::pair<std::uint64_t, std::uint64_t>> changes;  ///< time and value, after the first time stamp

        std::uint64_t at(std::uint64_t time) const;
        /// For a signal of one bit: the number of cycles in which it is 1.
        std::uint64_t high_cycles(std::uint64_t period, std::uint64_t end_time) const;
    };

    explicit VcdFile(const std::filesystem::path& file);

    /// Looks up a signal by name, for example "tessera.transform.state".
    const Signal& operator[](const std::string& name) const;

    std::map<std::string, Signal> signals;
    std::uint64_t begin = 0, end = 0;  ///< first and last time stamp
};

}  // namespace tessera
