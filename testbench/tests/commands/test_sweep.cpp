#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <iostream>

#include "testbench/tests/support/checkout.h"
#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/text.h"

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

bool sweeps_run() {
    const ProgramEnd end = run_program({"sh", "-c", "/usr/bin/env snakemake --version"}, source_folder());
    if (end.exit_code != 0)
        std::cout << "this test is skipped: snakemake is not installed (scripts/install sweep)\n";
    return end.exit_code == 0;
}

/// Nine designs of a tiny job. In three of them a full queue may not spill, and the run deadlocks.
const std::string small = R"(job = "half_donut"
figures = ["timing.cycles", "timing.bottleneck"]
minimise = ["timing.cycles_per_triangle", "area"]

[set]
"tests.generation_limit" = 3
"check.golden" = false
"check.end_to_end" = false
"check.invariants" = false

[derived]
area = { is = "area.total_register_bits + area.triangle_queue_memory_bits", unit = "bit" }

[[axis]]
key = "timing.summed_height_table_ports"
values = [1, 2, 4]

[[axis]]
name = "queue"
[axis.points]
unbounded = {}
small = { "hardware.queue_capacity" = 2, "hardware.queue_overflow" = "stall" }
stack = { "hardware.queue_order" = "lifo" }
)";

ProgramEnd sweep(const Checkout& checkout, const std::string& text, const std::string& options = {}) {
    write_all(checkout.root() / "small.toml", text);
    return checkout.run("scripts/sweep small.toml " + options);
}

std::size_t results_in(const fs::path& store) {
    std::size_t count = 0;
    if (fs::exists(store))
        for (const auto& entry : fs::recursive_directory_iterator(store))
            count += entry.path().extension() == ".gz";
    return count;
}

}  // namespace

TEST_CASE("sweep: if no design finishes, the first reason is said, and the exit code is 1") {
    if (!sweeps_run())
        return;
    const Checkout checkout;
    const ProgramEnd end = sweep(checkout, testing::replaced(small, "[set]\n", "[set]\n\"limits.triangles\" = 1\n"));
    INFO(end.text());
    CHECK(end.exit_code == 1);
    CHECK_THAT(end.err, Contains("no design finished; the first says: exit code 4: "));
}

