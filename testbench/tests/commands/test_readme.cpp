#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <iomanip>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "testbench/tests/support/checkout.h"
#include "testbench/tests/support/expect_section.h"
#include "testbench/tests/support/program_runner.h"

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

/// The commands in the text's fenced `sh` blocks: one per line, with lines that end in a backslash joined.
std::vector<std::string> commands_in(const std::string& markdown) {
    std::vector<std::string> commands;
    bool within = false, continues = false;
    for (std::string line : lines_of(markdown)) {
        if (line.rfind("```", 0) == 0) {
            within = !within && std::regex_match(line, std::regex("```(sh|bash|shell)\\s*"));
            continue;
        }
        if (!within)
            continue;
        const std::size_t begin = line.find_first_not_of(" \t");
        if (begin == std::string::npos || line[begin] == '#')
            continue;
        line.erase(0, begin);
        if (continues)
            commands.back() += line;
        else
            commands.push_back(line);
        continues = !line.empty() && line.back() == '\\';
        if (continues)
            commands.back().pop_back();
    }
    return commands;
}

/// How a command is tested.
enum class Trial {
    run,      ///< run it, exit code 0
    parse,    ///< a script that takes long or needs more tools than tests do: it is there and its syntax is right
    build,    ///< builds and runs another program of ours: its folder has that target
    foreign,  ///< it fetches or installs; or test_packaging runs it
};

Trial trial_of(const std::string& command) {
    const auto says = [&](const char* words) { return std::regex_search(command, std::regex(words)); };
    if (says("^(git|sudo|apt|apt-get|docker|cd|g\\+\\+) "))
        return Trial::foreign;
    if (says("^(\\.ci/|scripts/(check|install|sweep)|scripts/figures$)"))
        return Trial::parse;
    if (says("^cmake .*--target "))
        return Trial::build;
    return Trial::run;
}

void parse_script(const fs::path& script) {
    INFO(script);
    REQUIRE(fs::is_regular_file(script));
    CHECK(::access(script.c_str(), X_OK) == 0);
    const std::string first = lines_of(read_all(script)).at(0);
    const std::vector<std::string> python{
        "python3", "-c", "import sys; compile(open(sys.argv[1]).read(), sys.argv[1], 'exec')", script.string()};
    const std::vector<std::string> bash{"bash", "-n", script.string()};
    const ProgramEnd end = run_program(first.find("python3") != std::string::npos ? python : bash, source_folder());
    INFO(end.text());
    CHECK(end.exit_code == 0);
}

/// cmake --build FOLDER --target TARGET && FOLDER/path/TARGET
void check_target(const std::string& command) {
    std::smatch parts;
    REQUIRE(
        std::regex_match(command, parts, std::regex("cmake --build (\\S+) --target (\\S+) && (\\S+)/([^/ ]+)( .*)?")));
    CHECK(parts[2] == parts[4]);
    const std::string build = parts[1], folder = parts[3];
    REQUIRE(folder.rfind(build + "/", 0) == 0);
    CHECK_THAT(read_all(source_folder() / folder.substr(build.size() + 1) / "CMakeLists.txt"),
               Contains("add_executable(" + parts[2].str()) || Contains("tessera_add_proof(" + parts[2].str()));
}

void try_command(const std::string& command, const Checkout& checkout) {
    INFO("$ " << command);
    switch (trial_of(command)) {
        case Trial::foreign: return;
        case Trial::parse: parse_script(source_folder() / command.substr(0, command.find(' '))); return;
        case Trial::build: check_target(command); return;
        case Trial::run: break;
    }
    const ProgramEnd end = checkout.run(command);
    INFO(end.text());
    CHECK(end.exit_code == 0);
}

/// [text](file) or [text](file#heading).
void check_links(const std::string& markdown, const fs::path& folder) {
    const std::regex link(R"(\]\(([^)#: ]+)(#[^)]*)?\))");
    for (std::sregex_iterator it(markdown.begin(), markdown.end(), link), end; it != end; ++it) {
        INFO(it->str());
        CHECK(fs::exists(folder / (*it)[1].str()));
    }
}

}  // namespace

