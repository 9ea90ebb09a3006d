#include <algorithm>
#include <catch2/catch.hpp>
#include <iostream>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>

#include "modules/version.h"
#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/text.h"

// The libraries in other projects: installed, and as a subfolder.

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const fs::path example = source_folder() / "testbench/examples/first_machine";
const fs::path platform = source_folder() / "testbench/examples/platform";
// ccache finds objects again only if they are compiled below the project.
const fs::path scratch = TESSERA_BUILD_FOLDER;
const fs::path careful_client = source_folder() / "testbench/tests/packaging/careful_client";
const Arguments from_sources{"-DTESSERA_SOURCE=" + source_folder().string()};
const Arguments with_glm_and_fmt{"-DCMAKE_DISABLE_FIND_PACKAGE_glm=OFF", "-DCMAKE_DISABLE_FIND_PACKAGE_fmt=OFF"};
const std::string strict = "-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Werror";

ProgramEnd run(const std::vector<std::string>& command, const fs::path& folder, const Environment& environment = {}) {
    return run_program(command, folder, {}, environment);
}

std::string require_success(const std::vector<std::string>& command, const fs::path& folder,
                            const Environment& environment = {}) {
    const ProgramEnd end = run(command, folder, environment);
    INFO(command.front() << ": " << end.text());
    REQUIRE(end.exit_code == 0);
    return end.out;
}

/// Configures `source` in folder/build like this build, but without the packages of the testbench.
Arguments configuring(const fs::path& source, const Arguments& settings, const fs::path& prefix = {},
                      const std::string& compiler = TESSERA_COMPILER) {
    Arguments command{"cmake",
                      "-S",
                      source.string(),
                      "-B",
                      "build",
                      "-G",
                      "Ninja",
                      "-DCMAKE_CXX_COMPILER=" + compiler,
                      "-DCMAKE_PREFIX_PATH=" + prefix.string() + ";" TESSERA_PREFIX_PATH,
                      "-DFETCHCONTENT_FULLY_DISCONNECTED=ON"};
    for (const char* const package : {"glm", "fmt", "Catch2", "CLI11", "OpenEXR", "nlohmann_json"})
        command.push_back("-DCMAKE_DISABLE_FIND_PACKAGE_" + std::string(package) + "=ON");
    return command + settings;
}

/// This build's installation, moved to another folder.
fs::path install_in(const fs::path& folder) {
    const fs::path first = folder / "installed", moved = folder / "moved/elsewhere";
    require_success({"cmake", "--install", TESSERA_BUILD_FOLDER, "--prefix", first.string()}, folder);
    fs::create_directories(moved.parent_path());
    fs::rename(first, moved);
    return moved;
}

/// Builds and runs the programs in folder/build; returns their output.
std::string build_and_run(const fs::path& folder) {
    require_success({"cmake", "--build", "build", "-j2"}, folder);
    CHECK_THAT(require_success({"build/arithmetic"}, folder), Contains(version));
    const std::string printed = require_success({"build/first_machine"}, folder);
    CHECK_THAT(printed, Contains(" triangles in ") && Contains(" cycles\n"));
    return printed;
}

/// An environment and settings in which SystemC is not found.
const Environment no_systemc{{"PKG_CONFIG_LIBDIR", "nowhere"}, {"PKG_CONFIG_PATH", "nowhere"}};
const Arguments no_systemc_package{"-DCMAKE_DISABLE_FIND_PACKAGE_SystemCLanguage=ON"};

std::string without_line_breaks(const std::string& text) {
    return std::regex_replace(text, std::regex("\\s+"), " ");
}

/// Requires that configuring fails with these words.
void expect_refusal(const fs::path& folder, const Arguments& command, const std::string& words,
                    const Environment& environment = {}) {
    fs::remove_all(folder / "build");
    const ProgramEnd end = run(command, folder, environment);
    INFO(end.text());
    CHECK(end.exit_code != 0);
    CHECK_THAT(without_line_breaks(end.err), Contains(words));
}

/// The names of the installed headers.
std::vector<std::string> names_of(const fs::path& headers) {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(headers))
        if (entry.is_regular_file())
            names.push_back(entry.path().lexically_relative(headers).string());
    return names;
}

