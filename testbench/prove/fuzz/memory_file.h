#pragma once
#include <filesystem>
#include <string_view>

namespace tessera::fuzz {

/// The path of this process's file in memory, which contains these bytes until the next call. For readers that take a
/// path: uses neither the disk nor a name shared with other processes. Linux only.
const std::filesystem::path& file_of(std::string_view bytes);

}  // namespace tessera::fuzz
