// The fuzzers' seeds and findings, run through the same checks (testbench/prove/fuzz) in every build.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "testbench/prove/fuzz/fuzz_target.h"
#include "testbench/tests/support/source_folder.h"

using namespace tessera;
namespace fs = std::filesystem;

namespace {

fs::path corpus() {
    return source_folder() / "testbench/prove/fuzz/corpus";
}

std::vector<fs::path> files_of(const fuzz::FuzzTarget& target) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(corpus() / target.name))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void run_corpus(std::string_view name) {
    const auto& targets = fuzz::fuzz_targets();
    const auto target =
        std::find_if(targets.begin(), targets.end(), [&](const fuzz::FuzzTarget& each) { return each.name == name; });
    REQUIRE(target != targets.end());
    const std::vector<fs::path> files = files_of(*target);
    REQUIRE_FALSE(files.empty());
    for (const fs::path& file : files) {
        INFO(file.filename());
        CHECK_NOTHROW(target->check(bytes_of(file)));
    }
    CHECK_NOTHROW(target->check({}));
}

}  // namespace

TEST_CASE("fuzz corpus: OBJ") {
    run_corpus("obj");
}
TEST_CASE("fuzz corpus: PLY of a run") {
    run_corpus("ply");
}
TEST_CASE("fuzz corpus: PGM map") {
    run_corpus("map");
}
TEST_CASE("fuzz corpus: TOML of a job") {
    run_corpus("toml");
}
TEST_CASE("fuzz corpus: TOML of a surface") {
    run_corpus("surface");
}

TEST_CASE("fuzz corpus: a folder for each target and nothing else, with small files, below 1 MiB in total") {
    std::size_t folders = 0;
    std::uintmax_t total = 0;
    for (const auto& entry : fs::recursive_directory_iterator(corpus())) {
        folders += entry.is_directory();
        if (!entry.is_regular_file() || entry.path().filename() == "README.md")
            continue;
        INFO(entry.path());
        CHECK(entry.file_size() <= 4096);
        total += entry.file_size();
    }
    CHECK(folders == fuzz::fuzz_targets().size());
    CHECK(total < std::uintmax_t{1} << 20);
}

TEST_CASE("fuzz corpus: the checks detect broken guarantees") {
    using fuzz::BrokenPromise;
    CHECK_THROWS_AS(fuzz::promise(false, "kept"), BrokenPromise);
    CHECK_THROWS_AS(fuzz::promise_message("other: text", "file"), BrokenPromise);
    CHECK_THROWS_AS(fuzz::promise_message("file", "file"), BrokenPromise);
    CHECK_THROWS_AS(fuzz::promise_message("file: ", "file"), BrokenPromise);
    CHECK_THROWS_AS(fuzz::promise_message("file: \x1b[31m", "file"), BrokenPromise);
    CHECK_THROWS_AS(fuzz::promise_message("file: \xff", "file"), BrokenPromise);
    CHECK_NOTHROW(fuzz::promise_message("file: \xc3\xa4\nfile: more", "file"));
}
