#include <unistd.h>

#include <catch2/catch.hpp>

#include "testbench/job/job_keys.h"
#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/run_folder.h"

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

TEST_CASE("wrong usage is refused in one line that names the help option") {
    const TestFolder here;
    for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{{},
                                                                                           {"rum"},
                                                                                           {"run", "--verbose"},
                                                                                           {"run", "--set"},
                                                                                           {"run", "--data"},
                                                                                           {"keys", "--all"},
                                                                                           {"run", "a", "b"}})
        refused(arguments, here, {"--help"});
    refused({"rum"}, here, {"rum"});
    refused({"run", "--verbose"}, here, {"--verbose"});
    refused({"run", ""}, here, {"JOB", "empty"});
    CHECK(here.names().empty());
}

// Which keys and values are refused: tests/job.
TEST_CASE("a job file, a setting and keys that contradict each other are refused with the reader's message") {
    const TestFolder here;
    write_all(here.path() / "job.toml", "[tests]\nnormal = true\nview_treshold = 2\n");
    refused({"run", "job.toml"}, here, {"job.toml:3:", "view_treshold", "view_threshold"});
    // also if the job would only be printed
    refused({"run", "job.toml", "--dump-config"}, here, {"job.toml:3:"});
    refused({"run", "--set", "tests.view_threshold=-1"}, here, {"tests.view_threshold", "-1"});
    refused({"run", "--set", "map.source=file"}, here, {"map.file"});
}

TEST_CASE("an invalid run folder is refused before the run") {
    const TestFolder here;
    write_all(here.path() / "file", "mine");
    refused({"run", "--set", "output.folder=file"}, here, {"output.folder", "file"});
    refused({"run", "--set", "output.folder=file/below"}, here, {"output.folder", "file"});
    CHECK(read_all(here.path() / "file") == "mine");
    refused({"run", "--set", "output.folder=/proc/tessera"}, here, {"output.folder", "/proc"});
    fs::create_symlink("nowhere", here.path() / "dangling");
    refused({"run", "--set", "output.folder=dangling"}, here, {"output.folder", "dangling"});
    if (::geteuid() != 0) {  // root may write anywhere
        fs::create_directory(here.path() / "locked");
        fs::permissions(here.path() / "locked", fs::perms::owner_read | fs::perms::owner_exec);
        refused({"run", "--set", "output.folder=locked"}, here, {"output.folder", "locked", "ermission"});
        refused({"run", "--set", "output.folder=locked/below"}, here, {"output.folder", "locked"});
    }
    fs::create_directories(here.path() / "taken/mesh.ply");
    const ProgramEnd end =
        run_tessera({"run", "--set", "output.folder=taken", "--set", "tests.generation_limit=1"}, here.path());
    INFO(end.text());
    CHECK(end.exit_code == 2);
    CHECK_THAT(end.err, Contains("taken/mesh.ply"));
}

TEST_CASE("a stated limit ends a run with exit code 4, one message and no trace") {
    const TestFolder here;
    const std::string folder = "output.folder=out";
    SECTION("too many triangles") {
        const ProgramEnd end = run_tessera({"run", "--set", "limits.triangles=1000", "--set", folder}, here.path());
        INFO(end.text());
        CHECK(end.exit_code == 4);
        CHECK(end.out.empty());
        CHECK(lines_of(end.err).size() == 1);
        CHECK_THAT(end.err, Contains("limits.triangles = 1000"));
        CHECK(here.names().empty());
    }
    SECTION("exactly the allowed number of triangles") {
        const ProgramEnd whole = run_tessera({"run", "--set", folder}, here.path());
        REQUIRE(whole.exit_code == 0);
        const std::uint64_t triangles = RunFolder(here.path() / "out").count("run", "triangles_finished");
        const auto limited = [&](std::uint64_t limit) {
            return run_tessera({"run", "--set", "limits.triangles=" + std::to_string(limit), "--set", folder},
                               here.path())
                .exit_code;
        };
        CHECK(limited(triangles) == 0);
        CHECK(limited(triangles - 1) == 4);
    }
    SECTION("a file larger than allowed") {
        ProgramLimits limits;
        limits.file_bytes = 100'000;
        const ProgramEnd end = run_tessera({"run", "--set", folder}, here.path(), limits);
        INFO(end.text());
        CHECK(end.signal == 0);
        CHECK(end.exit_code == 4);
        CHECK(lines_of(end.err).size() == 1);
        CHECK_THAT(end.err, Contains("out/mesh.ply"));
        CHECK_FALSE(fs::exists(here.path() / "out"));
    }
    SECTION("standard output on a full disk") {
        for (const std::string words : {"keys", "run --dump-config", "run --set output.folder=out"}) {
            const ProgramEnd end =
                run_program({"bash", "-c", "\"$0\" " + words + " > /dev/full", tessera_program()}, here.path());
            INFO(words);
            INFO(end.text());
            CHECK(end.exit_code == 4);
            CHECK(lines_of(end.err).size() == 1);
            CHECK_THAT(end.err, Contains("No space left"));
        }
    }
}

