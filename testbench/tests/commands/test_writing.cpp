#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <map>

#include "testbench/tests/support/checkout.h"
#include "testbench/tests/support/program_runner.h"

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

using Files = std::map<std::string, std::string>;

Files files_in(const fs::path& folder) {
    Files files;
    std::error_code absent;
    for (const auto& entry : fs::recursive_directory_iterator(folder, absent))
        files[entry.path().lexically_relative(folder).string()] =
            entry.is_regular_file() ? read_all(entry.path()) : "(folder)";
    return files;
}

bool is_unfinished(const std::string& name) {
    return name.find("/.tessera-") != std::string::npos;
}

/// A run small enough to repeat some hundred times, with every file except the picture, which takes long.
Arguments run_arguments(const std::string& seed) {
    return Arguments{"run", "--vcd"} +
           set({"map.width=16", "map.height=16", "map.source=noise", "tests.generation_limit=3", "output.picture=false",
                "output.trace_to=3000", "output.folder=out/run", "map.seed=" + seed});
}

ProgramEnd run_failing(const std::vector<std::string>& arguments, const fs::path& folder, long at,
                       const std::string& what) {
    return run_program(
        Arguments{tessera_program()} + arguments, folder, {},
        {{"LD_PRELOAD", TESSERA_FAILING_DISK}, {"TESSERA_FAILING_DISK", std::to_string(at) + ":" + what}});
}

/// The number of calls that access the disk.
long disk_calls(const std::vector<std::string>& arguments, const fs::path& folder) {
    const TestFolder log;
    const ProgramEnd end =
        run_program(Arguments{tessera_program()} + arguments, folder, {},
                    {{"LD_PRELOAD", TESSERA_FAILING_DISK}, {"TESSERA_DISK_LOG", (log.path() / "calls").string()}});
    INFO(end.text());
    REQUIRE(end.exit_code == 0);
    const long calls = std::stol(read_all(log.path() / "calls"));
    REQUIRE(calls > 4);
    return calls;
}

/// What a command may leave, even if it fails: all earlier files, or all files that it writes.
struct Expected {
    Files before, after;
};

void check_ends_well(const std::vector<std::string>& arguments, const fs::path& folder, const Expected& expected,
                     const std::string& what) {
    const long calls = disk_calls(arguments, folder);
    long failures = 0;
    for (long at = 1; at <= calls; ++at) {
        fs::remove_all(folder / "out");
        for (const auto& [name, content] : expected.before)
            if (content == "(folder)")
                fs::create_directories(folder / "out" / name);
            else
                write_all(folder / "out" / name, content);
        const ProgramEnd end = run_failing(arguments, folder, at, what);
        INFO("call " << at << " of " << calls << ": " << what << "\n" << end.text());
        const Files left = files_in(folder / "out");
        std::vector<std::string> names;
        for (const auto& [name, content] : left)
            names.push_back(name);
        CAPTURE(names);
        CHECK((left == expected.before || left == expected.after));
        if (end.exit_code == 0) {  // a failed synchronisation does not discard the files
            CHECK(left == expected.after);
            continue;
        }
        ++failures;
        CHECK(lines_of(end.err).size() == 1);
        CHECK(end.err.rfind("tessera: ", 0) == 0);
        if (what == "SIGINT" || what == "SIGTERM") {
            CHECK(end.signal == (what == "SIGINT" ? SIGINT : SIGTERM));
            CHECK_THAT(end.err, Contains("interrupted (" + what + ")"));
        } else {
            CHECK((end.exit_code == 4 || end.exit_code == 2));
            CHECK_THAT(end.err, Contains(what == "full" ? "No space left on device" : "Input/output error"));
            CHECK_THAT(end.err, !Contains(".tessera-"));
        }
    }
    CHECK(failures >= calls / 2);  // of one file three: opened, written, renamed
}

Files files_after(const std::vector<std::string>& arguments, const fs::path& folder) {
    fs::remove_all(folder / "out");
    const ProgramEnd end = run_tessera(arguments, folder);
    INFO(end.text());
    REQUIRE(end.exit_code == 0);
    return files_in(folder / "out");
}

}  // namespace

