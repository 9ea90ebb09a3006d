#pragma once

namespace tessera {

/// The project's version. CMakeLists.txt reads it here.
constexpr const char* version = "0.1.0";
constexpr int version_major = 0;
constexpr int version_minor = 1;
constexpr int version_patch = 0;

}  // namespace tessera
