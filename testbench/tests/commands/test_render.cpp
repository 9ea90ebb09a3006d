#include <png.h>

#include <catch2/catch.hpp>
#include <cstdint>
#include <regex>
#include <string>
#include <vector>

#include "testbench/tests/support/program_runner.h"

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

/// A small run in here/run: a second or less.
void make_run(const fs::path& here, const Arguments& settings = {}) {
    succeed(Arguments{"run"} +
                set({"mode=functional", "check.golden=false", "check.end_to_end=false", "output.obj=false",
                     "map.width=64", "map.height=64", "output.folder=run"}) +
                set(settings),
            here);
}

struct Pixels {
    unsigned width = 0, height = 0;
    std::vector<std::uint8_t> bytes;
};

Pixels read_png(const fs::path& path) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_file(&header, path.c_str()) != 0);
    CHECK(header.format == PNG_FORMAT_RGB);
    Pixels pixels{header.width, header.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(header))};
    REQUIRE(png_image_finish_read(&header, nullptr, pixels.bytes.data(), 0, nullptr) != 0);
    return pixels;
}

std::string rendered(const Arguments& arguments, const fs::path& here) {
    return succeed(Arguments{"render"} + arguments, here).out;
}

bool all_background(const Pixels& pixels) {
    for (std::size_t i = 0; i < pixels.bytes.size(); i += 3)
        if (pixels.bytes[i] != 250 || pixels.bytes[i + 1] != 250 || pixels.bytes[i + 2] != 248)
            return false;
    return true;
}

}  // namespace

TEST_CASE("render: the default is the run's own picture, byte for byte") {
    const TestFolder here;
    make_run(here.path());
    const std::string said = rendered({"run"}, here.path());
    CHECK_THAT(said, Contains("run/overview.png") && Contains("1600 x "));
    CHECK(read_all(here.path() / "run/overview.png") == read_all(here.path() / "run/picture.png"));
}

TEST_CASE("render: pictures are removed with the mesh they show") {
    const TestFolder here;
    make_run(here.path());
    rendered({"run", "--size", "100x80", "--view", "shaded,test"}, here.path());
    CHECK(fs::exists(here.path() / "run/shaded.png"));
    write_all(here.path() / "run/mine.png", "mine");
    make_run(here.path(), {"tests.normal_threshold=0.3"});
    CHECK_FALSE(fs::exists(here.path() / "run/shaded.png"));
    CHECK_FALSE(fs::exists(here.path() / "run/test.png"));
    CHECK(fs::exists(here.path() / "run/mine.png"));
}

TEST_CASE("render: several views at once are a picture each") {
    const TestFolder here;
    make_run(here.path());
    rendered({"run", "--size", "300x240", "--view", "shaded,wireframe", "--view", "test", "--view", "shaded",
              "--output", "all"},
             here.path());
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(here.path() / "all")) {
        const Pixels pixels = read_png(entry.path());
        CHECK(pixels.width == 300);
        CHECK(pixels.height == 240);
        CHECK_FALSE(all_background(pixels));
        ++files;
    }
    CHECK(files == 3);
    rendered({"run", "--size", "300x240", "--view", "test", "--output", "one.png"}, here.path());
    CHECK(read_all(here.path() / "one.png") == read_all(here.path() / "all/test.png"));
}

TEST_CASE("render: camera, zoom, lines and error scale change the picture") {
    const TestFolder here;
    make_run(here.path());
    const auto picture = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"run", "--size", "200x150", "--output", "a.png"});
        rendered(arguments, here.path());
        return read_all(here.path() / "a.png");
    };
    const std::string usual = picture({"--view", "wireframe"});
    for (const std::vector<std::string>& change :
         std::vector<std::vector<std::string>>{{"--whole-viewport"},
                                               {"--eye", "0", "-3", "1"},
                                               {"--target", "0.5", "0", "0"},
                                               {"--up", "1", "0", "0"},
                                               {"--whole-viewport", "--field-of-view", "60"},
                                               {"--zoom", "0.5", "0.5", "4"},
                                               {"--line-width", "3"}}) {
        INFO(change.front());
        std::vector<std::string> arguments{"--view", "wireframe"};
        arguments.insert(arguments.end(), change.begin(), change.end());
        CHECK(picture(arguments) != usual);
    }
    CHECK(picture({"--view", "error"}) != picture({"--view", "error", "--error-scale", "0.5"}));
    // The run's own camera, given explicitly.
    CHECK(picture({"--view", "wireframe", "--eye", "1.06953", "-2.9385", "2.56815", "--target", "0", "0", "0.125",
                   "--up", "0", "0", "1", "--field-of-view", "36"}) == usual);
}