TEST_CASE("a run whose disk is full or fails at any call, or that is interrupted, writes all files or none") {
    const TestFolder here;
    Expected expected{{}, files_after(run_arguments("1"), here.path())};
    REQUIRE(expected.after.size() >= 9);
    SECTION("no earlier run") {
        expected.before = {};
    }
    SECTION("an earlier run with another map") {
        expected.before = files_after(run_arguments("2"), here.path());
        REQUIRE(expected.before != expected.after);
    }
    for (const char* const what : {"full", "error", "SIGINT"})
        check_ends_well(run_arguments("1"), here.path(), expected, what);
}

TEST_CASE("a killed run leaves no partial file, and no job beside another run's mesh") {
    const TestFolder here;
    const Files old_run = files_after(run_arguments("2"), here.path());
    const Files new_run = files_after(run_arguments("1"), here.path());
    const long calls = disk_calls(run_arguments("1"), here.path());
    for (long at = 1; at <= calls; ++at) {
        files_after(run_arguments("2"), here.path());
        const ProgramEnd end = run_failing(run_arguments("1"), here.path(), at, "SIGKILL");
        INFO("call " << at << " of " << calls << "\n" << end.text());
        CHECK(end.signal == SIGKILL);
        bool all_old = true, all_new = true;
        for (const auto& [name, content] : files_in(here.path() / "out")) {
            if (is_unfinished(name) || content == "(folder)")
                continue;
            all_old = all_old && old_run.count(name) > 0 && old_run.at(name) == content;
            all_new = all_new && new_run.count(name) > 0 && new_run.at(name) == content;
        }
        CHECK((all_old || all_new));
        const ProgramEnd next = run_tessera(run_arguments("1"), here.path());
        INFO(next.text());
        CHECK(next.exit_code == 0);
        CHECK(files_in(here.path() / "out") == new_run);
    }
}

TEST_CASE("a folder that is not for a run is refused") {
    const TestFolder here;
    for (const char* const folder : {"mine", "runs"})
        fs::create_directories(here.path() / "work/deep" / folder);
    const auto folder_refused = [&](const std::string& folder, const Arguments& more = {}) {
        return refused(Arguments{"run"} + more + set({"output.folder=" + folder, "map.width=16"}),
                       here.path() / "work/deep", {"output.folder = \"" + folder + "\""});
    };
    for (const std::string& folder : {std::string("/"), std::string(".."), std::string("../.."), here.path().string()})
        CHECK_THAT(folder_refused(folder), Contains("contains the current directory"));

    write_all(here.path() / "work/deep/runs/mesh.ply", "mine");
    CHECK_THAT(folder_refused("runs"), Contains("runs/mesh.ply"));

    // The default job, with every key: the output of --dump-config does not belong to a run.
    const ProgramEnd dumped = run_tessera({"run", "--dump-config"}, here.path());
    write_all(here.path() / "work/deep/mine/job.toml", dumped.out);
    CHECK_THAT(folder_refused("mine", {"mine/job.toml"}), Contains("mine/job.toml"));
    CHECK(read_all(here.path() / "work/deep/mine/job.toml") == dumped.out);
    write_all(here.path() / "work/deep/mine/picture.png", "mine");
    for (const std::vector<std::string>& job : {std::vector<std::string>{}, {"mine/job.toml"}})
        CHECK_THAT(folder_refused("mine", job), Contains("mine/job.toml"));
    CHECK(read_all(here.path() / "work/deep/mine/job.toml") == dumped.out);
    CHECK(read_all(here.path() / "work/deep/mine/picture.png") == "mine");
}

TEST_CASE("an output that is a link is replaced, and its target stays") {
    const TestFolder here;
    files_after(run_arguments("1"), here.path());
    const fs::path run = here.path() / "out/run", input = here.path() / "input";
    const auto link_all = [&](const std::vector<fs::path>& names) {
        write_all(input, "mine");
        for (const fs::path& name : names) {
            fs::remove(name);
            fs::create_symlink(input, name);
        }
    };
    const auto check_replaced = [&](const std::vector<std::string>& arguments, const std::vector<fs::path>& names) {
        link_all(names);
        const ProgramEnd end = run_tessera(arguments, here.path());
        INFO(end.text());
        CHECK(end.exit_code == 0);
        CHECK(read_all(input) == "mine");
        for (const fs::path& name : names) {
            INFO(name);
            CHECK(fs::is_regular_file(fs::symlink_status(name)));
            CHECK(fs::file_size(name) > 4);
        }
    };
    check_replaced(run_arguments("1"), {run / "mesh.ply", run / "statistics.json", run / "trace.vcd"});
    check_replaced({"compare", "out/run"}, {run / "error.json"});
    check_replaced({"render", "out/run", "--size", "64x64", "--view", "shaded"}, {run / "shaded.png"});
    const fs::path out = here.path() / "out";
    check_replaced({"bake", (source_folder() / "testbench/examples/surfaces/dome.toml").string(), "--size", "16x16",
                    "--output", "out/baked.png"},
                   {out / "baked.png"});
    check_replaced(
        {"tune", "--triangles", "60", "--set", "map.width=16", "--set", "map.height=16", "--output", "out/tuned.toml"},
        {out / "tuned.toml", out / "tuned.json"});
}

