#include <catch2/catch.hpp>
#include <sstream>

#include "testbench/job/job_keys.h"
#include "testbench/job/read_job.h"
#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/run_folder.h"

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

TEST_CASE("the default job writes a complete run folder with consistent figures") {
    const TestFolder here;
    const ProgramEnd end = succeed({"run"}, here.path());
    CHECK(here.names() == std::vector<std::string>{"runs"});

    const fs::path folder = here.path() / "runs/half_donut";
    const RunFolder run(folder);
    require_consistent(run);
    CHECK(run.count("host", "base_triangles") == 18);
    CHECK(run.count("pass_or_tessellate", "culled") == 0);
    CHECK(run.count("summed_height_table", "reads") == 12 * run.count("run", "edges_tested"));
    CHECK(run.conformance["remarks"].empty());

    CHECK_THAT(end.out, Contains("all checks passed\n"));
    CHECK_THAT(end.out, Contains("18 base -> "));
    CHECK_THAT(end.out, Contains("0 mismatches"));
    CHECK_THAT(end.out, Contains("results in " + folder.string() + "\n"));
    CHECK_THAT(end.out, !Contains("note:") && !Contains("warning:"));
    CHECK_THAT(end.out, !Contains("\x1b"));
    CHECK_THAT(end.out, !Contains("SystemC"));

    const std::string readme = read_all(source_folder() / "README.md"), before = "prints (shortened):\n\n";
    REQUIRE_THAT(readme, Contains(before));
    const std::size_t begin = readme.find(before) + before.size();
    std::istringstream shown(readme.substr(begin, readme.find("    results in", begin) - begin));
    unsigned lines = 0;
    for (std::string line; std::getline(shown, line); ++lines)
        CHECK_THAT(end.out, Contains(line.substr(4, line.find("...") - 4)));
    CHECK(lines == 9);
}

TEST_CASE("the summary reports which test decided, with the statistics' figures") {
    const TestFolder here;
    // The 6 edges of one quad, all split, and 24 edges of their children, stopped by generation 1.
    const ProgramEnd end = succeed(
        Arguments{"run"} + set({"mode=functional", "mesh.columns=1", "mesh.rows=1", "map.source=noise", "map.width=64",
                                "map.height=64", "tests.normal_threshold=0", "tests.summed_height=false",
                                "tests.generation_limit=1", "output.picture=false", "output.folder=out"}),
        here.path());
    CHECK_THAT(end.out, Contains("split by                normal alone 6, summed height alone 0, both 0\n"));
    CHECK_THAT(end.out,
               Contains("requested, stopped by   view alone 0, tex coord alone 0, generation alone 24, several 0\n"));
    const RunFolder run(here.path() / "out");
    CHECK(run.count("pass_or_tessellate", "split_by_normal") == 6);
    CHECK(run.count("pass_or_tessellate", "stopped_by_view_alone") == 0);
    CHECK(run.count("pass_or_tessellate", "stopped_by_tex_coord_alone") == 0);
    CHECK(run.count("pass_or_tessellate", "stopped_by_generation_alone") == 24);
    CHECK(run.count("pass_or_tessellate", "stopped_by_several") == 0);
}

TEST_CASE("two runs write identical bytes, and so do the jobs they write") {
    const TestFolder here;
    // The folder's name is part of the job: the runs keep it and start in different working folders.
    const auto run_in = [&](const std::string& name, const Arguments& arguments) {
        fs::create_directory(here.path() / name);
        succeed(Arguments{"run"} + arguments, here.path() / name);
        return RunFolder(here.path() / name / "runs/half_donut").files();
    };
    const auto first = run_in("first", {});
    require_same_files(first, run_in("second", {}));

    const std::string dump = succeed({"run", "--dump-config"}, here.path()).out;
    write_all(here.path() / "dump.toml", dump);
    CHECK_THAT(dump, Contains("eye = \"auto\"") && Contains("scale = \"auto\""));
    CHECK(automatic_key(parse_job(first.at("job.toml"), "job.toml")).empty());
    require_same_files(first, run_in("dumped", {(here.path() / "dump.toml").string()}));
    require_same_files(first, run_in("own", {(here.path() / "first/runs/half_donut/job.toml").string()}));
    // This job states some defaults in other words.
    auto stated = run_in("file", {(source_folder() / "testbench/examples/jobs/half_donut.toml").string()});
    stated["job.toml"] = first.at("job.toml");
    require_same_files(first, stated);
    CHECK(succeed({"run", (here.path() / "dump.toml").string(), "--dump-config"}, here.path()).out == dump);
}

TEST_CASE("a job that reads files runs again from its run folder") {
    const TestFolder here;
    fs::create_directories(here.path() / "inputs");
    write_all(here.path() / "inputs/square.obj",
              "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
    write_all(here.path() / "inputs/bump.pgm", "P2 3 3 4\n0 1 0\n1 4 1\n0 1 0\n");
    write_all(here.path() / "inputs/job.toml",
              "[mesh]\nsource = \"file\"\nfile = \"square.obj\"\n"
              "[map]\nsource = \"file\"\nfile = \"bump.pgm\"\n"
              "[tests]\ngeneration_limit = 4\ntex_coord = false\n[output]\nfolder = \"out\"\n");
    succeed({"run", "inputs/job.toml"}, here.path());
    const auto first = RunFolder(here.path() / "out").files();
    fs::copy(here.path() / "out", here.path() / "again");

    SECTION("from another working folder") {
        fs::create_directory(here.path() / "elsewhere");
        succeed({"run", "../out/job.toml", "--set", "output.folder=../out"}, here.path() / "elsewhere");
        auto second = RunFolder(here.path() / "out").files();
        // the folder's name as it was set
        CHECK_THAT(second.at("job.toml"), Contains("folder = \"../out\""));
        second["job.toml"] = first.at("job.toml");
        require_same_files(first, second);
    }
    SECTION("from the first working folder, with paths set on the command line") {
        succeed(Arguments{"run"} + set({"mesh.source=file", "mesh.file=inputs/square.obj", "map.source=file",
                                        "map.file=inputs/bump.pgm", "tests.generation_limit=4", "tests.tex_coord=false",
                                        "output.folder=out"}),
                here.path());
        require_same_files(first, RunFolder(here.path() / "out").files());
    }
}

TEST_CASE("a run replaces the files of an earlier run in its folder") {
    const TestFolder here;
    const Arguments small = Arguments{"run"} + set({"output.folder=out", "tests.generation_limit=2"});
    succeed(small + set({"output.obj=true"}), here.path());
    CHECK(fs::exists(here.path() / "out/mesh.obj"));
    write_all(here.path() / "out/notes.txt", "mine");
    succeed(small + set({"output.ply=false", "output.picture=false"}), here.path());
    // A mesh of another job would seem to belong to these statistics.
    CHECK_FALSE(fs::exists(here.path() / "out/mesh.ply"));
    CHECK_FALSE(fs::exists(here.path() / "out/mesh.obj"));
    CHECK_FALSE(fs::exists(here.path() / "out/picture.png"));
    CHECK(read_all(here.path() / "out/notes.txt") == "mine");
    CHECK(fs::exists(here.path() / "out/statistics.json"));
}
