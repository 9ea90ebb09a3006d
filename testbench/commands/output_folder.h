#pragma once
#include <filesystem>
#include <string>

namespace tessera {

/// Finds out before a long run whether its folder can be written, and leaves no trace: a run that fails leaves nothing.
/// `key` is what names the folder, for messages. Throws InputError.
void check_output_folder(const std::filesystem::path& folder, const std::string& key = "output.folder");

}  // namespace tessera
