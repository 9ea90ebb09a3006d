#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>

#include "modules/datapath/height_tests.h"
#include "testbench/common/hash.h"
#include "testbench/tests/support/job_results.h"
#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/run_folder.h"
#include "testbench/tests/support/shared_data.h"

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

/// 64-bit FNV-1a of the data after the header, since the header depends on more than the mesh.
std::uint64_t hash_of_mesh(const fs::path& ply) {
    const std::string file = read_all(ply), end = "end_header\n";
    const std::size_t header = file.find(end);
    REQUIRE(header != std::string::npos);
    return fnv1a(std::string_view(file).substr(header + end.size()));
}

void check_result(const JobResult& expected, const fs::path& folder) {
    const RunFolder run(folder);
    CHECK(run.count("run", "triangles_finished") == expected.triangles);
    CHECK(run.count("run", "edges_split") == expected.splits);
    CHECK(run.count("run", "edges_tested") == expected.edges);
    CHECK(hash_of_mesh(folder / "mesh.ply") == expected.mesh);
}

/// Runs one of the project's jobs and requires what holds for all of them.
void run_job_well(const std::string& name) {
    const fs::path job = source_folder() / "testbench/examples/jobs" / (name + ".toml");
    const TestFolder here;
    const ProgramEnd end = succeed({"run", job.string()}, here.path());
    CHECK_THAT(end.out, Contains("all checks passed"));
    CHECK_THAT(end.out, !Contains("warning: "));

    const RunFolder run(here.path() / "runs" / name);
    require_consistent(run);
    CHECK(run.conformance["conformance"]["flips_percent"].get<double>() < 0.5);
    CHECK(run.conformance["conformance"]["mismatches"] == 0);
    for (const char* const figure :
         {"cracks", "t_vertices", "collapsed", "turned_over", "missing_triangles", "extra_triangles",
          "differing_triangles", "generation_violations", "inconsistent_vertices", "unfinished"}) {
        INFO(figure);
        CHECK(run.invariant(figure) == 0);
    }
    CHECK(run.invariant("open_crease_edges") == 0);
    if (name == "head") {
        CHECK(run.invariant("border_base_edges") == 64);  // above and below; the seam is not one
        CHECK(run.invariant("open_texture_seam_edges") == 0);
    }

    const auto* const expected =
        std::find_if(job_results.begin(), job_results.end(), [&](const JobResult& each) { return name == each.name; });
    REQUIRE(expected != job_results.end());
    check_result(*expected, here.path() / "runs" / name);
    CHECK(run.count("timing", "cycles") == expected->cycles);
    succeed({"run", job.string(), "--set", "mode=functional", "--set", "check.golden=false", "--set",
             "check.end_to_end=false", "--set", "output.picture=false", "--set", "output.folder=functional"},
            here.path());
    check_result(*expected, here.path() / "functional");
}

}  // namespace

TEST_CASE("every job of the project has a test here") {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(source_folder() / "testbench/examples/jobs"))
        if (entry.path().extension() == ".toml")
            names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    std::vector<std::string> covered;
    for (const JobResult& each : job_results)
        covered.emplace_back(each.name);
    CHECK(names == covered);
}

TEST_CASE("the job crater_lake_24 passes") {
    run_job_well("crater_lake_24");
}
TEST_CASE("the job crater_lake_704 passes") {
    run_job_well("crater_lake_704");
}
TEST_CASE("the job crater_lake_rank passes") {
    run_job_well("crater_lake_rank");
}
TEST_CASE("the job half_donut passes") {
    run_job_well("half_donut");
}
TEST_CASE("the job head passes and its seam is closed") {
    run_job_well("head");
}
TEST_CASE("the job teapot passes") {
    run_job_well("teapot");
}

namespace {

/// Runs a job with another height test alone, in the modern design. The mesh must be closed, equal golden's, and have
/// more than `least` split edges unless the run reports that the base mesh cannot split.
ProgramEnd run_with_test(const TestFolder& here, const std::string& job, const std::string& test,
                         const Arguments& settings, std::uint64_t least = 100) {
    INFO(job << ", " << test);
    ProgramEnd end = succeed(
        Arguments{"run", (source_folder() / "testbench/examples/jobs" / (job + ".toml")).string(), "--set",
                  "hardware.design=modern", "--set", "mode=functional", "--set", "output.picture=false", "--set",
                  "output.folder=run", "--set", "tests.normal=false", "--set", "hardware.height_test=" + test, "--set",
                  "tests.curvature_threshold=0.3", "--set", "tests.mipmap_threshold=0.05"} +
            settings,
        here.path());
    CHECK_THAT(end.out, Contains("0 cracks, 0 T-vertices") && Contains("all checks passed"));
    const RunFolder run(here.path() / "run");
    const bool is_served =
        end.out.find("of the base mesh never split: their ends are not an even number of texels apart") ==
        std::string::npos;
    CHECK((run.count("run", "edges_split") > least) == is_served);
    if (job == "head")
        CHECK(run.invariant("open_texture_seam_edges") == 0);
    return end;
}

}  // namespace

TEST_CASE("every height test closes the head on a cylinder of whole texels, and the teapot") {
    const TestFolder here;
    for (const datapath::HeightTestFunctions* const each : datapath::height_tests()) {
        const std::string test(each->name);
        if (test == "summed_height")
            continue;
        const ProgramEnd head = run_with_test(here, "head", test, {});
        CHECK((head.out.find("Rank Test is limited on this base mesh") != std::string::npos) == (test == "rank"));
        CHECK_THAT(head.out, !Contains("never split"));
        run_with_test(here, "teapot", test, {}, test == "rank" ? 100 : 1000);
    }
    run_with_test(here, "half_donut", "curvature", {}, 1000);
}

TEST_CASE("every height test closes the head on the paper's cylinder and the teapot as OBJ files") {
    const fs::path cylinder = shared_data("meshes/cylinder_1800_lps.obj"), teapot = shared_data("meshes/teapot_n4.obj");
    if (cylinder.empty() || teapot.empty())
        return;
    const TestFolder here;
    for (const datapath::HeightTestFunctions* const each : datapath::height_tests()) {
        const std::string test(each->name);
        if (test == "summed_height")
            continue;
        const ProgramEnd head =
            run_with_test(here, "head", test, {"--set", "mesh.source=file", "--set", "mesh.file=" + cylinder.string()});
        CHECK((head.out.find("never split") != std::string::npos) == (test == "rank"));  // 30 quads over 512 texels
        run_with_test(here, "teapot", test, {"--set", "mesh.source=file", "--set", "mesh.file=" + teapot.string()});
    }
}

TEST_CASE("the data folder can be set") {
    const TestFolder here;
    fs::create_directories(here.path() / "data/maps");
    write_all(here.path() / "data/maps/dot.pgm", "P2 1 1 9\n5\n");
    const Arguments job =
        Arguments{"run"} + set({"map.source=file", "map.file=data:maps/dot.pgm", "output.folder=out"});
    CHECK(run_tessera(job + Arguments{"--data", "data"}, here.path()).exit_code == 0);

    const Arguments command = Arguments{tessera_program()} + job;
    CHECK(run_program(command, here.path(), {}, {{"TESSERA_DATA", (here.path() / "data").string()}}).exit_code == 0);

    const ProgramEnd absent = run_program(command, here.path(), {}, {{"TESSERA_DATA", "absent"}});
    CHECK(absent.exit_code == 2);
    CHECK_THAT(absent.err, Contains("absent/maps/dot.pgm"));
}