TEST_CASE("concurrent runs into one folder, through a link, leave one run there") {
    const TestFolder here;
    const Files expected = files_after(run_arguments("1"), here.path());
    fs::remove_all(here.path() / "out/run");
    fs::create_directory(here.path() / "elsewhere");
    fs::create_symlink("../elsewhere", here.path() / "out/run");
    std::string line = tessera_program();
    for (const std::string& argument : run_arguments("1"))
        line += " " + argument;
    const std::string three_times = line + " & a=$!; " + line + " & b=$!; " + line + " && wait $a && wait $b";
    for (int again = 0; again < 3; ++again) {
        const ProgramEnd end = run_program({"sh", "-c", three_times}, here.path());
        INFO(end.text());
        CHECK(end.exit_code == 0);
        CHECK(end.err.empty());
        CHECK(fs::is_symlink(here.path() / "out/run"));
        Files left;
        for (const auto& [name, content] : files_in(here.path() / "elsewhere"))
            left["run/" + name] = content;
        left["run"] = "(folder)";
        CHECK(left == expected);
    }
}

TEST_CASE("an input in the output folder stays, even if it is a link") {
    const TestFolder here;
    files_after(run_arguments("1"), here.path());
    write_all(here.path() / "map.pgm", "P2 2 2 9\n0 9 5 1\n");
    fs::create_symlink(here.path() / "map.pgm", here.path() / "out/run/picture.png");
    refused(run_arguments("1") + set({"map.source=file", "map.file=out/run/picture.png"}), here.path(),
            {"would remove its own map"});
    CHECK(fs::is_symlink(here.path() / "out/run/picture.png"));
}

TEST_CASE("a built read-only checkout runs") {
    const TestFolder here;
    const Checkout checkout;
    // What ninja prints about an up-to-date build folder.
    write_all(checkout.root() / "tools/cmake",
              "#!/bin/sh\necho \"ninja: $(cat " + (here.path() / "state").string() + ")\"\n");
    write_all(checkout.root() / "build/release/build.ninja", "");
    write_all(checkout.root() / "build/release/CMakeCache.txt",
              "CMAKE_HOME_DIRECTORY:INTERNAL=" + checkout.root().string() + "\n");
    const auto run = [&](const std::string& state, const std::string& folder) {
        write_all(here.path() / "state", state);
        return checkout.run(
            "unshare --mount --map-root-user sh -c '"
            "mount --bind . . && mount -o remount,bind,ro . && cd \"$PWD\" && exec scripts/run"
            " --set map.width=16 --set map.height=16" +
            (folder.empty() ? "" : " --set output.folder=" + folder) + "'");
    };
    const fs::path elsewhere = here.path() / "run";
    const ProgramEnd good = run("no work to do.", elsewhere.string());
    if (good.err.find("unshare:") != std::string::npos || good.err.find("mount:") != std::string::npos) {
        WARN("this test is skipped: no folder can be made read-only here");
        return;
    }
    INFO(good.text());
    CHECK(good.exit_code == 0);
    CHECK(fs::exists(elsewhere / "mesh.ply"));
    const ProgramEnd own = run("no work to do.", "");
    CHECK(own.exit_code == 2);
    CHECK_THAT(own.err, Contains("output.folder = \"runs/half_donut\": cannot write there") &&
                            Contains("Read-only file system"));
    const ProgramEnd old = run("Entering directory", elsewhere.string());
    CHECK(old.exit_code == 2);
    CHECK_THAT(old.err, Contains("build/release is not up to date and cannot be written"));
}

