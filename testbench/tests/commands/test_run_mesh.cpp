#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "testbench/run_folder/ply_reader.h"
#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/run_folder.h"

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

Arguments arguments_of(const Arguments& settings) {
    return Arguments{"run"} + set(settings) + set({"mode=functional", "output.picture=false"});
}

/// Runs to the end, with the checks that hold for every run; returns its folder.
RunFolder run(const fs::path& folder, const std::string& name, std::vector<std::string> settings) {
    settings.push_back("output.folder=runs/" + name);
    succeed(arguments_of(settings), folder);
    RunFolder left(folder / "runs" / name);
    require_consistent(left);
    return left;
}

std::vector<std::string> on(const std::string& base, std::vector<std::string> settings) {
    settings.insert(settings.end(), {"mesh.source=run", "mesh.file=runs/" + base});
    return settings;
}

/// A quarter of the default job's triangles.
const std::vector<std::string> small_donut{"map.width=64", "map.height=64", "tests.view_threshold=12"};

void check_closed(const RunFolder& run) {
    for (const char* const figure : {"cracks", "t_vertices", "inconsistent_vertices", "texture_seams",
                                     "open_texture_seam_edges", "open_crease_edges"})
        CHECK(run.invariant(figure) == 0);
}

double step(const RunFolder& run) {
    const auto figure = [&](const char* name) {
        return run.statistics.at("formats").at(name).at("value").get<double>();
    };
    return std::ldexp(1.0, -static_cast<int>(figure("position_fraction"))) / figure("model_scale");
}

/// The same triangles in the same order, corner by corner, except for rounding.
void check_same_mesh(const RecordedMesh& a, const RecordedMesh& b, double position, double texture) {
    REQUIRE(a.triangles.size() == b.triangles.size());
    double apart = 0, texture_apart = 0, normal_apart = 0;
    for (std::size_t t = 0; t < a.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t i = a.triangles[t].vertices[k], j = b.triangles[t].vertices[k];
            for (int axis = 0; axis < 3; ++axis) {
                apart = std::max(apart, std::abs(a.positions[i][axis] - b.positions[j][axis]));
                normal_apart = std::max<double>(normal_apart, std::abs(a.normals[i][axis] - b.normals[j][axis]));
            }
            for (int axis = 0; axis < 2; ++axis)
                texture_apart = std::max(texture_apart, std::abs(a.textures[i][axis] - b.textures[j][axis]));
        }
    CHECK(apart <= position);
    CHECK(texture_apart <= texture);
    CHECK(normal_apart <= 2.0 / 16384);  // the bump unit normalises once more
}

}  // namespace

TEST_CASE("a second map on a run's mesh leaves no crack") {
    const TestFolder here;
    const RunFolder first = run(here.path(), "donut", small_donut);
    const std::uint64_t base = first.count("run", "triangles_finished");
    for (const std::string map : {"text", "noise"}) {
        const RunFolder second =
            run(here.path(), map, on("donut", {"map.source=" + map, "map.width=100", "displacement.scale=0.04"}));
        CHECK(second.count("host", "base_triangles") == base);
        CHECK(second.count("run", "triangles_finished") > base + base / 10);
        check_closed(second);
    }
    // and on a third run
    const RunFolder third = run(here.path(), "third", on("text", {"displacement.scale=0.1"}));
    CHECK(third.count("host", "base_triangles") > base);
    check_closed(third);
}

TEST_CASE("the base vertices of a second run are the first run's emitted vertices") {
    const TestFolder here;
    run(here.path(), "first", small_donut);
    const RecordedMesh first = read_ply(here.path() / "runs/first/mesh.ply");
    const std::vector<std::string> no_splits{"displacement.scale=0", "tests.normal=false", "tests.summed_height=false"};
    SECTION("with a map of the same size texture coordinates are identical") {
        std::vector<std::string> settings = no_splits;
        settings.insert(settings.end(), {"map.source=constant", "map.width=64", "map.height=64"});
        const RunFolder second = run(here.path(), "second", on("first", settings));
        check_same_mesh(first, read_ply(here.path() / "runs/second/mesh.ply"), step(second) / 2, 0);
    }
    SECTION("with another size they differ by half a step of its format") {
        std::vector<std::string> settings = no_splits;
        settings.insert(settings.end(), {"map.source=constant", "map.width=100", "map.height=7"});
        const RunFolder second = run(here.path(), "second", on("first", settings));
        check_same_mesh(first, read_ply(here.path() / "runs/second/mesh.ply"), step(second) / 2, 0.5 / 4096 / 7);
    }
}

