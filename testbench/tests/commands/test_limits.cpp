// Requests and files that ask for far more than is available: each ends quickly and in little memory, with one clear
// message and the documented exit code.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/tests/support/program_runner.h"

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

constexpr double most_mebibytes = 256;
constexpr unsigned soon = sanitized ? 100 : 10;  // seconds of processor time

ProgramEnd run_with(const std::vector<std::string>& settings, const fs::path& folder, unsigned cpu_seconds = soon) {
    return run_tessera(
        Arguments{"run"} +
            set({"mode=functional", "output.folder=out", "output.picture=false", "tests.generation_limit=1"}) +
            set(settings),
        folder, {cpu_seconds, 500});
}

void check_ended(const ProgramEnd& end, ExitCode code) {
    INFO(end.text());
    CHECK(end.exit_code == static_cast<int>(code));
    CHECK(end.signal == 0);
    CHECK_FALSE(end.timed_out);
    if (!sanitized)
        CHECK(end.peak_mib < most_mebibytes);
}

/// One line that contains all these words.
void check_refused(const ProgramEnd& end, ExitCode code, const std::vector<std::string>& words) {
    check_ended(end, code);
    INFO(end.text());
    CHECK(end.out.empty());
    CHECK(lines_of(end.err).size() == 1);
    CHECK(end.err.rfind("tessera: ", 0) == 0);
    CHECK(end.err.size() < 600);
    for (const std::string& word : words)
        CHECK_THAT(end.err, Contains(word));
}

void refused(const std::vector<std::string>& settings, ExitCode code, const std::vector<std::string>& words) {
    const TestFolder here;
    check_refused(run_with(settings, here.path()), code, words);
    CHECK(here.names().empty());
}

/// An OBJ file of one face with the corners corner(0), corner(1), ...
void write_polygon(const fs::path& file, std::size_t corners,
                   const std::function<std::pair<double, double>(std::size_t)>& corner) {
    std::string text, face = "f";
    for (std::size_t i = 0; i < corners; ++i) {
        const auto [x, y] = corner(i);
        text += "v " + std::to_string(x) + " " + std::to_string(y) + " 0\n";
        face += " " + std::to_string(i + 1);
    }
    write_all(file, text + face + "\n");
}

std::string big_endian(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8)
        bytes += static_cast<char>(value >> shift & 255);
    return bytes;
}

const std::vector<std::string> polygon_of_file{"mesh.source=file", "mesh.file=a.obj", "map.width=16", "map.height=16"};

}  // namespace

TEST_CASE("limits: a polygon of a million corners is refused at once") {
    const TestFolder here;
    write_polygon(here.path() / "a.obj", 1'000'000, [](std::size_t i) {
        const double angle = static_cast<double>(i) * 6.283e-6;
        return std::pair(1000 * std::cos(angle), 1000 * std::sin(angle));
    });
    check_refused(run_with(polygon_of_file, here.path()), ExitCode::resource_limit,
                  {"a.obj:1000001", "65536 corners", "simplify the mesh"});
}

TEST_CASE("limits: the largest convex polygon runs") {
    const TestFolder here;
    write_polygon(here.path() / "a.obj", 65536, [](std::size_t i) {
        const double angle = static_cast<double>(i) * 2 * 3.14159265358979323846 / 65536;
        return std::pair(10000 * std::cos(angle), 10000 * std::sin(angle));
    });
    std::vector<std::string> settings = polygon_of_file;
    settings.insert(settings.end(), {"displacement.scale=1", "camera.eye=[0,-30000,20000]"});
    const ProgramEnd end = run_with(settings, here.path(), sanitized ? 300 : 30);
    check_ended(end, ExitCode::fine);
    CHECK_THAT(end.out, Contains("65,534 base"));
}

TEST_CASE("limits: a polygon too expensive to cut is refused") {
    const TestFolder here;
    constexpr std::size_t corners = 65536, half = corners / 2;
    write_polygon(here.path() / "a.obj", corners, [](std::size_t i) {
        const std::size_t k = corners - 1 - i;  // counter-clockwise
        return k < half ? std::pair(static_cast<double>(k), k % 2 == 1 ? 1.0 : 10.0)
                        : std::pair(static_cast<double>(corners - 1 - k), 0.0);
    });
    check_refused(run_with(polygon_of_file, here.path(), sanitized ? 300 : 60), ExitCode::resource_limit,
                  {"a.obj:65537", "65536 corners", "1000000000 steps"});
}