/// The lines of the headers in a preprocessor's output, without white space: gcc and clang break macros differently.
std::string lines_from(const fs::path& headers, const std::string& preprocessed) {
    std::string kept;
    bool within = false;
    for (const std::string& line : lines_of(preprocessed)) {
        if (line.rfind("# ", 0) == 0)
            within = line.find('"' + headers.string()) != std::string::npos;
        else if (within)
            std::copy_if(line.begin(), line.end(), std::back_inserter(kept), [](char c) { return c != ' '; });
    }
    return kept;
}

/// The compiler of the other family, gcc or clang; none if it is not installed.
std::string other_compiler() {
    const std::string other = std::string(TESSERA_COMPILER).find("clang") == std::string::npos ? "clang++" : "g++";
    const ProgramEnd end = run({"sh", "-c", "command -v " + other}, scratch);
    return end.exit_code == 0 ? lines_of(end.out).front() : "";
}

/// Whether a header includes SystemC, directly or indirectly.
bool includes_systemc(const fs::path& headers, const std::string& name) {
    const std::regex include("#include ([<\"])(.*)[>\"]");
    std::smatch match;
    for (const std::string& line : lines_of(read_all(headers / name)))
        if (std::regex_match(line, match, include) &&
            (match[2] == "systemc" || (match[1] == "\"" && includes_systemc(headers, match[2]))))
            return true;
    return false;
}

/// Lines of the text's code blocks in this language.
std::vector<std::string> code_in(const fs::path& markdown, const std::string& language) {
    std::vector<std::string> code;
    bool within = false;
    for (const std::string& line : lines_of(read_all(markdown)))
        if (line.rfind("```", 0) == 0)
            within = line == "```" + language;
        else if (within)
            code.push_back(line);
    return code;
}

}  // namespace

TEST_CASE("the example finds a moved installation, by CMake and by pkg-config") {
    const TestFolder folder(scratch);
    const fs::path moved = install_in(folder.path());
    fs::copy(example, folder.path() / "example");
    require_success(configuring("example", {"-DCMAKE_CXX_FLAGS=" + strict}, moved), folder.path());
    const std::string printed = build_and_run(folder.path());

    std::string command;
    for (const std::string& line : code_in(source_folder() / "modules/README.md", "sh"))
        if (line.rfind("g++ ", 0) == 0)
            command = TESSERA_COMPILER + line.substr(3);
    REQUIRE_THAT(command, Contains("pkg-config"));
#ifdef TESSERA_SYSTEMC_BY_PKG_CONFIG
    require_success({"bash", "-euc", command}, folder.path() / "example",
                    {{"PKG_CONFIG_PATH", (moved / "lib/pkgconfig").string()}});
    CHECK(require_success({"example/first_machine"}, folder.path()) == printed);
#endif
    for (const auto& entry : fs::recursive_directory_iterator(moved)) {
        INFO(entry.path());
        CHECK((!entry.is_regular_file() || entry.path().extension() == ".a" ||
               read_all(entry.path()).find(folder.path().string()) == std::string::npos));
    }
}

TEST_CASE("the example builds with the sources as a folder, and by FetchContent") {
    const TestFolder folder(scratch);
    const Arguments settings =
        with_glm_and_fmt + Arguments{"-DCMAKE_CXX_FLAGS=" + strict, "-DTESSERA_SOURCE=" + source_folder().string(),
                                     "-DFETCHCONTENT_SOURCE_DIR_TESSERA=" + source_folder().string(),
                                     // both build tessera in the same folder: the second finds it built
                                     "-DFETCHCONTENT_BASE_DIR=build", "-DCMAKE_UNITY_BUILD=ON",
                                     "-DCMAKE_BUILD_TYPE=Debug"};
    require_success(configuring(example, settings + Arguments{"-DTESSERA_BY=add_subdirectory"}), folder.path());
    const std::string printed = build_and_run(folder.path());
    require_success(configuring(example, settings + Arguments{"-DTESSERA_BY=FetchContent"}), folder.path());
    CHECK(build_and_run(folder.path()) == printed);
    CHECK_FALSE(fs::exists(folder.path() / "build/install_manifest.txt"));
    require_success({"cmake", "--install", "build", "--prefix", "installed"}, folder.path());
    CHECK_FALSE(fs::exists(folder.path() / "installed"));
}

