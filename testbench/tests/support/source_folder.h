#pragma once
#include <filesystem>

namespace tessera {

/// The project's source folder.
std::filesystem::path source_folder();

}  // namespace tessera
