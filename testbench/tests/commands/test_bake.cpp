#include <catch2/catch.hpp>

#include "testbench/input/map/read_height_map.h"
#include "testbench/tests/support/program_runner.h"

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

fs::path example(const char* name) {
    return source_folder() / "testbench/examples/surfaces" / name;
}

}  // namespace

TEST_CASE("bake: the examples bake in all formats, identically twice, and their jobs run") {
    const TestFolder here;
    for (const char* const name : {"dome", "saddle", "hills", "pillow"}) {
        INFO(name);
        const std::string surface = example((std::string(name) + ".toml").c_str()).string();
        const std::string map = name;
        for (const std::string ending : {".pgm", ".png", ".exr", ".PGM"}) {
            const std::string out =
                succeed({"bake", surface, "--size", "40x30", "--output", map + ending}, here.path()).out;
            CHECK_THAT(out,
                       Contains("40 x 30 texels") && Contains("displacement.scale") && Contains(map + ".job.toml"));
            const HeightMap read = read_height_map(here.path() / (map + ending));
            CHECK(read.width == 40);
            CHECK(read.height == 30);
            const std::string once = read_all(here.path() / (map + ending)),
                              job = read_all(here.path() / (map + ".job.toml"));
            succeed({"bake", surface, "--size", "40x30", "--output", map + ending}, here.path());
            CHECK(read_all(here.path() / (map + ending)) == once);
            CHECK(read_all(here.path() / (map + ".job.toml")) == job);
        }
        succeed({"run", map + ".job.toml", "--set", "mode=functional"}, here.path());
        CHECK(fs::exists(here.path() / "runs" / map / "mesh.ply"));
    }
}

TEST_CASE("bake: without a size the map has 256 x 256 texels") {
    const TestFolder here;
    succeed({"bake", example("dome.toml").string(), "--output", "dome.pgm"}, here.path());
    CHECK(read_height_map(here.path() / "dome.pgm").width == 256);
    CHECK(here.names() == std::vector<std::string>{"dome.job.toml", "dome.pgm"});
}

TEST_CASE("bake: of the base mesh's job nothing is kept that belongs to another map") {
    const TestFolder here;
    write_all(here.path() / "base.toml",
              "mode = \"functional\"\n[mesh]\nsource = \"lattice\"\nspacing = 8\n[map]\nwidth = 65\nheight = 65\n"
              "range = [0, 300]\nno_data = [0]\naddress_u = \"repeat\"\n");
    const std::string out = succeed({"bake", example("dome.toml").string(), "--mesh", "base.toml", "--size", "32x32",
                                     "--output", "dome.exr"},
                                    here.path())
                                .out;
    CHECK_THAT(out, !Contains("no base triangle"));  // the lattice is the new map's
    const std::string job = read_all(here.path() / "dome.job.toml");
    for (const char* const key : {"range", "no_data", "width", "height"})
        CHECK_THAT(job, !Contains(std::string("\n") + key + " = "));
    CHECK_THAT(job, Contains("address_u = \"repeat\""));
    CHECK_THAT(succeed({"run", "dome.job.toml"}, here.path()).out, !Contains("note: map.") && !Contains("no-data"));
}

