#include <algorithm>
#include <catch2/catch.hpp>
#include <set>
#include <sstream>

#include "testbench/run_folder/ply_reader.h"
#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/run_folder.h"

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

Arguments run_of(const Arguments& settings, const std::string& mode = "functional") {
    return Arguments{"run", "--set", "mode=" + mode, "--set", "output.picture=false"} + set(settings);
}

/// One camera for all frames and for the single runs they are compared with.
const std::vector<std::string> small{"map.width=64",
                                     "map.height=64",
                                     "tests.view_threshold=12",
                                     "tests.summed_height_threshold=2",
                                     "camera.eye=[1.05, -2.9, 2.45]",
                                     "camera.target=[0, 0, 0.05]",
                                     "camera.up=[0, 0, 1]",
                                     "camera.near_plane=0.01"};

std::vector<std::string> frames(int count, std::vector<std::string> more = {}) {
    std::vector<std::string> settings = small;
    settings.insert(settings.end(),
                    {"frames.count=" + std::to_string(count), "output.folder=out", "displacement.scale=0.25"});
    settings.insert(settings.end(), more.begin(), more.end());
    return settings;
}

using Table = std::vector<std::vector<std::string>>;

Table read_table(const fs::path& file) {
    Table table;
    for (const std::string& line : lines_of(read_all(file))) {
        std::istringstream in(line);
        table.emplace_back();
        for (std::string cell; std::getline(in, cell, ',');)
            table.back().push_back(cell);
    }
    return table;
}

std::uint64_t number(const Table& table, std::size_t row, const std::string& column) {
    const auto found = std::find(table[0].begin(), table[0].end(), column);
    INFO(column);
    REQUIRE(found != table[0].end());
    return std::stoull(table[row].at(static_cast<std::size_t>(found - table[0].begin())));
}

const std::vector<std::string> three_frames{"frame_000",  "frame_001",  "frame_002",
                                            "frames.csv", "frames.txt", "job.toml"};

std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace

TEST_CASE("a frame equals the plain run of its scale, byte for byte") {
    const TestFolder here;
    const std::string mode = GENERATE("functional", "timed");
    succeed(run_of(frames(3), mode), here.path());
    CHECK(names_in(here.path() / "out") == three_frames);
    const char* const scales[] = {"0", "0.125", "0.25"};
    for (int k = 0; k < 3; ++k) {
        const std::string name = "out/frame_00" + std::to_string(k);
        INFO(name);
        const RunFolder frame(here.path() / name);
        require_consistent(frame);
        const TestFolder elsewhere;
        std::vector<std::string> plain = small;
        plain.insert(plain.end(), {std::string("displacement.scale=") + scales[k], "output.folder=" + name});
        succeed(run_of(plain, mode), elsewhere.path());
        require_same_files(frame.files(), RunFolder(elsewhere.path() / name).files());

        const auto before = frame.files();
        succeed({"run", name + "/job.toml"}, here.path());
        require_same_files(before, RunFolder(here.path() / name).files());
    }
    CHECK(names_in(here.path() / "out") == three_frames);
}

