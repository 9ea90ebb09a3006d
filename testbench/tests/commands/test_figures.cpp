#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <regex>

#include "testbench/tests/support/checkout.h"
#include "testbench/tests/support/program_runner.h"

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const std::string experiment = "scripts/figures --only curved_surfaces --picture-width 320";

std::size_t times(const std::string& text, const std::string& words) {
    std::size_t count = 0;
    for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1))
        ++count;
    return count;
}

}  // namespace

TEST_CASE("figures: the page contains the results of the runs") {
    const Checkout checkout;
    const ProgramEnd end = checkout.run(experiment);
    INFO(end.text());
    REQUIRE(end.exit_code == 0);
    const fs::path folder = checkout.root() / "runs/figures_only";
    const std::string page = read_all(folder / "index.html");
    CHECK(times(page, "<span class=\"verdict reproduced\">") == 2);  // summary and section
    CHECK(times(page, "<img src=\"data:image/png;base64,") == 6);
    CHECK(times(page, "<img ") == 6);
    CHECK_FALSE(std::regex_search(page, std::regex("(src|href)=\"(http|/|\\.)")));
    CHECK(times(page, checkout.root().string()) == 0);
    CHECK(times(page, source_folder().string()) == 0);

    const auto statistics = nlohmann::json::parse(read_all(folder / "runs/curved_surfaces/hills/run/statistics.json"));
    const long triangles = statistics["mesh"]["triangles"]["value"];
    const std::vector<std::string> rows = lines_of(read_all(folder / "tables/curved_surfaces.csv"));
    REQUIRE(rows.size() == 4);
    CHECK_THAT(rows[2], Contains("," + std::to_string(triangles) + ","));

    const ProgramEnd again = checkout.run(experiment);
    REQUIRE(again.exit_code == 0);
    CHECK_THAT(again.err, !Contains(" runs"));  // nothing runs twice
    CHECK(read_all(folder / "index.html") == page);
    fs::remove_all(folder / "results");
    const ProgramEnd anew = checkout.run(experiment);
    REQUIRE(anew.exit_code == 0);
    CHECK_THAT(anew.err, Contains("3 of 3 runs") && Contains("6 of 6 runs"));
    CHECK(read_all(folder / "index.html") == page);
}

TEST_CASE("figures: a program that fails is reported on the page and by the exit code") {
    const Checkout checkout;
    fs::remove(checkout.root() / "build/release/testbench/commands/tessera");
    write_all(checkout.root() / "build/release/testbench/commands/tessera",
              "#!/bin/sh\ncase \"$*\" in *--dump-config) exit 0 ;; esac\necho no luck >&2\nexit 3\n");
    fs::permissions(checkout.root() / "build/release/testbench/commands/tessera", fs::perms::owner_all);
    const ProgramEnd end = checkout.run("scripts/figures --only text_plane");
    CHECK(end.exit_code == 1);
    CHECK_THAT(end.err, Contains("text: exit code 3: no luck"));
    CHECK_THAT(read_all(checkout.root() / "runs/figures_only/index.html"), Contains("no luck"));
}

TEST_CASE("figures: an unknown experiment is refused with the list of known ones") {
    const Checkout checkout;
    const ProgramEnd end = checkout.run("scripts/figures --only two_test");
    CHECK(end.exit_code == 2);
    CHECK_THAT(end.err, Contains("two_tests") && Contains("crater_lake"));
}

TEST_CASE("figures: a folder of pictures not written by an evaluation is refused") {
    const Checkout checkout;
    const ProgramEnd end = checkout.run("mkdir -p mine/pictures && scripts/figures --only text_plane --output mine");
    CHECK(end.exit_code == 2);
    CHECK_THAT(end.err, Contains("mine/pictures would be replaced"));
    CHECK(fs::exists(checkout.root() / "mine/pictures"));
}