TEST_CASE("the seam of a cylinder stays closed under a second map of another size") {
    const TestFolder here;
    const std::vector<std::string> cylinder{"mesh.source=cylinder",    "mesh.columns=12",        "mesh.rows=4",
                                            "map.source=noise",        "map.address_u=repeat",   "map.width=100",
                                            "displacement.scale=0.05", "tests.view_threshold=16"};
    check_closed(run(here.path(), "first", cylinder));
    check_closed(run(here.path(), "second",
                     on("first", {"map.source=noise", "map.address_u=repeat", "map.width=77", "displacement.scale=0.02",
                                  "tests.view_threshold=12"})));
}

TEST_CASE("a run on a run is the same again, and from its own folder") {
    const TestFolder here;
    run(here.path(), "first", small_donut);
    const std::vector<std::string> settings = on("first", {"map.source=text", "displacement.scale=0.05"});
    const auto once = run(here.path(), "second", settings).files();
    require_same_files(once, run(here.path(), "second", settings).files());
    CHECK_THAT(once.at("job.toml"), Contains("file = \"../first\"") && Contains("source = \"run\""));
    succeed({"run", "runs/second/job.toml"}, here.path());
    require_same_files(once, RunFolder(here.path() / "runs/second").files());
}

TEST_CASE("a run on a run of an OBJ file keeps its up direction") {
    const TestFolder here;
    write_all(here.path() / "upright.obj",
              "v -1 0 -1\nv 1 0 -1\nv 0 0 1\nv 0 4 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n");
    run(here.path(), "first", {"mesh.source=file", "mesh.file=upright.obj", "tests.generation_limit=2"});
    const std::vector<std::string> coarse{"tests.generation_limit=1"};
    run(here.path(), "second", on("first", coarse));
    const RunFolder third = run(here.path(), "third", on("second", coarse));
    CHECK_THAT(third.files().at("job.toml"), Contains("up = [0.0, 1.0, 0.0]"));
    const RunFolder set = run(here.path(), "set", on("second", {"tests.generation_limit=1", "camera.up=[0, 0, 1]"}));
    CHECK_THAT(set.files().at("job.toml"), Contains("up = [0.0, 0.0, 1.0]"));
}

TEST_CASE("compare and render read a run on a run, and the first run's own inputs are not needed") {
    const TestFolder here;
    std::string map = "P5 32 32 255\n";
    for (int k = 0; k < 32 * 32; ++k)
        map += static_cast<char>(k % 32 < 16 ? 8 * (k % 32) : 8 * (31 - k % 32));
    write_all(here.path() / "map.pgm", map);
    run(here.path(), "first", {"map.source=file", "map.file=map.pgm", "tests.view_threshold=12"});
    fs::remove(here.path() / "map.pgm");
    run(here.path(), "second",
        on("first", {"map.source=noise", "displacement.scale=0.02", "map.width=32", "map.height=32",
                     "tests.view_threshold=12"}));
    for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
             {"compare", "runs/second"}, {"render", "runs/second", "--view", "error", "--size", "200"}})
        succeed(arguments, here.path());
    const auto error = nlohmann::json::parse(read_all(here.path() / "runs/second/error.json"));
    // A base mesh that differs from the run's would be off by the first map's height.
    CHECK(error.at("interpolated").at("mesh_to_reference_max").at("value").get<double>() < 0.06);
    CHECK(fs::exists(here.path() / "runs/second/error.png"));

    fs::remove(here.path() / "runs/first/mesh.ply");
    CHECK_THAT(run_tessera({"compare", "runs/second"}, here.path()).err,
               Contains("runs/second/../first/mesh.ply") && Contains("left no mesh"));
    fs::remove_all(here.path() / "runs/first");
    CHECK_THAT(run_tessera({"compare", "runs/second"}, here.path()).err,
               Contains("mesh.file") && Contains("../first") && Contains("does not exist"));
}

TEST_CASE("a base mesh that is not a finished run's is refused with the reason") {
    const TestFolder here;
    refused(arguments_of({"mesh.source=run"}), here.path(), {"mesh.file", "folder of a run"});
    refused(arguments_of(on("absent", {})), here.path(), {"runs/absent: no such folder"});
    fs::create_directories(here.path() / "runs/empty");
    refused(arguments_of(on("empty", {})), here.path(), {"mesh.file", "runs/empty", "interrupted"});
    write_all(here.path() / "runs/empty/job.toml", "");
    refused(arguments_of(on("empty", {})), here.path(), {"left no mesh", "interrupted"});
    run(here.path(), "first", {"tests.generation_limit=1"});
    refused(arguments_of(on("first/mesh.ply", {})), here.path(), {"name the run folder"});
    refused(arguments_of(on("first", {"output.folder=runs/first/"})), here.path(),
            {"output.folder", "its own base mesh"});
    CHECK(fs::exists(here.path() / "runs/first/mesh.ply"));
    succeed(arguments_of({"output.ply=false", "tests.generation_limit=1", "output.folder=runs/first"}), here.path());
    refused(arguments_of(on("first", {})), here.path(), {"--set output.ply=true"});
}

