#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tessera {

/// Largest PGM file, which is read into memory as a whole. A P2 file of 4096 x 4096 texels with single separators has
/// at most 96 MiB. EXR and PNG files are read in pieces, without a limit.
inline constexpr std::uint64_t largest_map_file = 192ULL << 20;

/// ".png" of a file named PICTURE.PNG.
std::string lower_case_extension(const std::filesystem::path& path);

/// Size of a regular file in bytes. Throws InputError if it does not exist or is not a regular file.
std::uint64_t map_file_size(const std::filesystem::path& path);

/// The file's first bytes, at most `count`.
std::string map_file_start(const std::filesystem::path& path, std::size_t count);

/// The whole file. Throws InputError beyond largest_map_file.
std::string map_file_bytes(const std::filesystem::path& path);

/// Throws InputError unless both sides are in 1..largest_map_side. `what` is the message's subject: a file's name or
/// "the built-in map".
void check_map_sides(std::string_view what, std::int64_t width, std::int64_t height);

/// Text from a file for a message: control and non-ASCII characters become '?', long text is truncated.
std::string printable_ascii(std::string_view text);

}  // namespace tessera
