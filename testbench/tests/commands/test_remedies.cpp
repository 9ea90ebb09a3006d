// Each remedy that a message names, followed literally: the message goes, and the exit code is 0. The table is remedies.h.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "testbench/tests/commands/remedies.h"
#include "testbench/tests/support/program_runner.h"

using namespace tessera;
namespace fs = std::filesystem;

namespace {

/// A job that takes a tenth of a second, and shell functions for the table.
constexpr const char* small_job = R"(mode = "functional"
[map]
width = 48
height = 48
[tests]
generation_limit = 2
[output]
picture = false
folder = "out"
)";
constexpr const char* prelude = R"(
# gtkwave: in the folder's bin, tells what it opens
gtkwave() { mkdir -p bin; printf '#!/bin/bash\necho "opens ${@: -2}"\n' > bin/gtkwave; chmod +x bin/gtkwave; }
# without COMMAND ...: a script of this repository, where these commands do not exist
without() {
    local name path=$PWD/few
    mkdir -p few
    for name in bash cat dirname readlink sort printf sed; do ln -sf $(type -P $name) few/; done
    PATH=$path "$@"
}
# run KEY=VALUE ...: the small job with these keys
run() { local s a=(); for s in "$@"; do a+=(--set "$s"); done; tessera run small.toml "${a[@]}"; }
# fine KEY=VALUE ...: the same, but with a fine mesh
fine() { run tests.generation_limit=15 tests.view_threshold=10 "$@"; }
# the small job without the checks
unchecked() { run check.golden=false check.end_to_end=false check.invariants=false check.work=false check.reads=false "$@"; }
# square SCALE X Y Z: an OBJ file, a square of this size at this place
square() {
    awk -v S=$1 -v X=${2:-0} -v Y=${3:-0} -v Z=${4:-0} 'BEGIN {
        for (k = 0; k < 4; ++k) {
            u = k == 1 || k == 2; v = k > 1
            printf "v %.12g %.12g %.12g\nvt %d %d\n", X + S * u, Y + S * v, Z, u, v
        }
        print "f 1/1 2/2 3/3 4/4"
    }'
}
# bound KEY=VALUE ...: a job that meets every condition of tests.bound_threshold, with these keys
bound() {
    run hardware.height_test=rank formats.bound_bits=8 mesh.source=lattice mesh.spacing=16 tests.bound_threshold=0.05 \
        hardware.triangulation=greatest_rank tests.normal=false tests.view=false tests.generation_limit=10 "$@"
}
# fold: an OBJ file, two squares at a right angle, with a normal for each
fold() {
    printf 'v %s\n' '0 0 0' '1 0 0' '1 1 0' '0 1 0' '1 0 1' '1 1 1'
    printf 'vt %s\n' '0 0' '.5 0' '.5 1' '0 1' '1 0' '1 1'
    printf '%s\n' 'vn 0 0 1' 'vn -1 0 0' 'f 1/1/1 2/2/1 3/3/1 4/4/1' 'f 2/2/2 5/5/2 6/6/2 3/3/2'
}
# seam: an OBJ file, two squares side by side, the second elsewhere in the map
seam() {
    printf 'v %s 0\n' '0 0' '1 0' '1 1' '0 1' '2 0' '2 1'
    printf 'vt %s\n' '0 0' '.5 0' '.5 1' '0 1' '1 0' '1 1' '.8 .1' '.8 1'
    printf '%s\n' 'f 1/1 2/2 3/3 4/4' 'f 2/7 5/5 6/6 3/8'
}
# mirrored: an OBJ file, a triangle and at each edge its mirror image
mirrored() {
    printf 'v %s 0\n' '-1 0' '1 0' '0 1.8' '0 -1.8' '2 1.8' '-2 1.8'
    printf 'vt %s\n' '.25 .4' '.75 .4' '.5 .9' '.5 0' '1 .9' '0 .9'
    printf '%s\n' 'f 1/1 2/2 3/3' 'f 2/2 1/1 4/3' 'f 3/3 2/2 5/1' 'f 1/1 3/3 6/2'
}
# quadric: a surface file
quadric() { printf '%s\n' '[quadric]' 'shape = "sphere"' 'radius = 2' 'centre = [0, 0, -1]'; }
# nurbs: another
nurbs() {
    printf '%s\n' '[nurbs]' 'degree_u = 2' 'degree_v = 1' 'knots_u = [0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0]' \
        'knots_v = [0.0, 0.0, 1.0, 1.0]' 'heights = [[0.0, 1.0, 2.0, 3.0], [4.0, 5.0, 6.0, 7.0]]'
}
# unwrapped SIZE: a job of one triangle with texture coordinates up to SIZE
unwrapped() {
    printf '%s\n' '[mesh]' 'source = "file"' 'file = "a.obj"' '[map]' 'address_u = "repeat"' 'address_v = "repeat"' > a.job
    printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'vt 0 0' "vt $1 0" "vt 0 $1" 'f 1/1 2/2 3/3' > a.obj
}
# bake OPTION ...: the surface file a.toml
bake() { tessera bake a.toml --output b.exr "$@"; }
# pgm WIDTH HEIGHT [MAXVAL]: an ASCII map, a slope
pgm() { awk -v W=$1 -v H=$2 -v M=${3:-255} 'BEGIN { print "P2", W, H, M; for (k = 0; k < W * H; ++k) print k % (M + 1) }'; }
# hole BLURRED: an ASCII map of heights with missing data, 65535, and beside them texels half way to it if BLURRED is 1
hole() {
    awk -v B=$1 'BEGIN {
        print "P2 48 48 65535"
        for (k = 0; k < 2304; ++k) {
            x = k % 48; y = int(k / 48); h = 1000 + k % 500
            print x < 20 && y < 20 ? 65535 : x < 21 && y < 21 && B ? int((65535 + h) / 2) : h
        }
    }'
}
)";