TEST_CASE("render: a camera that sees nothing and a run that emitted nothing give an empty picture with a note") {
    const TestFolder here;
    make_run(here.path());
    CHECK_THAT(rendered({"run", "--size", "100x80", "--view", "shaded", "--eye", "0", "0", "5", "--target", "0", "0",
                         "9", "--up", "0", "1", "0", "--output", "behind.png"},
                        here.path()),
               Contains("no part of the mesh is in this camera's view"));
    CHECK(all_background(read_png(here.path() / "behind.png")));
    // The plane from below, with back faces culled.
    make_run(here.path(), {"map.source=constant", "hardware.culling=back", "camera.eye=[0.1, 0.2, -4]"});
    for (const std::string view : {"overview", "wireframe", "stopped", "error"})
        CHECK_THAT(rendered({"run", "--size", "200x100", "--view", view}, here.path()),
                   Contains("the run's mesh is empty"));
    CHECK(all_background(read_png(here.path() / "run/wireframe.png")));
}

// Others that name a remedy: remedies.h.
TEST_CASE("render: hostile arguments are refused in one line") {
    const TestFolder here;
    make_run(here.path());
    for (const std::string size : {"0", "0x0", "1x1", "100000x1", "63x64", "64x16385", "-5x100", "x", "64x", "x64",
                                   "64x64x64", "1e3", "99999999999x99999999999"})
        refused({"render", "run", "--size=" + size}, here, {"--size", "64", "16384"});
    refused({"render", "run", "--size", "16384x16384"}, here, {"--size", "33554432"});
    refused({"render", "run", "--size", "16384"}, here, {"--size", "33554432"});
    refused({"render", "run", "--eye", "1", "1", "1", "--target", "1", "1", "1"}, here,
            {"--eye 1.0 1.0 1.0 and --target 1.0 1.0 1.0 are the same point: set --target "});
    refused({"render", "run", "--eye", "0", "0", "3", "--target", "0", "0", "0", "--up", "0", "0", "-2"}, here,
            {"--up 0.0 0.0 -2.0 is parallel", "set --up "});
    refused({"render", "run", "--up", "0", "0", "0"}, here, {"--up", "no direction: set one, such as 0 0 1"});
    refused({"render", "run", "--eye", "nan", "0", "0"}, here, {"--eye nan"});
    refused({"render", "run", "--eye", "1", "2"}, here, {"--eye"});
    refused({"render", "run", "--eye", "1", "2", "east"}, here, {"--eye"});
    refused({"render", "run", "--field-of-view", "180"}, here, {"--field-of-view 180"});
    refused({"render", "run", "--field-of-view", "0"}, here, {"--field-of-view 0"});
    refused({"render", "run", "--zoom", "0.5", "0.5", "nan"}, here, {"--zoom"});
    refused({"render", "run", "--zoom", "0.5", "0.5"}, here, {"--zoom"});
    refused({"render", "run", "--line-width", "nan"}, here, {"--line-width"});
    refused({"render", "run", "--view", "test,wireframe", "--error-scale", "0.5"}, here, {"--view error"});
    refused({"render", "run", "--view", "shadow"}, here, {"shadow", "shaded"});
    refused({"render", "run", "--view", ""}, here, {"--view"});
}

TEST_CASE("render: the camera that a refusal names is drawn") {
    const TestFolder here;
    make_run(here.path());
    const auto [camera, option] = GENERATE(table<std::vector<std::string>, std::string>(
        {{{"--eye", "0", "0", "0.125"}, "--target"}, {{"--eye", "0", "0", "5"}, "--up"}}));
    std::vector<std::string> arguments{"render", "run", "--size", "64"};
    arguments.insert(arguments.end(), camera.begin(), camera.end());
    const ProgramEnd end = run_tessera(arguments, here.path());
    INFO(end.text());
    std::smatch named;
    REQUIRE(std::regex_search(end.err, named, std::regex("set " + option + R"( (\S+) (\S+) (\S+)\n)")));
    arguments.insert(arguments.end(), {option, named[1], named[2], named[3]});
    CHECK(run_tessera(arguments, here.path()).exit_code == 0);
}

TEST_CASE("render: folders that are not runs and invalid outputs are refused") {
    const TestFolder here;
    refused({"render"}, here, {"--help"});
    refused({"render", "absent"}, here, {"absent"});
    make_run(here.path());
    fs::create_directory(here.path() / "empty");
    refused({"render", "empty"}, here, {"empty", "job.toml"});
    write_all(here.path() / "file", "mine");
    refused({"render", "file"}, here, {"file"});
    refused({"render", "run", "--output", "file/a.png"}, here, {"--output", "file"});
    refused({"render", "run", "--output", "file"}, here, {"--output", "file"});
    refused({"render", "run", "--output", "/proc/tessera/a.png"}, here, {"--output", "/proc"});
    CHECK(read_all(here.path() / "file") == "mine");
    fs::remove(here.path() / "run/mesh.ply");
    refused({"render", "run"}, here, {"mesh.ply"});
}