TEST_CASE("commands are found in fenced shell blocks") {
    const std::string text =
        "Text.\n```sh\n# why\nscripts/run\nscripts/run head \\\n    --set a.b=1\n\n```\n"
        "```toml\n[tests]\n```\n`scripts/none`\n```bash\n  ls\n```\n```\noutput\n```\n";
    CHECK(commands_in(text) == std::vector<std::string>{"scripts/run", "scripts/run head --set a.b=1", "ls"});
}

TEST_CASE("every command of README.md works") {
    const std::vector<std::string> commands = commands_in(read_all(source_folder() / "README.md"));
    REQUIRE_FALSE(commands.empty());
    check_links(read_all(source_folder() / "README.md"), source_folder());
    const Checkout checkout;
    for (const std::string& command : commands)
        try_command(command, checkout);
}

TEST_CASE("every command of the folders' READMEs works, and every file they link to exists") {
    const Checkout checkout;
    unsigned commands = 0;
    for (const char* const folder : {"golden", "modules", "scripts", "testbench", "waveforms", ".github"}) {
        for (const auto& entry : fs::recursive_directory_iterator(source_folder() / folder)) {
            if (entry.path().extension() != ".md")
                continue;
            INFO(entry.path());
            const std::string text = read_all(entry.path());
            check_links(text, entry.path().parent_path());
            if (fs::exists(entry.path().parent_path() / "CMakeLists.txt") &&
                entry.path().parent_path().parent_path().filename() == "examples")
                continue;  // a project of its own: test_packaging runs its commands
            for (const std::string& command : commands_in(text)) {
                ++commands;
                try_command(command, checkout);
            }
        }
    }
    CHECK(commands > 10);
}