// Runs every command of the page in order; in both modes the processor's program receives the same pictures.
TEST_CASE("the first platform builds and runs as in its README") {
    const TestFolder home(scratch);
    const std::vector<std::string> commands = code_in(platform / "README.md", "sh");
    CHECK(commands.size() == 7);
    std::string printed;
    for (const std::string& command : commands)
        printed += require_success({"bash", "-euc", command + " 2>&1"}, source_folder(),
                                   {{"HOME", home.path().string()}, {"CXXFLAGS", strict}});
    CHECK_THAT(printed, !Contains("Warning: (W"));  // of SystemC's kernel
    CHECK_THAT(printed, Contains("functional_2.pgm: ") && Contains("timed_2.pgm: "));
    const fs::path pictures = home.path() / "platform";
    std::string last;
    for (const char* const frame : {"0", "1", "2"}) {
        const std::string picture = read_all(pictures / ("timed_" + std::string(frame) + ".pgm"));
        CHECK_THAT(picture, Catch::StartsWith("P5 320 240 255\n"));
        CHECK((picture == read_all(pictures / ("functional_" + std::string(frame) + ".pgm"))));
        CHECK((picture != last));
        last = picture;
    }
    CHECK(run({(pictures / "platform").string(), "fast"}, home.path()).exit_code == 2);
}

namespace {

const fs::path height_test = source_folder() / "testbench/examples/height_test";

/// The commands of the page, of this build.
std::vector<std::string> height_test_commands() {
    std::vector<std::string> commands = code_in(height_test / "README.md", "sh");
    for (std::string& command : commands)
        command = std::regex_replace(command, std::regex("build/release"), TESSERA_BUILD_FOLDER);
    return commands;
}

Environment at_home(const fs::path& home) {
    return {{"HOME", home.string()}, {"CXX", TESSERA_COMPILER}, {"CXXFLAGS", strict}};
}

ProgramEnd run_with_library(const fs::path& library, const Arguments& settings, const fs::path& folder,
                            Environment environment = {}) {
    Arguments command{"run", "--set", "output.folder=out"};
    for (const std::string& setting : settings)
        command = command + Arguments{"--set", setting};
    environment.emplace_back("TESSERA_HEIGHT_TESTS", library.string());
    return run_tessera(command, folder, {}, environment);
}

}  // namespace

TEST_CASE("a height test of one's own builds and runs as in its README") {
    const TestFolder home(scratch);
    const std::vector<std::string> commands = height_test_commands();
    CHECK(commands.size() == 6);
    for (const std::string& command : commands)
        require_success({"bash", "-euc", command + " 2>&1"}, source_folder(), at_home(home.path()));
    const fs::path range = home.path() / "range";
    for (const char* const design : {"paper", "modern"}) {
        INFO(design);
        CHECK((read_all(range / design / "mesh.ply") == read_all(range / "paper/mesh.ply")));
        CHECK_THAT(read_all(range / design / "report.txt"), Contains("range table") &&
                                                                Contains("every block's lowest and highest code") &&
                                                                Contains("range_test") && Contains("range_table"));
        CHECK_THAT(read_all(range / design / "job.toml"), Contains("\nrange_threshold = 0.05"));
    }
    CHECK_THAT(read_all(range / "tuned.toml"), Contains("height_test = \"range\"") && Contains("range_threshold = "));

    const fs::path library = range / "librange_test.so";
    const Arguments ranges{"hardware.height_test=range", "mesh.columns=2", "mesh.rows=2"};
    for (const Arguments& further : {Arguments{"tests.range_threshold=0"},
                                     {"tests.range_threshold=1"},
                                     {"formats.displacement_bits=5", "map.source=noise", "map.address_u=repeat"},
                                     {"mode=timed", "timing.height_table_cache_bytes=512", "hardware.tests_units=3"},
                                     {"mode=timed", "check.reads=true", "hardware.machines=2", "map.width=37"}}) {
        const ProgramEnd end = run_with_library(library, ranges + further, home.path());
        INFO(end.text());
        CHECK(end.exit_code == 0);
    }
    CHECK_THAT(run_with_library(library, ranges + Arguments{"tests.range_threshold=1e-9"}, home.path()).err,
               Contains("tests.range_threshold = 1e-09 is less than one step of its register"));
}