TEST_CASE("sweep: each design is a row, the front is marked, a failed run is a row with its reason") {
    if (!sweeps_run())
        return;
    const Checkout checkout;
    const ProgramEnd end = sweep(checkout, small);
    INFO(end.text());
    REQUIRE(end.exit_code == 0);
    const fs::path folder = checkout.root() / "runs/sweeps";
    const std::string table = read_all(folder / "small/table.csv");
    const std::vector<std::string> rows = lines_of(table);
    INFO(table);
    REQUIRE(rows.size() == 10);
    CHECK_THAT(rows[0],
               Contains("run,scene,timing.summed_height_table_ports [entries per cycle],queue,timing.cycles [cycle],"
                        "timing.bottleneck,area [bit],timing.cycles_per_triangle [cycle/triangle],front,status"));
    CHECK_THAT(rows[1], Contains("0,half_donut,1,unbounded,") && Contains(",ok,"));
    CHECK_THAT(rows[2], Contains(",failed,") && Contains("exit code 3: "));
    CHECK_THAT(table, !Contains(checkout.root().string()));
    CHECK_THAT(end.err, Contains("9 designs; 8 runs to do") && Contains("6 ok, 3 failed"));

    INFO("a sweep that shares designs runs only what is new");
    CHECK_THAT(sweep(checkout, testing::replaced(small, "[1, 2, 4]", "[1, 2, 4, 8]"), "--check").err,
               Contains("12 designs; 3 runs to do"));

    INFO("the effective job is the address: a default that is written out is the same run");
    CHECK_THAT(
        sweep(checkout, testing::replaced(small, "[set]\n", "[set]\n\"timing.transform_latency\" = 20\n"), "--check")
            .err,
        Contains("9 designs; 0 runs to do"));

    INFO("keys beside hardware.design stay as the sweep has them; `unbounded` and `stack` are then the same");
    const std::string modern = "[[axis]]\nkey = \"hardware.design\"\nvalues = [\"modern\"]\n";
    CHECK_THAT(sweep(checkout, small + modern, "--check").err, Contains("9 designs; 5 runs to do"));

    INFO("killed between its runs and resumed: the same bytes, and nothing runs twice");
    const std::string address = rows[1].substr(rows[1].rfind(',') + 1);
    fs::remove_all(folder);
    write_all(checkout.root() / "small.toml", small);
    const ProgramEnd killed = checkout.run(
        "setsid scripts/sweep small.toml & sleep 0.2; "
        "until [ \"$(find runs/sweeps/results -name '*.gz' | wc -l)\" -ge 2 ]; do sleep 0.02; done 2>/dev/null; "
        "kill -KILL -- -$!; wait $! || true");
    INFO(killed.text());
    const std::size_t before = results_in(folder / "results");
    CHECK(before >= 2);
    CHECK(before < 9);
    CHECK_FALSE(fs::exists(folder / "small/table.csv"));
    const fs::path first = folder / "results" / address.substr(0, 2) / (address + ".json.gz");
    REQUIRE(fs::exists(first));
    const auto written = fs::last_write_time(first);
    const ProgramEnd resumed = checkout.run("scripts/sweep small.toml");
    INFO(resumed.text());
    CHECK(resumed.exit_code == 0);
    CHECK(read_all(folder / "small/table.csv") == table);
    CHECK(fs::last_write_time(first) == written);
    CHECK(results_in(folder / "results") == 9);

    INFO("another program's results are not these");
    const fs::path program = checkout.root() / "build/release/testbench/commands/tessera";
    fs::remove(program);
    fs::copy(tessera_program(), program);
    std::ofstream(program, std::ios::app) << "x";
    CHECK_THAT(checkout.run("scripts/sweep small.toml --check").err, Contains("9 designs; 8 runs to do"));
}

TEST_CASE("sweep: a result is named by the content of every file that it depends on") {
    if (!sweeps_run())
        return;
    const Checkout checkout;
    const fs::path root = checkout.root(), data = root / "../shared/data";
    fs::create_directories(data);
    const std::string square =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
    const std::string map = "P2\n2 2\n255\n0 90 0 0\n";
    write_all(data / "map.pgm", map);
    write_all(data / "mesh.obj", square);
    write_all(root / "mesh.obj", square);
    write_all(root / "map.pgm", map);
    write_all(root / "one.toml",
              "mode = \"functional\"\n[mesh]\nfile = \"mesh.obj\"\n[map]\nfile = \"data:map.pgm\"\n");
    write_all(
        root / "two.toml",
        "mode = \"functional\"\n[mesh]\nfile = \"data:mesh.obj\"\n[map]\nfile = \"map.pgm\"\n[displacement]\nscale = 0.3\n");
    write_all(root / "three.toml",
              "mode = \"functional\"\n[mesh]\nsource = \"run\"\nfile = \"earlier\"\n[map]\nsource = \"constant\"\n");
    REQUIRE(
        checkout
            .run(
                "TESSERA_DATA=../shared/data build/release/testbench/commands/tessera run one.toml --set output.folder=earlier")
            .exit_code == 0);
    const std::string three_jobs =
        "scenes = [\"one.toml\", \"two.toml\", \"three.toml\"]\nfigures = [\"mesh.triangles\"]\n"
        "[[axis]]\nkey = \"check.work\"\nvalues = [true]\n";
    const ProgramEnd first = sweep(checkout, three_jobs);
    INFO(first.text());
    REQUIRE(first.exit_code == 0);
    const auto to_do = [&](const std::string& environment) {
        const ProgramEnd end = checkout.run(environment + "scripts/sweep small.toml --check");
        INFO(end.text());
        CHECK(end.exit_code == 0);
        return end.err;
    };
    CHECK_THAT(to_do(""), Contains("; 0 runs to do"));

    // A scene without any result is tried by --check itself: what is counted is the number of results.
    std::size_t results = 3;
    const auto is_another = [&](const std::string& environment) {
        to_do(environment);
        CHECK(results_in(root / "runs/sweeps/results") == ++results);
    };
    const auto is_an_input = [&](const fs::path& file, const std::string& from, const std::string& to) {
        INFO(file.lexically_relative(root).string());
        const std::string before = read_all(file);
        write_all(file, testing::replaced(before, from, to));
        is_another("");
        write_all(file, before);
        CHECK_THAT(to_do(""), Contains("; 0 runs to do"));
        CHECK(results_in(root / "runs/sweeps/results") == results);
    };
    is_an_input(data / "map.pgm", "90", "91");
    is_an_input(data / "mesh.obj", "v 1 1 0", "v 1 2 0");
    is_an_input(root / "map.pgm", "90", "91");
    is_an_input(root / "mesh.obj", "v 1 1 0", "v 1 3 0");
    is_an_input(root / "one.toml", "[map]", "[displacement]\nscale = 0.5\n[map]");
    is_an_input(root / "earlier/mesh.ply", "comment base", "comment  base");
    is_an_input(root / "earlier/job.toml", "viewport_width = 1024", "viewport_width = 1023");

    INFO("the same names in another data folder, named from here, not from a run's folder");
    fs::create_directories(root / "other");
    write_all(root / "other/map.pgm", testing::replaced(map, "90", "92"));
    write_all(root / "other/mesh.obj", square);
    is_another("TESSERA_DATA=other ");
    CHECK_THAT(to_do("TESSERA_DATA=other "), Contains("; 0 runs to do"));
}