// The figures of the text, from runs: a row of the table of designs, or the words around a range over several jobs.
TEST_CASE("the cycles that README.md and modules/README.md state are those of the runs") {
    const TestFolder here;
    struct Measured {
        double per_triangle, per_edge, normal_tests;
    };
    std::map<std::string, Measured> known;
    const auto measure = [&](const std::string& job, const Arguments& keys) {
        Arguments command{"run", (source_folder() / "testbench/examples/jobs" / (job + ".toml")).string()};
        command = command +
                  set(Arguments{"check.golden=false", "check.end_to_end=false", "check.invariants=false",
                                "check.work=false", "output.picture=false", "output.ply=false", "output.folder=out"} +
                      keys);
        std::string name;
        for (const std::string& word : command)
            name += word + " ";
        if (const auto found = known.find(name); found != known.end())
            return found->second;
        succeed(command, here.path());
        const auto figures = nlohmann::json::parse(read_all(here.path() / "out/statistics.json"));
        const auto value = [&](const char* group, const char* figure) -> double {
            return figures[group][figure]["value"];
        };
        return known[name] = {value("timing", "cycles_per_triangle"), value("timing", "cycles_per_edge"),
                              value("useful_work", "normal_tests") / value("mesh", "triangles")};
    };
    const auto rounded = [](double value, int digits) {
        std::ostringstream text;
        text << std::fixed << std::setprecision(digits) << value;
        return text.str();
    };
    std::string page;  // without line ends
    for (const std::string& line : lines_of(read_all(source_folder() / "modules/README.md")))
        page += (line.rfind("| ", 0) == 0 ? "\n" : " ") + line;
    const auto states = [&](const std::string& words) {
        INFO(words);
        CHECK(page.find(words) != std::string::npos);
    };
    const Arguments cheap{"hardware.test_order=cheap_first"}, final_edges{"hardware.final_edges=true"},
        one_texel = cheap + final_edges + Arguments{"hardware.one_texel_from_map=true"},
        banks{"timing.summed_height_table_banks=8"}, by_xor{"timing.summed_height_table_interleave=xor"},
        window{"timing.summed_height_table_window=12"}, modern{"hardware.design=modern"},
        two_tests = modern + Arguments{"hardware.normal_tests=2", "timing.normal_map_ports=3"},
        eight_machines = modern + Arguments{"hardware.machines=8"},
        families =
            one_texel + banks + by_xor + window +
            Arguments{"hardware.work=family", "hardware.queue_order=lifo", "timing.pass_or_tessellate_buffer=32"};
    const auto row = [&](const char* begins, const Arguments& keys, int digits) {
        const std::size_t at = page.find(std::string("\n| ") + begins), end = page.find('\n', at + 1);
        REQUIRE(at != std::string::npos);
        const std::string figure = " | " + rounded(measure("half_donut", keys).per_triangle, digits) + " |";
        INFO(begins << figure);
        CHECK(page.substr(at, end - at).find(figure) != std::string::npos);
    };
    row("`test_order = \"parallel\"", {}, 1);
    row("`final_edges = true`", final_edges, 1);
    row("`test_order = \"cheap_first\"`", cheap, 1);
    row("both", cheap + final_edges, 1);
    row("and `one_texel_from_map", one_texel, 1);
    row("and `[timing] summed_height_table_banks = 8`", one_texel + banks + by_xor + window, 1);
    row("and `work = \"family\"`", families, 1);
    row("and `edge_lanes = 3`", modern, 2);
    row("and `normal_tests = 2`", two_tests, 2);
    row("`design = \"modern\"`, `machines = 8`", eight_machines, 2);

    std::vector<std::string> jobs{"crater_lake_24", "crater_lake_704", "head", "teapot"};
    const auto range = [&](double Measured::*figure, const Arguments& keys) {
        std::vector<double> all;
        for (const std::string& job : jobs)
            all.push_back(measure(job, keys).*figure);
        const auto [least, most] = std::minmax_element(all.begin(), all.end());
        return rounded(*least, 2) + " to " + rounded(*most, 2);
    };
    const auto per_triangle = [&](const Arguments& keys) { return range(&Measured::per_triangle, keys); };
    states("`design = \"modern\"` takes " + per_triangle(modern) +
           " cycles per finished triangle, with two Normal Tests");
    states("(the last row but one) " + per_triangle(two_tests) + ", with eight machines " +
           per_triangle(eight_machines) + ".");
    const auto one = [&](const std::string& job, const Arguments& keys) {
        return rounded(measure(job, keys).per_triangle, 2);
    };
    states("`crater_lake_rank` takes " + one("crater_lake_rank", modern) + ", " + one("crater_lake_rank", two_tests) +
           " and " + one("crater_lake_rank", eight_machines) + ":");
    const Arguments large{"map.width=1024", "map.height=1024"};
    states("needs " + rounded(measure("half_donut", large + modern).normal_tests, 2) +
           " Normal Tests per triangle, takes " + one("half_donut", large + modern) + " and " +
           one("half_donut", large + two_tests) + ".");
    const Arguments bilinear{"hardware.displacement_filter=bilinear"},
        ports{"timing.displacement_map_ports=4", "timing.normal_map_ports=4"};
    states("They take " + rounded(measure("half_donut", bilinear).per_triangle, 1) + " cycles each");
    states("; " + one("half_donut", bilinear + modern) +
           " in `design = \"modern\"`, now bound by the normal map, and " +
           one("half_donut", bilinear + modern + ports) + " with");
    jobs.emplace_back("half_donut");
    const auto per_edge = [&](const Arguments& keys) { return range(&Measured::per_edge, banks + keys); };
    states("an edge takes " + per_edge(by_xor + window) + " cycles on `half_donut` and the four jobs above; with " +
           "interleaving by entry " + per_edge(window) + ", and without the window " + per_edge(by_xor) + " and " +
           per_edge({}) + ".");

    // README.md: "a quarter of the cycles", three units "save no more", and "in a fortieth"
    const Arguments four{"timing.summed_height_table_ports=4"};
    const double paper = measure("half_donut", {}).per_triangle, quarter = measure("half_donut", four).per_triangle;
    CHECK(quarter / paper == Approx(1.0 / 4).epsilon(0.01));
    CHECK(measure("half_donut", four + Arguments{"hardware.tests_units=3"}).per_triangle ==
          Approx(quarter).epsilon(0.01));
    CHECK(paper / measure("half_donut", modern).per_triangle == Approx(40).epsilon(0.05));
}