TEST_CASE("a file that cannot be removed or replaced leaves the earlier run unchanged") {
    const TestFolder here;
    const fs::path run = here.path() / "out/run";
    Files old_run = files_after(run_arguments("2"), here.path());

    // A run does not touch files that no run writes.
    fs::create_directories(run / "wireframe.png/mine");
    write_all(run / "wireframe.png/mine/notes.txt", "mine");
    INFO(run_tessera(run_arguments("1"), here.path()).text());
    CHECK(read_all(run / "wireframe.png/mine/notes.txt") == "mine");
    CHECK(files_in(run).at("mesh.ply") != old_run.at("run/mesh.ply"));

    // In a folder that never held a run all files stay.
    fs::remove_all(here.path() / "out");
    for (const char* const name : {"error.json", "shaded.png", "mesh.ply", "job.toml"}) {
        fs::create_directories(run);
        write_all(run / name, "mine");
        const Files mine = files_in(run);
        const ProgramEnd refused = run_tessera(run_arguments("1"), here.path());
        INFO(refused.text());
        CHECK(refused.exit_code == 2);
        CHECK_THAT(refused.err, Contains("output.folder = \"out/run\"") && Contains(std::string("out/run/") + name) &&
                                    Contains("move the file, or choose another"));
        CHECK(files_in(run) == mine);
        fs::remove_all(run);
    }

    // A frame's folder without write permission: the last of all files cannot be replaced.
    if (::geteuid() == 0)
        return;  // permissions do not stop root
    old_run = files_after(run_arguments("2"), here.path());
    fs::create_directories(run / "frame_000");
    fs::copy_file(run / "job.toml", run / "frame_000/job.toml");
    fs::permissions(run / "frame_000", fs::perms::owner_read | fs::perms::owner_exec);
    const ProgramEnd refused = run_tessera(run_arguments("1"), here.path());
    fs::permissions(run / "frame_000", fs::perms::owner_all);
    INFO(refused.text());
    CHECK(refused.exit_code == 2);
    CHECK_THAT(refused.err, Contains("frame_000/job.toml") && Contains("all is as it was"));
    fs::remove_all(run / "frame_000");
    CHECK(files_in(here.path() / "out") == old_run);
}

TEST_CASE("an interrupted run reports its progress") {
    const TestFolder here;
    const Arguments arguments = Arguments{"run", "--vcd"} + set({"map.width=512", "map.height=512",
                                                                 "output.trace_to=10000000", "output.folder=out/run"});
    const ProgramEnd end = run_failing(arguments, here.path(), 12, "SIGINT");
    INFO(end.text());
    CHECK(end.signal == SIGINT);
    CHECK_THAT(end.err, Contains(" %, ") && Contains(" triangles; no unfinished file is left"));
    CHECK(here.names().empty());
}

TEST_CASE("compare, render, bake and tune write whole files or none if the disk is full or they are interrupted") {
    const TestFolder here;
    const std::vector<std::string> run = run_arguments("1");
    const Files before = files_after(run, here.path());
    for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
             {"compare", "out/run"},
             {"render", "out/run", "--size", "64x64", "--view", "shaded", "--view", "generation"},
             {"bake", (source_folder() / "testbench/examples/surfaces/dome.toml").string(), "--size", "16x16",
              "--output", "out/baked.png"},
             {"tune", "--triangles", "60", "--set", "map.width=16", "--set", "map.height=16", "--output",
              "out/tuned.toml"}}) {
        INFO(arguments[0]);
        files_after(run, here.path());
        succeed(arguments, here.path());
        const Files after = files_in(here.path() / "out");
        REQUIRE(after.size() > before.size());
        for (const char* const what : {"full", "SIGTERM"})
            check_ends_well(arguments, here.path(), {before, after}, what);
    }
}

TEST_CASE("a summary that cannot be printed is an error, and the results are complete") {
    const TestFolder here;
    const Files expected = files_after(run_arguments("1"), here.path());
    std::string line = tessera_program();
    for (const std::string& argument : run_arguments("1"))
        line += " " + argument;
    const ProgramEnd end = run_program({"sh", "-c", line + " > /dev/full"}, here.path());
    INFO(end.text());
    CHECK(end.exit_code == 4);
    CHECK_THAT(end.err, Contains("standard output: No space left on device"));
    CHECK(files_in(here.path() / "out") == expected);
}