TEST_CASE("sweep: a run during which an input changes has no result") {
    if (!sweeps_run())
        return;
    const Checkout checkout;
    const fs::path program = checkout.root() / "build/release/testbench/commands/tessera";
    const std::string changed =
        GENERATE(as<std::string>(), "map.pgm", "one.toml", "build/release/testbench/commands/tessera");
    fs::remove(program);
    write_all(
        program,
        "#!/bin/sh\ncase \"$*\" in *--dump-config*) ;; *output.folder*) touch -d 2001-01-01 \"$CHANGED\" ;; esac\nexec \"" +
            tessera_program() + "\" \"$@\"\n");
    fs::permissions(program, fs::perms::owner_all);
    write_all(checkout.root() / "map.pgm", "P2\n2 2\n255\n0 90 0 0\n");
    write_all(checkout.root() / "one.toml", "mode = \"functional\"\n[map]\nfile = \"map.pgm\"\n");
    write_all(checkout.root() / "small.toml",
              "job = \"one.toml\"\nfigures = [\"mesh.triangles\"]\n[[axis]]\nkey = \"check.work\"\nvalues = [true]\n");
    const ProgramEnd end = checkout.run("CHANGED=$PWD/" + changed + " scripts/sweep small.toml");
    INFO(changed << end.text());
    CHECK(end.exit_code == 1);
    CHECK_THAT(end.err, Contains("1 no result"));
    CHECK(results_in(checkout.root() / "runs/sweeps/results") == 0);
    CHECK_THAT(read_all(checkout.root() / "runs/sweeps/small/table.csv"),
               Contains(changed + " was changed since this began; start it again"));
}