TEST_CASE("the largest map runs") {
    const TestFolder here;
    succeed(Arguments{"run"} + set({"map.source=noise", "map.width=4096", "map.height=4096", "tests.normal_threshold=1",
                                    "tests.generation_limit=6", "output.folder=out"}),
            here.path());
    const RunFolder run(here.path() / "out");
    require_consistent(run);
    CHECK(run.count("displacement_map", "size") == std::uint64_t{4096} * 4096 * 2);
}

TEST_CASE("help and version are printed on request") {
    const TestFolder here;
    for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
             {"--help"}, {"-h"}, {"run", "--help"}, {"keys", "--help"}, {"--version"}}) {
        const ProgramEnd end = run_tessera(arguments, here.path());
        INFO(end.text());
        CHECK(end.exit_code == 0);
        CHECK(end.err.empty());
        CHECK_FALSE(end.out.empty());
    }
    const std::string help = run_tessera({"--help"}, here.path()).out;
    for (const char* const word : {"run", "keys", "exit codes", "--version"})
        CHECK_THAT(help, Contains(word));
    const std::string run_help = run_tessera({"run", "--help"}, here.path()).out;
    for (const char* const word : {"JOB", "--set", "--data", "--dump-config"})
        CHECK_THAT(run_help, Contains(word));
    CHECK_THAT(run_tessera({"--version"}, here.path()).out, Catch::Matches("tessera [0-9]+\\.[0-9]+\\.[0-9]+\n"));
    CHECK(here.names().empty());
}

TEST_CASE("help has every exit code that testbench/run_folder/README.md has") {
    const TestFolder here;
    const std::string readme = read_all(source_folder() / "testbench/run_folder/README.md");
    std::string codes = readme.substr(readme.find("Exit codes: ") + std::string("Exit codes: ").size());
    codes = codes.substr(0, codes.find('.'));
    std::vector<std::string> parts;
    for (std::size_t at = 0, comma = 0; comma != std::string::npos; at = comma + 1) {
        comma = codes.find(',', at);
        std::string part = codes.substr(at, comma - at);
        for (char& c : part)
            c = c == '\n' ? ' ' : c;
        parts.push_back(part.substr(part.find_first_not_of(' ')));
    }
    REQUIRE(parts.size() == 5);
    for (const std::vector<std::string>& verb :
         std::vector<std::vector<std::string>>{{}, {"run"}, {"compare"}, {"render"}, {"bake"}, {"tune"}, {"keys"}}) {
        std::vector<std::string> arguments = verb;
        arguments.emplace_back("--help");
        const std::string help = run_tessera(arguments, here.path()).out;
        for (const std::string& part : parts)
            CHECK_THAT(help, Contains(part));
    }
}

TEST_CASE("keys lists every key of a dumped job") {
    const TestFolder here;
    const ProgramEnd end = run_tessera({"keys"}, here.path());
    CHECK(end.exit_code == 0);
    CHECK(end.err.empty());
    const std::string dump = run_tessera({"run", "--dump-config"}, here.path()).out;
    std::string table;
    std::size_t keys = 0;
    for (const std::string& line : lines_of(dump)) {
        if (line.rfind('[', 0) == 0)
            table = line.substr(1, line.find(']') - 1) + ".";
        const std::size_t equals = line.find(" = ");
        if (line.rfind('#', 0) == 0 || equals == std::string::npos)
            continue;
        ++keys;
        INFO(table + line.substr(0, equals));
        CHECK_THAT(end.out, Contains(table + line.substr(0, equals)));
    }
    std::size_t declared = 0;
    for (const KeyTable& each : job_tables())
        declared += each.keys.size();
    CHECK(keys == declared);
}

TEST_CASE("a reader that closes the pipe early ends the program quietly") {
    const TestFolder here;
    const ProgramEnd end =
        run_program({"bash", "-c", "\"$0\" keys | head -n 1 > /dev/null", tessera_program()}, here.path());
    CHECK(end.exit_code == 0);
    CHECK(end.err.empty());
}

TEST_CASE("map.no_data holds for built-in maps, too") {
    const TestFolder here;
    const auto run_with = [&](const std::string& source, const std::string& no_data) {
        return run_tessera(
            Arguments{"run"} + set({"mode=functional", "output.picture=false", "map.source=" + source, "map.value=0.5",
                                    "map.no_data=" + no_data, "map.width=32", "map.height=32", "output.folder=out"}),
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

TEST_CASE("tune and rank print the notes on their inputs") {
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