TEST_CASE("bake: the job fits the domain and finds its files from its own folder") {
    const TestFolder here;
    write_all(here.path() / "wide.toml",
              "[domain]\nx = [3, 7]\ny = [0, 0.5]\n[quadric]\nshape = \"paraboloid\"\n"
              "radius = 2\ncentre = [5, 0, 1]\n");
    fs::create_directories(here.path() / "base");
    write_all(here.path() / "base/square.obj",
              "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\n");
    write_all(here.path() / "base/job.toml",
              "mode = \"functional\"\n[mesh]\nsource = \"file\"\nfile = \"square.obj\"\n");
    succeed({"bake", "wide.toml", "--output", "out/wide.png"}, here.path());
    const std::string job = read_all(here.path() / "out/wide.job.toml");
    CHECK_THAT(job, Contains("width = 4.0\ndepth = 0.5\n") && Contains("file = \"wide.png\""));

    write_all(here.path() / "ball.toml", "[quadric]\nshape = \"sphere\"\nradius = 3\n");
    const std::string out =
        succeed({"bake", "ball.toml", "--mesh", "base/job.toml", "--output", "out/ball.pgm"}, here.path()).out;
    CHECK_THAT(out, Contains("no base triangle") && Contains("hold the surface continued past it"));
    CHECK_THAT(read_all(here.path() / "out/ball.job.toml"), Contains("file = \"../base/square.obj\""));
    succeed({"run", "out/ball.job.toml"}, here.path());
    CHECK_THAT(succeed({"bake", "wide.toml", "--output", "wide.png"}, here.path()).out,
               Contains("the surface is moved by (-5, -0.25)"));
    CHECK_THAT(succeed({"bake", "wide.toml", "--mesh", "base/job.toml", "--output", "wide.png"}, here.path()).out,
               Contains("note: [domain] is not used"));

    // The map of a patch does not depend on the base mesh.
    succeed({"bake", example("hills.toml").string(), "--output", "plain.pgm"}, here.path());
    succeed({"bake", example("hills.toml").string(), "--mesh", "base/job.toml", "--output", "meshed.pgm"}, here.path());
    CHECK(read_all(here.path() / "plain.pgm") == read_all(here.path() / "meshed.pgm"));
    CHECK_THAT(read_all(here.path() / "meshed.job.toml"), Contains("base/square.obj"));
}

TEST_CASE("bake: overlapping base triangles are reported") {
    const TestFolder here;
    write_all(here.path() / "ball.toml", "[quadric]\nshape = \"sphere\"\nradius = 6\n");
    CHECK_THAT(succeed({"bake", "ball.toml", "--mesh",
                        (source_folder() / "testbench/examples/jobs/teapot.toml").string(), "--output", "ball.pgm"},
                       here.path())
                   .out,
               Contains("note: 6") && Contains("lie in several base triangles"));
}

// Others that name a remedy: remedies.h. What a surface file may not say: bake/test_file.cpp.
TEST_CASE("bake: hostile arguments are refused in one line") {
    const TestFolder here;
    const std::string dome = example("dome.toml").string();
    refused({"bake"}, here, {"--help"});
    refused({"bake", dome}, here, {"--output"});
    refused({"bake", "absent.toml", "--output", "a.pgm"}, here, {"absent.toml: no such surface file"});
    refused({"bake", ".", "--output", "a.pgm"}, here, {"is a folder"});
    for (const std::string size : {"0x5", "5x0", "256", "x", "5x", "4097x4", "4x4097", "-3x5", "5x5x5", "1e3x5", ""})
        refused({"bake", dome, "--output", "a.pgm", "--size=" + size}, here, {"--size"});
    for (const std::string output : {"a.jpg", "a", "", ".pgm/", "folder/"})
        refused({"bake", dome, "--output", output}, here, {"--output"});
    refused({"bake", dome, "--output", "/proc/tessera/a.pgm"}, here, {"--output"});
    refused({"bake", dome, "--output", "a.pgm", "--mesh", "absent.toml"}, here, {"absent.toml"});
    refused({"bake", dome, "--output", "a.pgm", "--mesh", dome}, here, {"dome.toml:2", "quadric"});
    for (const char* const name : {"c.job.toml", "d.job.toml"})
        write_all(here.path() / name, read_all(example(name[0] == 'c' ? "dome.toml" : "barrel_base.toml")));
    refused({"bake", "c.job.toml", "--output", "c.pgm"}, here, {"--output c.pgm", "would overwrite c.job.toml"});
    refused({"bake", dome, "--mesh", "d.job.toml", "--output", "./d.pgm"}, here, {"would overwrite d.job.toml"});
    CHECK(read_all(here.path() / "c.job.toml") == read_all(dome));
    fs::create_directory(here.path() / "b.pgm");
    refused({"bake", dome, "--output", "b.pgm"}, here, {"b.pgm", "folder"});
}

TEST_CASE("bake: a full disk ends it with exit code 4 and no map") {
    const TestFolder here;
    ProgramLimits limits;
    limits.file_bytes = 4096;
    const ProgramEnd end =
        run_tessera({"bake", example("dome.toml").string(), "--output", "new/a.pgm"}, here.path(), limits);
    INFO(end.text());
    CHECK(end.exit_code == 4);
    CHECK_THAT(end.err, Contains("a.pgm"));
    CHECK_FALSE(fs::exists(here.path() / "new"));
}