TEST_CASE("sweep: a path in a sweep file is from its folder, and a missing file is refused and leaves no result") {
    if (!sweeps_run())
        return;
    const Checkout checkout;
    const fs::path root = checkout.root(), results = root / "runs/sweeps/results";
    const std::string map = "P2\n2 2\n255\n0 90 0 0\n";
    fs::create_directories(root / "maps");
    write_all(root / "maps/a.pgm", map);
    write_all(root / "maps/b.pgm", testing::replaced(map, "90", "91"));
    write_all(root / "a.pgm", testing::replaced(map, "90", "92"));
    write_all(root / "maps/one.toml", "mode = \"functional\"\n");
    const auto run = [&](const std::string& text, const std::string& options = {}) {
        write_all(root / "maps/s.toml", "job = \"one.toml\"\nfigures = [\"mesh.triangles\"]\n" + text);
        return checkout.run("scripts/sweep maps/s.toml " + options);
    };
    const std::string work = "[[axis]]\nkey = \"check.work\"\nvalues = [true]\n",
                      set = "[set]\n\"map.file\" = \"a.pgm\"\n" + work,
                      axis = "[[axis]]\nkey = \"map.file\"\nvalues = [\"a.pgm\", \"b.pgm\"]\n";
    const ProgramEnd end = run(set);
    INFO(end.text());
    CHECK(end.exit_code == 0);
    INFO("the same file by its absolute path is the same run, and the axis adds one");
    CHECK_THAT(run(testing::replaced(set, "\"a.pgm", "\"" + (root / "maps/a.pgm").string()), "--check").err,
               Contains("; 0 runs to do"));
    const ProgramEnd both = run(axis);
    INFO(both.text());
    CHECK(both.exit_code == 0);
    CHECK_THAT(both.err, Contains("2 designs; 1 runs to do") && Contains("2 ok"));
    CHECK_THAT(read_all(root / "runs/sweeps/s/table.csv"), Contains("0,one,a.pgm,"));
    CHECK(results_in(results) == 2);

    INFO("missing");
    const auto is_refused = [&](const std::string& text, const std::string& message) {
        const ProgramEnd refused = run(text, "--check");
        INFO(refused.text());
        CHECK(refused.exit_code == 2);
        CHECK_THAT(refused.err, Contains(message + "`map.file`: there is no file "));
        CHECK(results_in(results) == 2);
    };
    is_refused(testing::replaced(set, "a.pgm", "c.pgm"), "s.toml:4: ");
    is_refused(testing::replaced(axis, "b.pgm", "c.pgm"), "s.toml:5: ");
    write_all(root / "maps/one.toml", "mode = \"functional\"\n[map]\nfile = \"c.pgm\"\n");
    is_refused(work, "s.toml:1: ");
    INFO("a missing file that only some designs read is found by their runs");
    const ProgramEnd later = run("[[axis]]\nname = \"map\"\n[axis.points]\nown = {}\nb = {\"map.file\" = \"b.pgm\"}\n");
    INFO(later.text());
    CHECK(later.exit_code == 1);
    CHECK_THAT(later.err, Contains("1 ok, 1 no result"));
    CHECK_THAT(read_all(root / "runs/sweeps/s/table.csv"), Contains("there is no file ") && Contains("maps/c.pgm"));
    CHECK(results_in(results) == 2);
}

TEST_CASE("sweep: an axis along which no figure changes is named, on the page too") {
    if (!sweeps_run())
        return;
    const Checkout checkout;
    const auto axis = [](const std::string& keys) { return "[[axis]]\n" + keys; };
    const std::string sweep_of = testing::replaced(small, small.substr(small.find("[[axis]]")), ""),
                      ports = axis("key = \"timing.summed_height_table_ports\"\nvalues = [1, 2]\n"),
                      idle = axis("key = \"timing.height_table_ports\"\nvalues = [1, 4]\n"),
                      pair = axis(
                          "keys = [\"timing.off_chip_latency\", \"timing.off_chip_buffer\"]\n"
                          "values = [[40, 4], [50, 8]]\n"),
                      one = axis("key = \"hardware.queue_order\"\nvalues = [\"lifo\"]\n");
    const ProgramEnd end = sweep(checkout, sweep_of + idle + ports + pair + one);
    INFO(end.text());
    REQUIRE(end.exit_code == 0);
    const std::string page = read_all(checkout.root() / "runs/sweeps/small/index.html");
    for (const char* const name : {"timing.height_table_ports", "timing.off_chip_latency, timing.off_chip_buffer"}) {
        CHECK_THAT(end.err, Contains("axis " + std::string(name) + " changed no figure"));
        CHECK_THAT(page, Contains("axis " + std::string(name) + " changed no figure"));
    }
    CHECK_THAT(end.err, !Contains("axis timing.summed_height_table_ports") && !Contains("axis hardware.queue_order") &&
                            !Contains("unbounded queues"));
}

