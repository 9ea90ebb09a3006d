#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "testbench/tests/support/source_folder.h"
#include "testbench/tests/support/test_folder.h"

namespace tessera::testing {

enum class SectionEnd { of_document, empty_line };

/// Requires that a document, named relative to the source folder, has this text below a heading. With TESSERA_WRITE in
/// the environment the test writes the text there instead.
inline void expect_section(const std::string& name, const std::string& heading, const std::string& text,
                           SectionEnd end = SectionEnd::of_document) {
    const std::filesystem::path path = source_folder() / name;
    std::string document = read_all(path);
    const std::size_t begin = document.find(heading);
    REQUIRE(begin != std::string::npos);
    const std::size_t from = begin + heading.size();
    const std::size_t to = end == SectionEnd::of_document
                               ? document.size()
                               : std::min(document.find("\n\n", from), document.size() - 1) + 1;
    if (std::getenv("TESSERA_WRITE") != nullptr) {
        write_all(path, document.replace(from, to - from, text));
        return;
    }
    INFO(path << " says something else; TESSERA_WRITE=1 has the test write it");
    CHECK((document.substr(from, to - from) == text));  // extra parentheses: nothing is printed
}

/// The text of all tests, in which a document's names of tests are looked for.
inline std::string all_test_sources() {
    std::string text;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source_folder() / "testbench/tests"))
        if (const auto extension = entry.path().extension(); extension == ".cpp" || extension == ".h")
            text += read_all(entry.path());
    return text;
}

}  // namespace tessera::testing
