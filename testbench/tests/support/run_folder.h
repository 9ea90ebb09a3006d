#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tessera {

nlohmann::ordered_json read_json(const std::filesystem::path& file);

/// The header of a PLY file, and sums over its faces.
struct PlyFacts {
    std::uint64_t vertices = 0, faces = 0;
    std::map<int, std::uint64_t> by_generation;
};

/// The files of a run, read back; requires each to be well-formed.
class RunFolder {
  public:
    explicit RunFolder(std::filesystem::path folder);

    std::uint64_t count(const std::string& group, const std::string& name) const;
    std::uint64_t invariant(const std::string& name) const;
    /// The statistics' group "mesh", by generation.
    std::map<int, std::uint64_t> by_generation() const;
    PlyFacts read_ply() const;
    std::uint64_t obj_faces() const;
    struct Row {
        std::string name, value, unit, description;
    };
    /// The rows of statistics.csv without its heading.
    std::vector<Row> read_csv() const;
    /// The content of every file, by name.
    std::map<std::string, std::string> files() const;

    nlohmann::ordered_json statistics, conformance;

  private:
    std::filesystem::path folder_;
};

/// Requirements on every run that ended with exit code 0, for any job: its files exist and its figures agree.
void require_consistent(const RunFolder& run);

/// Requires equal names and bytes; reports the files that differ.
void require_same_files(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b);

}  // namespace tessera