ProgramEnd shell(const std::string& script, const fs::path& folder, const std::vector<std::string>& arguments = {}) {
    const std::string known =
        "tessera() { '" + tessera_program() + "' \"$@\"; }\nscripts='" + (source_folder() / "scripts").string() + "'\n";
    return run_program(Arguments{"bash", "-euo", "pipefail", "-c", known + prelude + script, "shell"} + arguments,
                       folder);
}

/// Matches the advice in a message; each {} of its format is a group.
std::regex pattern_of(const std::string& advice) {
    static const std::regex special(R"([.*+?^$()\[\]|\\])"), field(R"(\{[^}]*\})");
    std::string pattern = std::regex_replace(advice, special, R"(\$&)");
    pattern = std::regex_replace(pattern, field, R"((\[[^\]]*\]|"[^"]*"|[a-z_.]+ = (?:"[^"]*"|\S+?)|\S+?))");
    return std::regex(advice.back() == ' ' ? pattern : pattern + R"((?=[;:,.)]*(?:\s|$)))");
}

/// The advice's `key = value`, as settings.
std::vector<std::string> settings_of(const std::string& advice) {
    static const std::regex setting(R"(([a-z_]+(?:\.[a-z_]+)?)`? ?= ?("[^"]*"|\[[^\]]*\]|[^\s;,)]*[^\s;,.)]))");
    std::vector<std::string> settings;
    for (std::sregex_iterator found(advice.begin(), advice.end(), setting); found != std::sregex_iterator(); ++found)
        settings.push_back((*found)[1].str() + "=" + (*found)[2].str());
    return settings;
}

void follow(const std::vector<Remedy>& remedies) {
    for (const Remedy& remedy : remedies) {
        const TestFolder here;
        here.write("small.toml", small_job);
        const std::regex advice = pattern_of(remedy.advice);
        const ProgramEnd before = shell(remedy.trigger, here.path());
        INFO(remedy.trigger << "\n" << remedy.advice << "\n" << before.text());
        CHECK((before.err.empty() || before.exit_code != 0));  // refused
        std::smatch found;
        const std::string text = before.out + before.err;
        CHECK(std::regex_search(text, found, advice));
        if (found.empty())
            continue;
        std::string next = remedy.follow;
        if (next.empty()) {
            const std::vector<std::string> settings = settings_of(found[0]);
            CHECK_FALSE(settings.empty());
            next = remedy.trigger;
            for (const std::string& setting : settings)
                next += " '" + setting + "'";
        }
        std::vector<std::string> printed;
        for (std::size_t k = 1; k < found.size(); ++k)
            printed.push_back(found[k]);
        const ProgramEnd after = shell(next, here.path(), printed);
        INFO("followed: " << next << "\n" << after.text());
        CHECK(after.exit_code == 0);
        CHECK_FALSE(std::regex_search(after.out + after.err, advice));
    }
}

/// A string literal of the sources; adjacent ones are one.
struct Literal {
    std::string place, text;
    bool help = false;  ///< of an option or key
};

std::string unescaped(const std::string& text) {
    std::string result;
    for (std::size_t k = 0; k < text.size(); ++k)
        result += text[k] != '\\' ? text[k] : text[++k] == 'n' ? '\n' : text[k];
    return result;
}