TEST_CASE("limits: too many triangles and too long a text are refused before any is made") {
    for (const char* const source : {"plane", "cylinder", "sphere"})
        refused({std::string("mesh.source=") + source, "mesh.columns=2048", "mesh.rows=2048"}, ExitCode::resource_limit,
                {"mesh.columns = 2048", "mesh.rows", "the limit is 4000000"});
    refused({"map.source=text", "map.width=4096", "map.text=" + std::string(4000, 'a')}, ExitCode::bad_input,
            {"map.text", "4096 x 264", "Shorten the text"});
}

TEST_CASE("limits: running out of memory is reported as such at any point") {
    if (sanitized)
        return;  // AddressSanitizer reserves address space by the terabyte
    const TestFolder here;
    const auto within = [&](unsigned kibibytes, const std::string& command) {
        return run_program(
            {"sh", "-c", "ulimit -v " + std::to_string(kibibytes) + "; exec \"$0\" " + command, tessera_program()},
            here.path());
    };
    unsigned floor = 40000;  // what the program needs to start depends on the machine's libraries
    while (within(floor, "--version").exit_code != 0)
        REQUIRE((floor += 1000) < 1'000'000);
    unsigned short_of_memory = 0;
    for (unsigned more = 2000; more <= 42000; more += 4000) {
        const ProgramEnd end = within(floor + more, "run");
        INFO(floor << " + " << more << " KiB of address space\n" << end.text());
        CHECK((end.exit_code == 0 || end.exit_code == 4));
        if (end.exit_code == 4) {
            CHECK(lines_of(end.err).size() == 1);
            CHECK_THAT(end.err, Contains("out of memory"));
            CHECK_FALSE(fs::exists(here.path() / "runs/half_donut"));
            ++short_of_memory;
        }
    }
    CHECK(short_of_memory > 2);
}

TEST_CASE("limits: short headers that claim gigabytes are refused") {
    const TestFolder here;
    const auto check_map = [&](const std::string& bytes, const std::vector<std::string>& words) {
        write_all(here.path() / "map", bytes);
        std::vector<std::string> all{"map: "};
        all.insert(all.end(), words.begin(), words.end());
        check_refused(run_with({"map.source=file", "map.file=map"}, here.path()), ExitCode::bad_input, all);
    };
    const std::string filling(380, '\0');
    check_map("P5 4096 4096 65535\n" + filling, {"33554432"});
    check_map("P5 65536 65536 255\n" + filling, {"the width", "65536", "4096"});
    check_map("P5 99999999999999999999 1 255\n" + filling, {"the width", "99999999999999999999", "4096"});
    for (const std::uint32_t side : {4096u, 0x7fffffffu, 0xffffffffu}) {
        const std::string png = std::string("\x89PNG\r\n\x1a\n") + big_endian(13) + "IHDR" + big_endian(side) +
                                big_endian(side) + std::string("\x10\x06\0\0\1", 5) + big_endian(0);
        const std::string sides = std::to_string(side) + " x " + std::to_string(side);
        check_map(png + filling, {side == 4096 ? "libpng cannot read" : sides});
    }
}

TEST_CASE("limits: TOML that is too deep or endless is refused") {
    const TestFolder here;
    const auto check_job = [&](const std::string& text, const std::string& words) {
        write_all(here.path() / "job.toml", text);
        check_refused(run_tessera({"run", "job.toml"}, here.path(), {soon, 300}), ExitCode::bad_input,
                      {"job.toml:", words});
    };
    check_job("a = " + std::string(500'000, '['), "nested");
    check_job(std::string(2'000'000, '#'), "over 1048576 bytes");
}

TEST_CASE("limits: a path that is not a regular file is refused by every command") {
    const TestFolder here;
    fs::create_directory(here.path() / "folder");
    REQUIRE(::mkfifo((here.path() / "pipe").c_str(), 0600) == 0);
    const std::vector<std::vector<std::string>> commands{
        {"run", "FILE"},
        {"run", "--set", "mesh.source=file", "--set", "mesh.file=FILE"},
        {"run", "--set", "mesh.source=run", "--set", "mesh.file=FILE"},
        {"run", "--set", "map.source=file", "--set", "map.file=FILE"},
        {"bake", "FILE", "--output", "a.pgm"},
        {"compare", "FILE"},
        {"render", "FILE"},
        {"tune", "FILE", "--triangles", "100", "--output", "tuned.toml"},
    };
    const std::vector<std::string> before = here.names();
    for (const std::string file : {"folder", "pipe", "/dev/zero", "/dev/full", "absent"}) {
        for (std::vector<std::string> command : commands) {
            for (std::string& word : command)
                if (const std::size_t at = word.find("FILE"); at != std::string::npos)
                    word.replace(at, 4, file);
            INFO(command[0] << " " << command[1] << " ... " << command.back());
            check_refused(run_tessera(command, here.path(), {soon, 60}), ExitCode::bad_input, {file});
        }
    }
    CHECK(here.names() == before);
}