TEST_CASE("a run removes neither the mesh file nor the map file that it reads") {
    const TestFolder here;
    run(here.path(), "first", {"tests.generation_limit=1", "output.obj=true"});
    const std::string mesh = read_all(here.path() / "runs/first/mesh.obj");
    refused(arguments_of({"mesh.source=file", "mesh.file=runs/first/mesh.obj", "output.folder=runs/first"}),
            here.path(), {"its own base mesh", "mesh.obj"});
    refused(arguments_of({"map.source=file", "map.file=runs/first/picture.png", "output.folder=runs/first"}),
            here.path(), {"its own map", "picture.png"});
    CHECK(read_all(here.path() / "runs/first/mesh.obj") == mesh);
    // A file of another name in the folder is allowed.
    fs::copy(here.path() / "runs/first/mesh.obj", here.path() / "runs/first/base.obj");
    succeed(arguments_of({"mesh.source=file", "mesh.file=runs/first/base.obj", "tests.generation_limit=1",
                          "output.folder=runs/first"}),
            here.path());
    CHECK(fs::exists(here.path() / "runs/first/base.obj"));
}

TEST_CASE("a run that is cut short in its folder leaves the earlier run's job and mesh") {
    const TestFolder here;
    run(here.path(), "one", {"tests.generation_limit=3"});
    const fs::path folder = here.path() / "runs/one";
    const std::string job = read_all(folder / "job.toml"), mesh = read_all(folder / "mesh.ply");
    fs::remove(folder / "statistics.csv");
    fs::create_directories(folder / "statistics.csv/in the way");
    const ProgramEnd end =
        run_tessera(arguments_of({"tests.generation_limit=2", "output.folder=runs/one"}), here.path());
    INFO(end.text());
    CHECK(end.exit_code == 2);
    CHECK(read_all(folder / "job.toml") == job);
    CHECK(read_all(folder / "mesh.ply") == mesh);
}

TEST_CASE("the teapot's donuts take a second map") {
    const TestFolder here;
    const auto teapot = [&](const std::string& name, const Arguments& settings) {
        succeed(arguments_of(settings) + Arguments{(source_folder() / "testbench/examples/jobs/teapot.toml").string()} +
                    set({"output.folder=runs/" + name, "check.end_to_end=false", "output.obj=false"}),
                here.path());
        return RunFolder(here.path() / "runs" / name);
    };
    const RunFolder first = teapot("first", {});
    const RunFolder second =
        teapot("second", on("first", {"map.source=text", "map.text=text", "displacement.scale=0.05"}));
    CHECK(second.count("host", "base_triangles") >
          first.count("run", "triangles_finished") - 10);  // some fall together at the poles
    CHECK(second.count("run", "triangles_finished") > 3 * first.count("run", "triangles_finished") / 2);
    for (const char* const figure : {"cracks", "t_vertices", "open_texture_seam_edges", "open_crease_edges"})
        CHECK(second.invariant(figure) == 0);
}

TEST_CASE("a run whose input files have changed since is not measured, drawn or run again") {
    const TestFolder here;
    run(here.path(), "first", small_donut);
    write_all(here.path() / "map.pgm", "P2 3 2 9\n0 9 5\n1 2 3\n");
    run(here.path(), "second",
        on("first", {"map.source=file", "map.file=map.pgm", "displacement.scale=0.02", "tests.generation_limit=1"}));
    const auto fate_of = [&](const std::vector<std::string>& arguments) { return run_tessera(arguments, here.path()); };
    const std::vector<std::vector<std::string>> readers{
        {"compare", "runs/second"},
        {"render", "runs/second", "--view", "error", "--size", "64"},
        {"run", "runs/second/job.toml", "--set", "output.folder=runs/again"}};
    for (const auto& reader : readers)
        CHECK(fate_of(reader).exit_code == 0);

    SECTION("the base mesh") {
        run(here.path(), "first", {"map.width=64", "map.height=64", "tests.view_threshold=10"});
    }
    SECTION("the map") {
        write_all(here.path() / "map.pgm", "P2 3 2 9\n0 9 5\n1 2 4\n");
    }
    for (const auto& reader : readers) {
        const ProgramEnd end = fate_of(reader);
        INFO(end.text());
        CHECK(end.exit_code == 2);
        CHECK(lines_of(end.err).size() == 1);
        CHECK_THAT(end.err, Contains(".fingerprint = ") && Contains("was changed since"));
    }
    const ProgramEnd anew =
        fate_of({"run", "runs/second/job.toml", "--set", "mesh.fingerprint=", "--set", "map.fingerprint="});
    INFO(anew.text());
    CHECK(anew.exit_code == 0);
    CHECK(fate_of(readers[0]).exit_code == 0);
}
