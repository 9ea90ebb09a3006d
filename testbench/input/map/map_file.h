#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tessera {

/// Largest PGM file, read into memory whole. The largest tidy P2 file of 4096 x 4096 texels has 96 MiB. EXR and PNG
/// files are read piecemeal: no limit.
inline constexpr std::uint64_t largest_map_file = 192ULL << 20;

/// The regular file's size in bytes. Throws InputError if there is none, or it is a directory, pipe, ...
std::uint64_t map_file_size(const std::filesystem::path& path);

/// The file's first bytes, at most `count`.
std::string map_file_start(const std::filesystem::path& path, std::size_t count);

/// The whole file. Throws InputError beyond largest_map_file.
std::string map_file_bytes(const std::filesystem::path& path);

/// Throws InputError unless both sides are in 1..largest_map_side. `what` begins the sentence: a file's name
/// or "the built-in map".
void check_map_sides(std::string_view what, std::int64_t width, std::int64_t height);

/// Foreign text for a message: control and non-ASCII characters become '?', long text is cut.
std::string printable_ascii(std::string_view text);

}  // namespace tessera