TEST_CASE("every test that modules/README.md names exists") {
    const std::string sources = testing::all_test_sources();
    const std::string page = read_all(source_folder() / "modules/README.md");
    const std::regex row(R"(\n\|[^\n]*\| `(\w+ [^`\n]+)` \|(?=\n))");
    unsigned tests = 0;
    for (std::sregex_iterator it(page.begin(), page.end(), row), end; it != end; ++it, ++tests) {
        INFO(it->str());
        CHECK(sources.find('"' + (*it)[1].str() + '"') != std::string::npos);
    }
    CHECK(tests == 7);
}

TEST_CASE("every script parses") {
    for (const char* const folder : {"scripts", "scripts/checks", ".ci"}) {
        for (const auto& entry : fs::directory_iterator(source_folder() / folder))
            if (entry.is_regular_file() && entry.path().extension().empty())
                parse_script(entry.path());
    }
}

TEST_CASE("scripts/check lists its checks and runs the named ones with their options") {
    const Checkout checkout;
    const fs::path checks = checkout.root() / "scripts/checks";
    write_all(checks / "failing", "#!/bin/sh\n# Fails.\nset -e\necho \"failing $*\"\nexit 3\n");
    fs::permissions(checks / "failing", fs::perms::owner_all);

    const ProgramEnd help = checkout.run("scripts/check --help");
    CHECK(help.exit_code == 0);
    CHECK_THAT(help.out, Contains("  failing      Fails.\n") && Contains("\n  all  "));
    for (const auto& entry : fs::directory_iterator(checks))
        if (entry.is_regular_file())
            CHECK_THAT(help.out, Contains("\n  " + entry.path().filename().string() + " "));

    const ProgramEnd one = checkout.run("scripts/check failing --seconds 3 obj");
    CHECK(one.exit_code == 3);
    CHECK(one.out == "failing --seconds 3 obj\n");
    const ProgramEnd both = checkout.run("scripts/check failing rooms");
    INFO(both.text());
    CHECK(both.exit_code == 1);
    CHECK(std::regex_search(both.out, std::regex("summary: \\d+ min =+\nFAILED .* failing\npassed .* rooms\n$")));
    CHECK(checkout.run("scripts/check failing --help").out == "Fails.\n");

    for (const char* const words : {"nothing", "failing rooms nothing", "--nothing"}) {
        const ProgramEnd unknown = checkout.run("scripts/check " + std::string(words));
        INFO(unknown.text());
        CHECK(unknown.exit_code == 2);
        CHECK(unknown.out.empty());
        CHECK_THAT(unknown.err, Contains("nothing") && Contains("  failing  "));
    }
}

TEST_CASE("scripts/run takes a job by name or by file and passes on all options") {
    const Checkout checkout;
    const std::string quick = " --set tests.generation_limit=1 --set output.folder=out";
    const auto works = [&](const std::string& command) {
        const ProgramEnd end = checkout.run(command);
        INFO(command);
        INFO(end.text());
        CHECK(end.exit_code == 0);
        CHECK_THAT(end.out, Contains("results in " + (checkout.root() / "out").string()));
    };
    works("scripts/run" + quick);
    works("scripts/run half_donut" + quick);
    works("scripts/run testbench/examples/jobs/half_donut.toml" + quick);
    works(
        "mkdir elsewhere && cd elsewhere && ../scripts/run half_donut --set tests.generation_limit=1"
        " --set output.folder=../out");

    const ProgramEnd unknown = checkout.run("scripts/run half_donat");
    INFO(unknown.text());
    CHECK(unknown.exit_code == 2);
    CHECK(unknown.out.empty());
    for (const char* const words : {"half_donat", "half_donut", "teapot"})
        CHECK_THAT(unknown.err, Contains(words));
    CHECK(checkout.run("scripts/run --set nonsense=1").exit_code == 2);
    CHECK(checkout.run("scripts/run --set limits.triangles=1").exit_code == 4);
}