TEST_CASE("a height test of one's own that is wrong fails its run, and names the first wrong value") {
    const TestFolder home(scratch);
    const std::vector<std::string> commands = height_test_commands();
    REQUIRE(commands.size() == 6);
    fs::copy(height_test, home.path() / "edited");
    const std::vector<std::string> build{
        commands[0], std::regex_replace(commands[1], std::regex("-S \\S+"), "-S ~/edited"), commands[2]};
    struct Fault {
        const char *file, *right, *wrong, *threshold, *says;
        int exit_code = 1;
    };
    const std::vector<Fault> faults{
        {"host.h", "std::max(high[to], highest[from])", "std::min(high[to], highest[from])", "0.05", "range table: "},
        {"host.h", "static_cast<double>(formats.displacement.highest)",
         "static_cast<double>(formats.displacement.highest) / 2", "0.05", "tests.range_threshold = "},
        {"range_test.h", "highest - lowest > limit(1, r.tests)", "highest - lowest >= limit(1, r.tests)", "0",
         "FAILED: conformance"},
        {"range_test.h", "table.rows = 1", "table.rows = 2", "0.05", "range_table.rows = 2"}};
    // One library has all faults; FAULT chooses one by its number.
    const auto edit = [&](const char* file, const std::string& before, const std::string& after) {
        const fs::path path = home.path() / "edited" / file;
        write_all(path, testing::replaced(read_all(path), before, after));
    };
    for (std::size_t k = 0; k < faults.size(); ++k)
        edit(faults[k].file, faults[k].right,
             "(fault(" + std::to_string(k) + ") ? (" + faults[k].wrong + ") : (" + faults[k].right + "))");
    edit("blocks.h", "#pragma once\n",
         "#pragma once\n#include <cstdlib>\n"
         "inline bool fault(int number) {\n"
         "    const char* const chosen = std::getenv(\"FAULT\");\n"
         "    return chosen != nullptr && std::atoi(chosen) == number;\n"
         "}\n");
    for (const std::string& command : build)
        require_success({"bash", "-euc", command + " 2>&1"}, source_folder(), at_home(home.path()));
    for (std::size_t k = 0; k <= faults.size(); ++k) {
        const Fault& fault = k < faults.size() ? faults[k] : Fault{"", "", "", "0.05", "range", 0};
        INFO(k << ' ' << fault.wrong);
        const ProgramEnd end =
            run_with_library(home.path() / "range/librange_test.so",
                             {"hardware.height_test=range", std::string("tests.range_threshold=") + fault.threshold},
                             home.path(), {{"FAULT", std::to_string(k)}});
        INFO(end.text());
        CHECK(end.exit_code == fault.exit_code);
        CHECK_THAT(read_all(home.path() / "out/report.txt"), Contains(fault.says));
    }
}

TEST_CASE("a library that is no height test is refused with the reason") {
    const TestFolder here;
    const auto refused = [&](const std::string& file, const std::string& words) {
        const ProgramEnd end = run_with_library(file, {}, here.path());
        INFO(end.text());
        CHECK(end.exit_code == 2);
        CHECK_THAT(end.err, Contains("TESSERA_HEIGHT_TESTS: " + file) && Contains(words));
        CHECK_FALSE(fs::exists(here.path() / "out"));
    };
    refused("nowhere.so", "cannot open shared object file");
    write_all(here.path() / "text.so", "no library");
    refused("text.so", "set it to a library built as in testbench/examples/height_test/README.md");
    const auto compile = [&](const std::string& source) {
        write_all(here.path() / "test.cpp", source);
        require_success({TESSERA_COMPILER, "-std=c++17", "-shared", "-fPIC", "-I", source_folder().string(), "test.cpp",
                         "-o", "test.so"},
                        here.path());
    };
    compile("int other;\n");
    refused("test.so", "it has no tessera_height_test(): define it by the macro TESSERA_HEIGHT_TEST");
    const std::string older =
        "struct Test { const char* version; const void *a, *b, *c; } test{\"0.0.1\"};\n"
        "extern \"C\" const Test* tessera_height_test() { return &test; }\n";
    compile(older);
    refused("test.so", "it was built with tessera 0.0.1, this is ");
    const auto named = [&](const std::string& name) {
        compile("struct Functions { const void* table; const char* name; } functions{nullptr, \"" + name + "\"};\n" +
                "struct Test { const char* version; const void *a, *b, *c; } test{\"" + version +
                "\", &functions, &functions, &functions};\n" +
                "extern \"C\" const Test* tessera_height_test() { return &test; }\n");
    };
    named("rank");
    refused("test.so", "there is another height test rank: choose another name");
    named("view");
    refused("test.so", "is called \"view\": choose a name of lower-case letters, digits and _, other than base");
}

