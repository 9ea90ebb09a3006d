#pragma once
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "testbench/tests/support/source_folder.h"

namespace tessera {

/// NAME in the data folder next to the checkout, ../shared/data; empty if it is absent. The calling test then returns
/// without any check: ctest counts a test that prints these words as skipped (CMakeLists.txt).
inline std::filesystem::path shared_data(const std::string& name = ".") {
    std::filesystem::path path = source_folder() / "../shared/data" / name;
    if (std::filesystem::exists(path))
        return path.lexically_normal();
    WARN("this test is skipped: ../shared/data/" << name << " is absent");
    return {};
}

}  // namespace tessera