TEST_CASE("frames grow from a flat one, and the table lists their cost") {
    const TestFolder here;
    const ProgramEnd end = succeed(run_of(frames(3), "timed"), here.path());
    for (const glm::dvec3& position : read_ply(here.path() / "out/frame_000/mesh.ply").positions)
        REQUIRE(position.z == 0);
    const Table table = read_table(here.path() / "out/frames.csv");
    REQUIRE(table.size() == 4);
    CHECK(number(table, 2, "triangles") > 2 * number(table, 1, "triangles"));
    for (std::size_t k = 0; k < 3; ++k) {
        const RunFolder frame(here.path() / "out" / table[k + 1][0]);
        CHECK(number(table, k + 1, "triangles") == frame.count("run", "triangles_finished"));
        CHECK(number(table, k + 1, "edges_tested") == frame.count("run", "edges_tested"));
        CHECK(number(table, k + 1, "edges_split") == frame.count("run", "edges_split"));
        CHECK(number(table, k + 1, "cycles") == frame.count("timing", "cycles"));
        CHECK(number(table, k + 1, "base_mesh_bytes") == frame.count("host", "mesh_bytes"));
        CHECK(number(table, k + 1, "tessellated_mesh_bytes") == frame.count("host", "tessellated_mesh_bytes"));
        CHECK(number(table, k + 1, "normal_map_bytes") == 64 * 64 * 6);
        CHECK(number(table, k + 1, "displacement_map_bytes") == (k == 0 ? 64 * 64 * 2 : 0));
        CHECK(number(table, k + 1, "summed_height_table_bytes") == (k == 0 ? 65 * 65 * 4 : 0));
        std::uint64_t sum = 0;
        for (const char* const part : {"base_mesh_bytes", "displacement_map_bytes", "normal_map_bytes",
                                       "summed_height_table_bytes", "register_bytes"})
            sum += number(table, k + 1, part);
        CHECK(number(table, k + 1, "sent_bytes") == sum);
    }
    CHECK(number(table, 3, "register_bytes") == 4);  // S
    CHECK(end.out.rfind(read_all(here.path() / "out/frames.txt"), 0) == 0);
    CHECK_THAT(end.out, Contains("frame_002") && Contains("sent for the first frame"));
}

TEST_CASE("frames are the same when run again, and from the job they write") {
    const TestFolder here;
    succeed(run_of(frames(2)), here.path());
    const auto once = RunFolder(here.path() / "out/frame_001").files();
    const std::string table = read_all(here.path() / "out/frames.csv"), job = read_all(here.path() / "out/job.toml");
    succeed({"run", "out/job.toml"}, here.path());
    require_same_files(once, RunFolder(here.path() / "out/frame_001").files());
    CHECK(read_all(here.path() / "out/frames.csv") == table);
    CHECK(read_all(here.path() / "out/job.toml") == job);
}

TEST_CASE("a frame that fails ends the run with its exit code and its name") {
    const TestFolder here;
    SECTION("a limit") {
        const ProgramEnd end = run_tessera(run_of(frames(3, {"limits.triangles=600"})), here.path());
        INFO(end.text());
        CHECK(end.exit_code == 4);
        CHECK_THAT(end.err, Contains("limits.triangles") && Contains("frame_001") && Contains("1 of 3"));
        CHECK(names_in(here.path() / "out") == std::vector<std::string>{"frame_000"});
    }
    SECTION("a deadlock") {
        const ProgramEnd end = run_tessera(
            run_of(frames(3, {"hardware.queue_capacity=20", "hardware.queue_overflow=stall"}), "timed"), here.path());
        INFO(end.text());
        CHECK(end.exit_code == 3);
        CHECK_THAT(end.err, Contains("deadlock") && Contains("frame_00"));
        CHECK_FALSE(fs::exists(here.path() / "out/frames.csv"));
    }
    SECTION("a check: all frames are written, and the failing ones are named") {
        const ProgramEnd end = run_tessera(
            run_of(frames(3, {"formats.normal_bits=7", "formats.normal_fraction=5", "check.allowed_flips=0"})),
            here.path());
        INFO(end.text());
        CHECK(end.exit_code == 1);
        CHECK_THAT(end.err, Contains("frame_002") && Contains("report.txt") && !Contains("frame_000"));
        CHECK(names_in(here.path() / "out") == three_frames);
    }
    SECTION("a signal") {
        const std::string kill_the_first_frame =
            "\"$0\" run --set frames.count=2 --set output.folder=out --set map.width=1024 & parent=$!\n"
            "until [ \"$child\" ]; do child=$(cat /proc/$parent/task/$parent/children); done\n"
            "kill -TERM $child; wait $parent; echo ended $?";
        const ProgramEnd end = run_program({"sh", "-c", kill_the_first_frame, tessera_program()}, here.path());
        INFO(end.text());
        CHECK_THAT(end.out, Contains("ended 143"));  // 128 + SIGTERM
        CHECK_THAT(end.err, Contains("frame_000") && Contains("Terminated") && Contains("0 of 2"));
        CHECK_FALSE(fs::exists(here.path() / "out/frames.csv"));
    }
}

