#pragma once
#include <filesystem>
#include <string>

namespace tessera {

/// Checks before a long run that its folder can be written, without creating it. `key` is what names the folder in
/// messages. Throws InputError.
void check_output_folder(const std::filesystem::path& folder, const std::string& key = "output.folder");

}  // namespace tessera