TEST_CASE("sweep: a figure of some designs only is found, and an axis on which only the end depends is not idle") {
    if (!sweeps_run())
        return;
    const Checkout checkout;
    const std::string head =
        testing::replaced(testing::replaced(small, small.substr(small.find("[[axis]]")), ""),
                          "figures = [\"timing.cycles\"", "figures = [\"displacement_map.cache_hit_rate\"");
    const ProgramEnd end =
        sweep(checkout, head +
                            "[[axis]]\nkey = \"timing.displacement_map_cache_bytes\"\nvalues = [0, 256]\n"
                            "[[axis]]\nkey = \"hardware.queue_overflow\"\nvalues = [\"spill\", \"error\"]\n"
                            "[[axis]]\nkey = \"hardware.queue_capacity\"\nvalues = [0, 2]\n");
    INFO(end.text());
    CHECK_THAT(end.err, Contains("6 ok, 2 failed") && !Contains("axis hardware.queue_overflow"));
    CHECK_THAT(read_all(checkout.root() / "runs/sweeps/small/table.csv"), Contains("displacement_map.cache_hit_rate"));
    const std::string uncounted = "the area does not count unbounded queues";
    CHECK_THAT(end.err, Contains(uncounted));
    CHECK_THAT(read_all(checkout.root() / "runs/sweeps/small/index.html"), Contains(uncounted));
    CHECK_THAT(checkout.run("sed -i '/^minimise/d;/^area/d' small.toml; scripts/sweep small.toml --report").err,
               !Contains(uncounted));
}

TEST_CASE("sweep: a run that does not end is a row, and is tried again") {
    if (!sweeps_run())
        return;
    const Checkout checkout;
    const ProgramEnd end = sweep(checkout, "longest_run = 0.001\n" + testing::replaced(small, "[1, 2, 4]", "[1]"));
    INFO(end.text());
    CHECK(end.exit_code == 1);
    CHECK_THAT(read_all(checkout.root() / "runs/sweeps/small/table.csv"),
               Contains(",no result,took longer than 0.001 s,"));
    CHECK(sweep(checkout, testing::replaced(small, "[1, 2, 4]", "[1]")).exit_code == 0);
}

TEST_CASE("sweep: workers that share a study search some of the designs, each run once") {
    if (!sweeps_run())
        return;
    const Checkout checkout;
    const auto [storage, file] = GENERATE(table<std::string, std::string>(
        {{"", "runs/sweeps/small_search/search.journal"}, {" --storage sqlite:///study.db", "study.db"}}));
    const ProgramEnd end = sweep(checkout, small + "\n[search]\nruns = 5\n", "--search --workers 2" + storage);
    INFO(end.text());
    REQUIRE(end.exit_code == 0);
    const fs::path folder = checkout.root() / "runs/sweeps";
    const std::vector<std::string> rows = lines_of(read_all(folder / "small_search/table.csv"));
    CHECK(rows.size() > 3);
    CHECK(rows.size() <= 7);  // both workers may start the last run
    CHECK(results_in(folder / "results") == rows.size() - 1);
    CHECK(fs::exists(checkout.root() / file));

    INFO("the study of another sweep file is another one");
    const ProgramEnd other =
        checkout.run("sed -i 's/1, 2, 4/3, 6, 8/' small.toml; scripts/sweep small.toml --search --workers 2" + storage);
    INFO(other.text());
    CHECK(other.exit_code == 0);
}