TEST_CASE("a failure of the first frame leaves the earlier run unchanged") {
    const TestFolder here;
    std::vector<std::string> plain = small;
    plain.emplace_back("output.folder=out");
    succeed(run_of(plain), here.path());
    const std::vector<std::string> names = names_in(here.path() / "out");
    const std::string mesh = read_all(here.path() / "out/mesh.ply");
    const ProgramEnd end = run_tessera(run_of(frames(3, {"limits.triangles=20"})), here.path());
    INFO(end.text());
    CHECK(end.exit_code == 4);
    CHECK_THAT(end.err, Contains("0 of 3"));
    CHECK(names_in(here.path() / "out") == names);
    CHECK(read_all(here.path() / "out/mesh.ply") == mesh);
}

TEST_CASE("a signal to the parent process also ends the frame's process, and a line reports the progress") {
    const TestFolder here;
    const std::string interrupt =
        "\"$0\" run --vcd --set frames.count=20 --set output.folder=out --set map.width=1024 & parent=$!\n"
        "until [ \"$child\" ] && ls out/frame_00[0-9]/.tessera-* >/dev/null 2>&1; do\n"
        "child=$(cat /proc/$parent/task/$parent/children); done\n"
        "kill -TERM $parent; wait $parent; echo ended $?\n"
        "while grep -qs 'State:.[^Z]' /proc/$child/status; do sleep 0.01; done; find out -name '.tessera-*'";
    const ProgramEnd end = run_program({"sh", "-c", interrupt, tessera_program()}, here.path());
    INFO(end.text());
    CHECK_THAT(end.out, Contains("ended 143\n") && !Contains(".tessera-"));
    CHECK_THAT(end.err, Contains("tessera: interrupted (SIGTERM) at ") && Contains("of 20 frames, complete"));
    std::size_t interrupted = 0;
    for (const std::string& line : lines_of(end.err))
        interrupted += line.rfind("tessera: interrupted (SIGTERM) ", 0) == 0;
    CHECK(interrupted == 2);  // the program's and its child's, which runs the frame
    CHECK_FALSE(fs::exists(here.path() / "out/frames.csv"));
}

TEST_CASE("invalid frames are refused before the first, and existing files stay") {
    const TestFolder here;
    succeed(run_of(frames(2)), here.path());
    const std::string table = read_all(here.path() / "out/frames.csv");
    const auto frames_refused = [&](const Arguments& settings) { return refused(run_of(settings), here.path()); };
    // Frame 0 would fit; the displacement of the last leaves too few steps for the mesh.
    CHECK_THAT(frames_refused(
                   frames(3, {"displacement.scale=1e6", "formats.position_bits=16", "formats.position_fraction=0"})),
               Contains("displacement.scale = 1e+06 spans") && Contains("set formats.position_bits = 32"));
    CHECK_THAT(frames_refused(frames(3, {"map.source=file", "map.file=absent.pgm"})), Contains("absent.pgm"));
    CHECK_THAT(frames_refused(frames(0)), Contains("frames.count") && Contains("1 .. 1000"));
    CHECK_THAT(frames_refused({"frames.cuont=3"}), Contains("did you mean `frames.count`?"));
    write_all(here.path() / "job.toml", "[frames]\ncount = 3\nfirst_skale = 0.1\n");
    const ProgramEnd end = run_tessera({"run", "job.toml"}, here.path());
    CHECK(end.exit_code == 2);
    CHECK_THAT(end.err, Contains("job.toml:3:") && Contains("first_scale"));
    CHECK_THAT(frames_refused(frames(3, {"mesh.source=run", "mesh.file=out/frame_001"})),
               Contains("its own base mesh"));
    CHECK_THAT(frames_refused({"mesh.source=run", "mesh.file=out"}), Contains("out/frame_000"));
    CHECK(read_all(here.path() / "out/frames.csv") == table);
    CHECK(fs::exists(here.path() / "out/frame_001/mesh.ply"));
}