TEST_CASE("a client keeps its variables and its warnings") {
    const TestFolder folder(scratch);
    const fs::path moved = install_in(folder.path());
    const Arguments client = configuring(careful_client, {"-DCOMPONENTS=datapath;modules;setup;device"}, moved);
    for (const bool as_folder : {false, true}) {
        INFO("as a folder: " << as_folder);
        fs::remove_all(folder.path() / "build");
        require_success(client + (as_folder ? from_sources + with_glm_and_fmt : Arguments{}), folder.path());
        unsigned commands = 0;
        for (const std::string& line : lines_of(read_all(folder.path() / "build/compile_commands.json"))) {
            if (line.find("\"command\"") == std::string::npos || line.find("warned_of.cpp") == std::string::npos)
                continue;
            ++commands;
            CHECK_THAT(line, Contains("-DFLAG_OF_ITS_OWN") && !Contains(" -W") && !Contains(" -f") && !Contains(" -m"));
        }
        CHECK(commands == 4);
        if (!as_folder)
            require_success({"cmake", "--build", "build"}, folder.path());
    }
}

TEST_CASE("each installed header compiles alone") {
    const TestFolder folder(scratch);
    const fs::path headers = install_in(folder.path()) / "include/tessera";
    const std::string compile = TESSERA_COMPILER " -std=c++" TESSERA_STANDARD " " + strict + " ";
    // SystemC takes most of the compile time: include it once for all headers.
    write_all(folder.path() / "first.h", "#include <systemc>\n");
    std::string alone, after_systemc;
    unsigned count = 0;
    for (const std::string& name : names_of(headers)) {
        CHECK_THAT(name, (Catch::StartsWith("modules/") || Catch::StartsWith("testbench/setup/") ||
                          Catch::Equals("testbench/common/error.h")) &&
                             Catch::EndsWith(".h"));
        (includes_systemc(headers, name) ? after_systemc : alone) += name + "\n";
        ++count;
    }
    CHECK(count > 80);
    write_all(folder.path() / "alone", alone);
    write_all(folder.path() / "after_systemc", after_systemc);
    const std::string each = "xargs -P2 -I@ sh -c 'echo \"#include \\\"@\\\"\" | " + compile +
                             "-fsyntax-only -I moved/elsewhere/include/tessera -x c++ ";
    require_success({"bash", "-euo", "pipefail", "-c",
                     compile + "-x c++-header first.h -o first.h.gch && " + each +
                         "-include first.h -' <after_systemc && " + each + "-' <alone"},
                    folder.path());
}

// A struct of theirs would otherwise have two definitions in one program, and the library's speed depend on its client.
TEST_CASE("the installed headers are the same for every client's macros and optimisation") {
    const TestFolder folder(scratch);
    const fs::path headers = install_in(folder.path()) / "include/tessera";
    std::string all;
    for (const std::string& name : names_of(headers))
        all += "#include \"" + name + "\"\n";
    write_all(folder.path() / "all.cpp", all);
    const auto seen_by = [&](const std::string& compiler, const Arguments& flags) {
        // gcc and clang number the lines of a statement that spans several differently.
        const Arguments preprocess{
            compiler, "-std=c++" TESSERA_STANDARD, "-E", "-D__LINE__=0", "-w", "-I", headers.string(), "all.cpp"};
        return lines_from(headers, require_success(preprocess + flags, folder.path()));
    };
    const std::string plain = seen_by(TESSERA_COMPILER, {"-O0"});
    CHECK_THAT(plain, Contains("packed_streams=false"));
    CHECK((plain == seen_by(TESSERA_COMPILER, {"-O2", "-DNDEBUG"})));
    CHECK((plain ==
           seen_by(TESSERA_COMPILER, {"-D_DEBUG", "-DDEBUG", "-D_GLIBCXX_ASSERTIONS", "-D_FORTIFY_SOURCE=2", "-O1"})));
    if (const std::string other = other_compiler(); !other.empty())
        CHECK((plain == seen_by(other, {"-O2", "-DNDEBUG"})));
}