void collect(const fs::path& file, std::vector<Literal>& literals) {
    static const std::regex token(
        R"re(//[^\n]*|/\*[^]*?\*/|R"\(([^]*?)\)"|"((?:[^"\\\n]|\\[^])*)"|'(?:[^'\\]|\\[^])+')re", std::regex::optimize);
    static const std::regex not_message(R"(#include|add_option|add_flag|add_subcommand|key\.add\()");
    const std::string source = read_all(file);
    std::string statement;  // since the last ; { or }
    bool joined = false;    // to the last literal
    for (std::sregex_iterator found(source.begin(), source.end(), token); found != std::sregex_iterator(); ++found) {
        const std::string code = found->prefix();
        const std::size_t ends = code.find_last_of(";{}");
        statement = ends == std::string::npos ? statement + code : code.substr(ends + 1);
        joined = joined && code.find_first_not_of(" \t\n") == std::string::npos;
        if (!(*found)[1].matched && !(*found)[2].matched)
            continue;
        const std::string text = (*found)[1].matched ? (*found)[1].str() : unescaped((*found)[2]);
        if (joined) {
            literals.back().text += text;
        } else {
            const auto line = 1 + std::count(source.begin(), source.begin() + found->position(), '\n');
            literals.push_back({fs::relative(file, source_folder()).string() + ":" + std::to_string(line), text,
                                std::regex_search(statement, not_message)});
        }
        joined = true;
    }
}

void collect_script(const fs::path& file, std::vector<Literal>& literals) {
    static const std::regex message(R"re((?:give_up|echo|\|\|) "((?:[^"\\]|\\[^])*)")re", std::regex::optimize);
    const std::string source = read_all(file);
    for (std::sregex_iterator found(source.begin(), source.end(), message); found != std::sregex_iterator(); ++found)
        literals.push_back({fs::relative(file, source_folder()).string(),
                            std::regex_replace((*found)[1].str(), std::regex(R"(\$\w+)"), "{}")});
}

/// Whether a test's source has the words; that it also follows them is up to its author.
bool says(const fs::path& test, const std::string& words) {
    std::vector<Literal> literals;
    collect(test, literals);
    const std::regex pattern = pattern_of(words);
    return std::any_of(literals.begin(), literals.end(),
                       [&](const Literal& literal) { return std::regex_search(literal.text, pattern); });
}

/// Every text of the program and its libraries that a user may see.
std::vector<Literal> literals_of_messages() {
    std::vector<Literal> literals;
    for (const char* const script : {"common.sh", "install", "run", "waves"})
        collect_script(source_folder() / "scripts" / script, literals);
    for (const char* const room : {"modules", "testbench"}) {
        const fs::path root = source_folder() / room;
        for (auto entry = fs::recursive_directory_iterator(root); entry != fs::recursive_directory_iterator();
             ++entry) {
            const std::string name = fs::relative(entry->path(), root).string();
            if (entry->is_directory() &&
                (name == "tests" || name == "prove" || name == "benchmark" || name == "examples"))
                entry.disable_recursion_pending();
            const std::string extension = entry->path().extension().string();
            if (extension == ".cpp" || extension == ".h")
                collect(entry->path(), literals);
        }
    }
    return literals;
}

/// Whether a text tells its reader to do something.
bool advises(const std::string& text) {
    static const std::regex advice(
        "(?:^|[:;.,(] |, or |\\bor )(?:add|allow|bake|bring|call|change|check|choose|close|compare|convert|correct|create|cut|"
        "decrease|delete|divide|end|enlarge|export|flatten|free|give|increase|install|join|keep|leave|lower|make|measure|mount|"
        "move|multiply|name|narrow|omit|open|quote|raise|reduce|remove|rename|repair|replace|restore|run|save|search|set|"
        "shorten|simplify|simulate|subtract|sweep|switch|take|triangulate|try|tune|turn|use|widen|write)"
        "(?! (?:by|of|to|up)\\b) [`\"a-z0-9{(-]|see `|\\bneeds? [`0-9{]|\\bmust (?:be|name|end|differ|not)\\b",
        std::regex::icase | std::regex::optimize);
    return text.find(' ') != std::string::npos && std::regex_search(text, advice);
}

std::string listed(const std::set<std::string>& texts) {
    std::ostringstream list;
    for (const std::string& text : texts)
        list << "\n  " << text;
    return list.str();
}

}  // namespace

TEST_CASE("remedies: each that a message of the sources names has a case in the table") {
    std::vector<std::string> known;
    for (const auto& table : remedies())
        for (const Remedy& remedy : table.second)
            known.push_back(remedy.advice);
    for (const NotFollowed& text : not_followed()) {
        known.push_back(text.text);
        INFO(text.text << ", " << text.test);
        CHECK(text.test.empty() != text.why.empty());
        CHECK((text.test.empty() || says(source_folder() / "testbench/tests" / text.test, text.text)));
    }
    std::set<std::string> used, missing, unused;
    for (const Literal& literal : literals_of_messages()) {
        bool found = false;
        for (const std::string& text : known)
            if (literal.text.find(text) != std::string::npos) {
                used.insert(text);
                found = true;
            }
        if (!found && !literal.help && advises(literal.text))
            missing.insert(literal.place + ": " + literal.text);
    }
    for (const std::string& text : known)
        if (used.count(text) == 0)
            unused.insert(text);
    INFO("no case in testbench/tests/commands/remedies.h:" << listed(missing));
    INFO("cases of no message:" << listed(unused));
    CHECK(missing.empty());
    CHECK(unused.empty());
}

// clang-format off
TEST_CASE("remedies of jobs and settings") { follow(remedies().at("job")); }
TEST_CASE("remedies of maps") { follow(remedies().at("map")); }
TEST_CASE("remedies of meshes") { follow(remedies().at("mesh")); }
TEST_CASE("remedies of the machine") { follow(remedies().at("machine")); }
TEST_CASE("remedies of results and their checks") { follow(remedies().at("result")); }
TEST_CASE("remedies of commands and files") { follow(remedies().at("command")); }
TEST_CASE("remedies of scripts") { follow(remedies().at("script")); }
// clang-format on