TEST_CASE("sweep: the study of a search is another one if a file that its jobs or axes name changes") {
    const Checkout checkout;
    const fs::path root = checkout.root();
    for (const char* const name : {"a.pgm", "b.pgm"})
        write_all(root / name, "P2\n2 2\n255\n0 90 0 0\n");
    write_all(root / "one.toml", "[map]\nfile = \"a.pgm\"\n");
    write_all(root / "small.toml",
              "job = \"one.toml\"\n[[axis]]\nkey = \"map.file\"\nvalues = [\"a.pgm\", \"b.pgm\"]\n");
    write_all(root / "name.py",
              "import sys\nfrom pathlib import Path\nsys.path.append('scripts/exploration')\n"
              "from plan import Planner\nfrom sweep_file import read_sweep\n"
              "planner = Planner(read_sweep(Path('small.toml')), Path('build/release/testbench/commands/tessera'))\n"
              "print(planner.hash.address(planner.content()))\n");
    const auto name = [&] {
        const ProgramEnd end = checkout.run("python3 -B name.py");
        INFO(end.text());
        REQUIRE(end.exit_code == 0);
        return end.out;
    };
    const std::string before = name();
    CHECK(name() == before);
    for (const char* const changed : {"a.pgm", "b.pgm", "one.toml", "small.toml"}) {
        INFO(changed);
        const std::string text = read_all(root / changed);
        write_all(root / changed, text + "# another\n" + (changed == std::string("one.toml") ? "width = 3\n" : ""));
        CHECK(name() != before);
        write_all(root / changed, text);
    }
    CHECK(name() == before);
}