TEST_CASE("the libraries link with a client of another compiler") {
    const std::string other = other_compiler();
    if (other.empty()) {
        std::cout << "this test is skipped: it needs both gcc and clang\n";
        return;
    }
    const TestFolder folder(scratch);
    const fs::path moved = install_in(folder.path());
    for (const fs::path& client : {example, platform})
        for (const std::string type : {"Debug", "Release"}) {
            INFO(client << ' ' << type);
            fs::remove_all(folder.path() / "build");
            require_success(configuring(client, {"-DCMAKE_BUILD_TYPE=" + type}, moved, other), folder.path());
            require_success({"cmake", "--build", "build", "-j2"}, folder.path());
            if (client == example) {
                CHECK_THAT(require_success({"build/first_machine"}, folder.path()), Contains(" triangles in "));
            } else {
                require_success({"build/platform", "functional"}, folder.path());
                CHECK(fs::exists(folder.path() / "functional_2.pgm"));
            }
        }
}

TEST_CASE("a missing component, a missing package and another C++ standard are refused with the reason") {
    const TestFolder folder(scratch);
    const fs::path moved = install_in(folder.path());
    const auto client = [&](const std::string& components, const Arguments& settings = {}) {
        return configuring(careful_client, Arguments{"-DCOMPONENTS=" + components} + settings, moved);
    };
    expect_refusal(folder.path(), client("modules;shaders"), "No tessera::shaders: tessera has no such component");
    expect_refusal(folder.path(), client("shaders", from_sources),
                   "TESSERA_COMPONENTS names shaders; tessera has: datapath");
    expect_refusal(folder.path(), client("setup", from_sources), "No tessera::setup: glm was not found");
    for (const Arguments& from : {Arguments{}, from_sources}) {
        expect_refusal(folder.path(), client("modules", from + no_systemc_package), "apt-get install libsystemc-dev",
                       no_systemc);
        expect_refusal(folder.path(),
                       client("modules", from + Arguments{"-DCMAKE_CXX_STANDARD=" TESSERA_OTHER_STANDARD}),
                       "C++" TESSERA_OTHER_STANDARD " program does not link with it");
        fs::remove_all(folder.path() / "build");
        require_success(client("datapath", from + no_systemc_package + Arguments{"-DCMAKE_CXX_STANDARD=20"}),
                        folder.path(), no_systemc);
        require_success({"cmake", "--build", "build"}, folder.path());
    }
}

TEST_CASE("libraries are accepted at both ends of the range in README, refused below it and warned of beyond it") {
    const TestFolder folder(scratch);
    const fs::path list = source_folder() / "cmake/tessera_libraries.cmake", readme = source_folder() / "README.md";
    write_all(folder.path() / "find.cmake",
              "cmake_minimum_required(VERSION 3.21)\ninclude(\"" + list.string() +
                  "\")\nfile(WRITE ${name}Config.cmake \"set(${name}_VERSION ${release})\\n\")\n"
                  "tessera_find(${name} CONFIG PATHS . NO_DEFAULT_PATH ${required})\n"
                  "if(NOT ${name}_FOUND)\nmessage(\"left out: ${tessera_not_found}\")\nendif()\n");
    const auto find = [&](const std::string& name, const std::string& release, const std::string& required) {
        return run({"cmake", "-Dname=" + name, "-Drelease=" + release, "-Drequired=" + required, "-P", "find.cmake"},
                   folder.path());
    };
    const std::string text = read_all(list), table = read_all(readme);
    const std::regex row(R"(\n  (\w+) +(\S+) +(\d+(?:\.\d+)*) +(\d+)((?:\.\d+)*) +\w+)");
    int libraries = 0;
    for (std::sregex_iterator it(text.begin(), text.end(), row), none; it != none; ++it, ++libraries) {
        const std::string name = (*it)[1], package = (*it)[2], least = (*it)[3], major = (*it)[4];
        const std::string newest = major + std::string((*it)[5]), beyond = std::to_string(std::stoi(major) + 1) + ".0";
        std::string before = least;  // its last number, which is not 0, less one
        const std::size_t last = least.rfind('.') + 1;
        before.replace(last, std::string::npos, std::to_string(std::stoi(least.substr(last)) - 1));
        INFO(name);
        for (const std::string& release : {least, newest}) {
            const ProgramEnd found = find(name, release, "REQUIRED");
            INFO(found.text());
            CHECK(found.exit_code == 0);
            CHECK((found.out + found.err).empty());
        }
        const ProgramEnd old = find(name, before, "REQUIRED"), optional = find(name, before, "QUIET");
        CHECK(old.exit_code != 0);
        for (const ProgramEnd& end : {old, optional})
            CHECK_THAT(without_line_breaks(end.err), Contains("older than " + least + ". On Debian 12 or 13: ") &&
                                                         Contains("apt-get install " + package));
        CHECK(optional.exit_code == 0);
        const ProgramEnd later = find(name, beyond, "REQUIRED");
        CHECK(later.exit_code == 0);
        CHECK_THAT(without_line_breaks(later.err), Contains("CMake Warning") && Contains(least + " to " + newest));
    }
    CHECK(libraries == 12);

    std::map<std::string, std::string> columns{
        {"Embree", "embree"}, {"toml++", "tomlplusplus"}, {"nlohmann json", "nlohmann_json"}};
    const auto cells = [&](const std::string& start) {
        const std::size_t at = table.find("\n| " + start);
        REQUIRE(at != std::string::npos);
        std::istringstream line(table.substr(at + 2, table.find('\n', at + 1) - at - 2));
        std::vector<std::string> found;
        for (std::string cell; std::getline(line, cell, '|');)
            found.push_back(std::regex_replace(cell, std::regex("^ | $"), ""));
        return found;
    };
    const auto names = cells("| compiler"), oldest = cells("Debian 12 |"), newest = cells("Debian 13 |");
    REQUIRE(names.size() == 10);
    for (std::size_t k = 2; k < names.size(); ++k) {
        const std::string name = columns.count(names[k]) > 0 ? columns.at(names[k]) : names[k];
        INFO(name);
        CHECK(
            std::regex_search(text, std::regex("\n  " + name + " +\\S+ +" + oldest.at(k) + " +" + newest.at(k) + " ")));
    }
}

