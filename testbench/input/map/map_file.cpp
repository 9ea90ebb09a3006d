#include "testbench/input/map/map_file.h"

#include <fmt/format.h>

#include <cctype>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "testbench/common/error.h"
#include "testbench/setup/height_map.h"

namespace tessera {
namespace {

std::ifstream open_file(const std::filesystem::path& path) {
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw InputError(fmt::format("{}: the map file cannot be opened: {}.", path.string(),
                                     std::generic_category().message(errno)));
    }
    return file;
}

}  // namespace

std::string lower_case_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

std::uint64_t map_file_size(const std::filesystem::path& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found)
        throw InputError(fmt::format("{}: there is no such map file. Check map.file.", path.string()));
    // Reading a pipe or device may block or never end.
    if (error || status.type() != std::filesystem::file_type::regular) {
        throw InputError(
            fmt::format("{}: the map is not a regular file. Name an EXR, PNG or PGM file.", path.string()));
    }
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error)
        throw InputError(fmt::format("{}: the map file cannot be examined: {}.", path.string(), error.message()));
    return size;
}

std::string map_file_start(const std::filesystem::path& path, std::size_t count) {
    std::ifstream file = open_file(path);
    std::string start(count, '\0');
    file.read(start.data(), static_cast<std::streamsize>(count));
    start.resize(static_cast<std::size_t>(file.gcount()));
    return start;
}

std::string map_file_bytes(const std::filesystem::path& path) {
    const std::uint64_t size = map_file_size(path);
    if (size > largest_map_file) {
        throw InputError(
            fmt::format("{}: the map file has {} bytes; PGM files may have {}. A map of {} x {} "
                        "texels fits into that, so save it without padding or comments.",
                        path.string(), size, largest_map_file, largest_map_side, largest_map_side));
    }
    std::string bytes = map_file_start(path, static_cast<std::size_t>(size));
    if (bytes.size() != size) {
        throw InputError(
            fmt::format("{}: only {} of the map file's {} bytes could be read.", path.string(), bytes.size(), size));
    }
    return bytes;
}

void check_map_sides(std::string_view what, std::int64_t width, std::int64_t height) {
    if (width < 1 || height < 1 || width > largest_map_side || height > largest_map_side) {
        throw InputError(fmt::format(
            "{}: the map is {} x {} texels; each side must be 1 to {}. {}", what, width, height, largest_map_side,
            width < 1 || height < 1 ? "Correct the size, or name another file." : "Scale it down or cut it."));
    }
}

std::string printable_ascii(std::string_view text) {
    constexpr std::size_t longest = 200;
    std::string result(text.substr(0, longest));
    for (char& c : result)
        if (c < ' ' || c > '~')
            c = '?';
    return text.size() > longest ? result + "..." : result;
}

}  // namespace tessera