TEST_CASE("files of another run in the folder are removed") {
    const TestFolder here;
    const fs::path out = here.path() / "out";
    succeed(run_of(frames(5)), here.path());
    write_all(out / "frame_004/notes.txt", "mine");
    fs::create_directory(out / "frame_100");
    write_all(out / "frame_100/picture.png", "mine, and no run's");

    succeed(run_of(frames(3)), here.path());
    std::vector<std::string> expected = three_frames;
    expected.insert(expected.begin() + 3, {"frame_004", "frame_100"});
    CHECK(names_in(out) == expected);
    CHECK(names_in(out / "frame_004") == std::vector<std::string>{"notes.txt"});
    CHECK(read_all(out / "frame_100/picture.png") == "mine, and no run's");
    fs::remove_all(out / "frame_004");
    fs::remove_all(out / "frame_100");

    std::vector<std::string> plain = small;
    plain.emplace_back("output.folder=out");
    succeed(run_of(plain), here.path());
    const std::vector<std::string> names = names_in(out);
    for (const std::string& name : names)
        CHECK(name.rfind("frame", 0) != 0);
    CHECK(std::count(names.begin(), names.end(), "mesh.ply") == 1);

    succeed(run_of(frames(3)), here.path());
    CHECK(names_in(out) == three_frames);
}

TEST_CASE("frames: each note and each bound is printed once, where it comes first") {
    const TestFolder here;
    const ProgramEnd end =
        run_tessera(run_of(frames(3, {"map.no_data=0.7", "hardware.height_test=rank", "formats.bound_bits=8",
                                      "mesh.source=lattice", "mesh.spacing=16", "tests.bound_threshold=0.05"})),
                    here.path());
    INFO(end.text());
    REQUIRE(end.exit_code == 0);
    const std::vector<std::string> lines = lines_of(end.out);
    const auto count = [&](const std::string& begin) {
        return std::count_if(lines.begin(), lines.end(),
                             [&](const std::string& line) { return line.find(begin) == 0; });
    };
    CHECK(count("  note: map: No texel has the value 0.7 of map.no_data") == 1);
    CHECK(count("  note: tests.bound_threshold = 0.05 is not guaranteed: ") == 1);
    CHECK(count("  bound ") >= 1);
    CHECK(std::set<std::string>(lines.begin(), lines.end()).size() == lines.size());
    CHECK_THAT(read_all(here / "out/frames.txt"), Contains("  note: map: No texel has the value 0.7"));
}

TEST_CASE("map.no_data holds for built-in maps, too") {
    const TestFolder here;
    const auto run_with = [&](const std::string& source, const std::string& no_data) {
        return run_tessera(run_of({"map.source=" + source, "map.value=0.5", "map.no_data=" + no_data, "map.width=32",
                                   "map.height=32", "output.folder=out"}),
                           here.path());
    };
    const ProgramEnd all = run_with("constant", "0.5");
    CHECK(all.exit_code == 2);
    CHECK_THAT(all.err, Contains("every texel of the built-in map"));
    const ProgramEnd some = run_with("half_donut", "0");
    INFO(some.text());
    CHECK(some.exit_code == 0);
    CHECK_THAT(some.out, Contains("note: map: ") && Contains("all checks passed"));
}

TEST_CASE("tune, widths and rank print the notes on their inputs") {
    const Arguments inputs = set({"map.no_data=0.7", "map.width=32", "map.height=32", "mesh.source=lattice",
                                  "mesh.spacing=8", "hardware.height_test=summed_height"});
    for (const Arguments& command :
         {Arguments{"tune", "--triangles", "60", "--vary", "none"}, Arguments{"rank", "--output", "ranks"}}) {
        const TestFolder here;
        const ProgramEnd end = run_tessera(command + inputs, here.path());
        INFO(end.text());
        CHECK(end.exit_code == 0);
        CHECK_THAT(end.out, Contains("  note: map: No texel has the value 0.7 of map.no_data"));
    }
}