TEST_CASE("components left out of an installation are named with the reason") {
    const TestFolder folder(scratch);
    require_success(configuring(source_folder(), Arguments{"-DTESSERA_TESTBENCH=OFF"} + no_systemc_package),
                    folder.path(), no_systemc);
    require_success({"cmake", "--install", "build", "--prefix", "installed"}, folder.path());
    CHECK_FALSE(fs::exists(folder.path() / "installed/include/tessera/modules/machine.h"));
    CHECK(fs::exists(folder.path() / "installed/include/tessera/modules/version.h"));
    CHECK_THAT(read_all(folder.path() / "installed/lib/pkgconfig/tessera.pc"), !Contains("systemc"));
    const std::pair<std::string, std::string> reasons[] = {
        {"modules", "SystemC was not found"}, {"device", "it needs tessera::modules"}, {"setup", "glm was not found"}};
    for (const auto& [component, reason] : reasons)
        expect_refusal(folder.path(),
                       configuring(careful_client, {"-DCOMPONENTS=" + component}, folder.path() / "installed"),
                       "No tessera::" + component + ": it was left out when tessera was built: " + reason);
}

TEST_CASE("the version is the same everywhere") {
    const TestFolder folder(scratch);
    const fs::path moved = install_in(folder.path());
    CHECK(std::to_string(version_major) + "." + std::to_string(version_minor) + "." + std::to_string(version_patch) ==
          version);
    CHECK_THAT(read_all(moved / "lib/pkgconfig/tessera.pc"), Contains("\nVersion: " + std::string(version) + "\n"));
    CHECK_THAT(read_all(moved / "lib/cmake/tessera/tesseraConfigVersion.cmake"),
               Contains("set(PACKAGE_VERSION \"" + std::string(version) + "\")"));
    CHECK(succeed({"--version"}, folder.path()).out == "tessera " + std::string(version) + "\n");
    CHECK_THAT(read_all(source_folder() / ".github/CITATION.cff"),
               Contains("\nversion: " + std::string(version) + "\n"));
}

TEST_CASE("the README's CMake code is the example's") {
    const std::string cmake = read_all(example / "CMakeLists.txt");
    const std::vector<std::string> shown = code_in(source_folder() / "modules/README.md", "cmake");
    CHECK(shown.size() >= 5);
    for (const std::string& line : shown)
        CHECK_THAT(cmake, Contains(line.substr(line.find_first_not_of(' '))));
}