TEST_CASE("figures: a result is named by the content of every file that it depends on") {
    const Checkout checkout;
    const fs::path root = checkout.root();
    for (const char* const folder : {"jobs", "../shared/data"})
        fs::create_directories(root / folder);
    write_all(root / "jobs/one.toml", "[mesh]\nfile = \"mesh.obj\"\n[map]\nfile = \"data:map.pgm\"\n");
    write_all(root / "jobs/mesh.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
    write_all(root / "../shared/data/map.pgm", "P2\n2 2\n255\n0 90 0 0\n");
    write_all(root / "surface.toml", "a surface");
    write_all(
        root / "keys.py",
        "import sys\nfrom argparse import Namespace\nfrom pathlib import Path\n"
        "sys.path[:0] = ['scripts/evaluation', 'scripts/exploration']\n"
        "sys.modules['emitted_mesh'] = Namespace(read_mesh=None)  # needs numpy\n"
        "import study\nfrom program import ContentHash\nfrom store import Store\n"
        "study.JOBS = Path('jobs').resolve()\nprogram = Path('build/release/testbench/commands/tessera').absolute()\n"
        "one = study.Study('s', Namespace(program=program, picture_width=8), Store('results'), ContentHash(program))\n"
        "run = one.run('run', 'one')\nrun.render('shaded')\n"
        "one.tune('tune', 9, 'one')\none.bake('bake', Path('surface.toml').resolve(), study.JOBS / 'one.toml')\n"
        "for each in [*one.runs]:\n    print(each.task.key)\n    assert each.task.inputs or each.name == 'run'\n");
    const auto keys = [&] {
        const ProgramEnd end = checkout.run("python3 -B keys.py");
        INFO(end.text());
        REQUIRE(end.exit_code == 0);
        return lines_of(end.out);
    };
    const std::vector<std::string> before = keys();
    REQUIRE(before.size() == 4);
    // run, its picture, tune, bake
    using Row = std::pair<const char*, std::vector<std::size_t>>;
    for (const auto& [file, others] :
         {Row{"../shared/data/map.pgm", {0, 1, 2, 3}}, Row{"jobs/mesh.obj", {0, 1, 2, 3}}, Row{"surface.toml", {3}}}) {
        INFO(file);
        const std::string text = read_all(root / file);
        write_all(root / file, text + "#\n");
        const std::vector<std::string> after = keys();
        for (std::size_t k = 0; k < before.size(); ++k) {
            INFO(k);
            CHECK((after.at(k) != before[k]) == (std::count(others.begin(), others.end(), k) > 0));
        }
        write_all(root / file, text);
    }
    CHECK(keys() == before);
}

TEST_CASE("sweep: the error of each design is measured if a figure needs it") {
    if (!sweeps_run())
        return;
    const Checkout checkout;
    const ProgramEnd end = sweep(checkout,
                                 "job = \"half_donut\"\n"
                                 "minimise = [\"mesh.triangles\", \"error.interpolated.reference_to_mesh_rms\"]\n"
                                 "[set]\n\"mode\" = \"functional\"\n\"map.width\" = 32\n\"map.height\" = 32\n"
                                 "[[axis]]\nkey = \"tests.generation_limit\"\nvalues = [1, 4]\n");
    INFO(end.text());
    REQUIRE(end.exit_code == 0);
    CHECK_THAT(end.err, Contains("2 ok; 2 on the front"));  // fewer triangles, or a smaller error
    CHECK_THAT(read_all(checkout.root() / "runs/sweeps/small/table.csv"),
               Contains("error.interpolated.reference_to_mesh_rms [model unit]"));
}

TEST_CASE("sweep: the first commands of its README run") {
    if (!sweeps_run())
        return;
    const Checkout checkout;
    unsigned commands = 0;
    for (const std::string& line : lines_of(read_all(source_folder() / "scripts/exploration/README.md"))) {
        if (line.rfind("scripts/sweep testbench/examples/sweeps/first.toml", 0) != 0)
            continue;
        ++commands;
        const ProgramEnd end = checkout.run(line);
        INFO(line << end.text());
        CHECK(end.exit_code == 0);
        CHECK_THAT(end.err, Contains(commands == 1 ? "first: 8 designs; 7 runs to do" : "8 ok; "));
    }
    CHECK(commands == 2);
}

TEST_CASE("sweep: if Slurm does not start, its test gets the reason") {
    const Checkout checkout;
    for (const char* const tool : {"munged", "slurmctld", "slurmd", "sbatch"}) {
        write_all(checkout.root() / "tools" / tool, "#!/bin/sh\nexit 1\n");
        fs::permissions(checkout.root() / "tools" / tool, fs::perms::owner_all);
    }
    const ProgramEnd end = checkout.run("scripts/checks/sweep_tests/slurm_cluster start cluster");
    INFO(end.text());
    CHECK(end.exit_code == 3);
    CHECK_THAT(end.err, Contains("slurm_cluster: munged does not start") || Contains("needs root"));
}

TEST_CASE("sweep: an invalid study is refused before the first run, with file and line") {
    const Checkout checkout;
    const auto [from, to, message] = GENERATE(table<std::string, std::string, std::string>({
        {"table_ports\"", "table_port\"", "small.toml:15: unknown key `timing.summed_height_table_port`"},
        {"generation_limit", "generations", "small.toml:6: unknown key `tests.generations`"},
        {"[1, 2, 4]", "[]", "small.toml:14: this axis has no values: the product is empty"},
        {"[1, 2, 4]", "[1, 2, 400]", "small.toml:15: `timing.summed_height_table_ports` = 400 is out of range"},
        {"figures =", "figure =", "small.toml:2: unknown entry `figure`"},
        {"half_donut", "half_donat", "small.toml:1: there is no job `half_donat`"},
        {"[set]", "constraints = [\"hardware.machines > 1\"]\n[set]",
         "small.toml:5: the constraints exclude every design: the product is empty"},
        {"[set]", "constraints = [\"hardware.machine > 1\"]\n[set]", "small.toml:5: unknown key `hardware.machine`"},
        {"[set]", "constraints = [\"open('x')\"]\n[set]", "small.toml:5: `open('x')`: only names"},
        {"timing.cycles\"", "timing.cycle\"", "small.toml:2: no run has the figure `timing.cycle`"},
        {"\"queue\"", "\"queue", "small.toml: "},
        {"key = ", "keys = ", "small.toml:14: "},
        {"stack = { ", "stack = { \"timing.summed_height_table_ports\" = 2, ",
         "small.toml:23: `timing.summed_height_table_ports` is also on another axis, line 14"},
    }));
    if (!sweeps_run())
        return;
    const ProgramEnd end = sweep(checkout, testing::replaced(small, from, to));
    INFO(from << " -> " << to << end.text());
    CHECK(end.exit_code == 2);
    CHECK_THAT(end.err, Contains(message));
    // A figure is looked for in a run of each value of the axes.
    CHECK(results_in(checkout.root() / "runs/sweeps/results") <= (from == "timing.cycles\"" ? 5 : 1));
}
