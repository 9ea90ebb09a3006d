#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "testbench/check/transport/conservation.h"
#include "testbench/common/exit_process.h"
#include "testbench/job/job_choices.h"
#include "testbench/prove/faults/checked_run.h"
#include "testbench/tests/support/timed_checks.h"

// Every kind of fault at every place in both modes: who catches it. What nobody catches must have changed nothing.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

/// What a run with a fault came to, in a form that goes through a pipe.
struct Outcome {
    std::string catchers;  ///< their letters, in the order of judge_fault; ?: the run itself failed
    std::string text;      ///< of the report
    std::string mesh;      ///< a hash of the emitted set of triangles
};

/// By name as reports have it.
const std::vector<std::pair<char, std::string>> letters = {
    {'P', "protocol checker"}, {'M', "memory response"},   {'U', "unit's own check"},
    {'D', "watchdog"},         {'L', "resource limit"},    {'R', "read check"},
    {'S', "scoreboard"},       {'W', "work conservation"}, {'I', "invariants"}};

std::string mesh_hash(const EmittedMesh& mesh) {
    std::uint64_t hash = 0;
    for (const Key& key : keys(mesh))
        for (const std::int64_t value : key)
            hash = (hash ^ static_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15u + 1;
    return std::to_string(hash);
}

/// Two triangles, all edges split twice, a queue that spills: a few hundred transactions on each wire.
Job small_job(Mode mode) {
    Job job = full_split_job(1, 2);
    job.mode = mode;
    job.map.width = job.map.height = 32;
    job.hardware.queue_capacity = 4;
    job.timing.stalls = {5, 400, 24};
    return job;
}

Outcome run_here(const Job& job) {
    const MachineSetup setup = setup_of(job);
    const GoldenInputs golden(setup);
    std::optional<CheckedUnits> units;
    if (CheckedUnits::wanted(job))
        units.emplace(job, setup.registers.formats, tag_bits_in_use(setup.design));
    Simulation simulation(setup, 5000, 5000, units ? &*units : nullptr);
    Scoreboard scoreboard(setup.registers, golden);
    TransportCheck work(setup.registers, setup.base_triangles);
    simulation.pipeline.pass_or_tessellate.decided.bind(scoreboard);
    simulation.pipeline.pass_or_tessellate.decided.bind(work);
    simulation.pipeline.pass_or_tessellate.finished.bind(work);
    simulation.rasteriser.taken.bind(work);
    if (units)
        units->require_placed();
    const FaultRun run = run_with_fault(simulation);
    const ConformanceResult conformance = scoreboard.result();
    std::optional<WorkResult> works;
    std::optional<InvariantResult> invariants;
    if (!run.stopped) {
        works = work_result(work, simulation);
        invariants = check_invariants(simulation.monitor.mesh, setup);
    }
    Outcome outcome;
    outcome.mesh = mesh_hash(simulation.monitor.mesh);
    if (job.fault.kind == FaultKind::none) {
        const bool fine = !run.stopped && works->passed() && invariants->passed() &&
                          conformance.mismatches == 0 && (!units || read_result(*units).passed());
        outcome.text = run.text + (works ? works->first_violation : "");
        outcome.catchers = fine ? "" : "?";
        return outcome;
    }
    const FaultReport report = judge_fault(job.fault, *units, run, job.mode == Mode::timed, &conformance,
                                           works ? &*works : nullptr, invariants ? &*invariants : nullptr);
    outcome.text = report.injected;
    for (const Caught& caught : report.caught) {
        outcome.text += "\n" + caught.by + ": " + caught.evidence;
        for (const auto& [letter, name] : letters)
            if (name == caught.by)
                outcome.catchers += letter;
    }
    return outcome;
}

/// In a process of its own: SystemC elaborates once in each.
Outcome run(const Job& job) {
    std::array<int, 2> ends{};
    REQUIRE(pipe(ends.data()) == 0);
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        Outcome outcome;
        try {
            outcome = run_here(job);
        } catch (const std::exception& error) {
            outcome = {"?", error.what(), ""};
        }
        const std::string all = outcome.catchers + "\n" + outcome.mesh + "\n" + outcome.text;
        const bool written = write(ends[1], all.data(), all.size()) == static_cast<ssize_t>(all.size());
        exit_process(written ? 0 : 1);
    }
    close(ends[1]);
    std::string all;
    std::array<char, 4096> buffer{};
    for (ssize_t got = 0; (got = read(ends[0], buffer.data(), buffer.size())) > 0;)
        all.append(buffer.data(), static_cast<std::size_t>(got));
    close(ends[0]);
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return {"?", "the process ended by signal " + std::to_string(WTERMSIG(status)), ""};
    Outcome outcome;
    std::istringstream lines(all);
    std::getline(lines, outcome.catchers);
    std::getline(lines, outcome.mesh);
    std::getline(lines, outcome.text, '\0');
    return outcome;
}

Job with_fault(Mode mode, FaultKind kind, const std::string& place, int transaction, int bit) {
    Job job = small_job(mode);
    job.fault = {kind, place, transaction, bit};
    return job;
}

/// Where a field of an item begins.
struct FieldFinder {
    std::string name, component;
    int bits = 0;
    int found = -1;

    std::int64_t field(const datapath::Field& field, std::int64_t value) {
        if (found < 0 && field.index <= 0 && field.name == name && field.component == component)
            found = bits;
        bits += field.bits;
        return value;
    }
    std::uint32_t annotation(const char*, std::uint32_t value) const { return value; }
};

template <class Item>
int bit_of(const char* name, const char* component, Mode mode) {
    const MachineSetup setup = setup_of(small_job(mode));
    FieldFinder finder{name, component};
    const Item item{};
    describe_item(finder, item, setup.registers.formats, tag_bits_in_use(setup.design));
    REQUIRE(finder.found >= 0);
    return finder.found;
}

/// A wire, and a bit that matters of what it carries.
struct Place {
    const char* name;
    int transaction;  ///< that both modes have
    std::function<int(Mode)> bit;
    bool has_two = false;  ///< transactions: the second has none to change places with

    Place(const char* its_name, int its_transaction, int its_bit, bool two = false)
        : name(its_name),
          transaction(its_transaction),
          bit([its_bit](Mode) { return its_bit; }),
          has_two(two) {}
    template <class Item>
    Place(const char* its_name, int its_transaction, const Item*, const char* field, const char* component,
          int bit_of_field = 0)
        : name(its_name),
          transaction(its_transaction),
          bit([=](Mode mode) { return bit_of<Item>(field, component, mode) + bit_of_field; }) {}
};

template <class Item>
constexpr const Item* of = nullptr;

const std::vector<Place> streams = {
    {"host.to_get_triangle", 1, 0},
    {"get_triangle.to_calculate_new_p", 3, of<GeometryOperands>, "part", ""},
    {"get_triangle.to_tessellation_tests_0", 3, of<TestOperands>, "part", ""},
    {"get_triangle.to_pass_or_tessellate", 2, of<TakenTriangle>, "p", "x"},
    {"calculate_new_p.to_displace_vertex", 5, of<BasePoint>, "p", "x"},
    {"displace_vertex.to_transform", 5, of<DisplacedPoint>, "displaced", "x"},
    {"transform.to_pass_or_tessellate", 5, of<ScreenPoint>, "screen", "x"},
    {"transform.to_view_test_0", 1, of<ScreenCorner>, "tag", ""},
    {"tessellation_tests_0.calculate_new_u.to_tex_coord_test", 5, of<TexCoordOperands>, "t_ij", "u"},
    {"tessellation_tests_0.calculate_new_u.to_summed_height_test", 5, of<HeightOperands>, "tag", ""},
    {"tessellation_tests_0.calculate_new_u.to_normal_test", 5, of<NormalOperands>, "n_i", "x", 12},
    {"tessellation_tests_0.calculate_new_u.to_view_test", 5, of<ViewOperands>, "part", ""},
    {"tessellation_tests_0.tex_coord_test.output", 5, of<TexCoordResult>, "tex_coord", ""},
    {"tessellation_tests_0.summed_height_test.output", 5, of<HeightResult>, "summed_height", ""},
    {"tessellation_tests_0.normal_test.output", 5, of<NormalResult>, "normal", ""},
    {"tessellation_tests_0.view_test.output", 5, of<ViewResult>, "view", ""},
    {"tessellation_tests_0.collect_tests.to_pass_or_tessellate", 5, of<TestedEdge>, "tests", ""},
    {"pass_or_tessellate.to_tessellation", 3, of<DecidedTriangle>, "p", "x"},
    {"pass_or_tessellate.to_lighting", 3, of<TriangleToLight>, "screen", "x"},
    {"tessellation.to_triangle_queue", 5, 0},
    {"triangle_queue.to_get_triangle", 5, 0},
    {"triangle_queue.level", 2, 0, true},
    {"lighting.to_rasteriser", 3, 0},
};
constexpr const char* summed_height_table = "tessellation_tests_0.summed_height_test.summed_height_table";
const std::vector<Place> memories = {
    {"displace_vertex.displacement_map", 5, 3},
    {"tessellation_tests_0.normal_test.normal_map", 5, 3},
    {summed_height_table, 5, 0},
    {"triangle_queue.off_chip_memory", 5, 0},
};
constexpr FaultKind stream_kinds[] = {FaultKind::bit_flip,
                                      FaultKind::dropped,
                                      FaultKind::doubled,
                                      FaultKind::reordered,
                                      FaultKind::back_pressure_ignored,
                                      FaultKind::request_before_end,
                                      FaultKind::end_request_doubled};
constexpr FaultKind memory_kinds[] = {
    FaultKind::bit_flip,       FaultKind::address_flip,       FaultKind::dropped,
    FaultKind::doubled,        FaultKind::request_before_end, FaultKind::end_request_doubled,
    FaultKind::error_response, FaultKind::response_lost,      FaultKind::response_doubled,
    FaultKind::response_early, FaultKind::response_reordered};

bool applies(FaultKind kind, Mode mode, bool memory) {
    if (mode == Mode::timed)
        return true;
    switch (kind) {
        case FaultKind::bit_flip:
        case FaultKind::dropped:
        case FaultKind::reordered:
        case FaultKind::address_flip:
        case FaultKind::error_response:
        case FaultKind::response_lost:
            return true;
        case FaultKind::doubled:
            return !memory;
        default:
            return false;
    }
}

/// One mode's table: a row a place, a column a kind.
template <class Places, class Kinds>
std::string table(Mode mode, const Places& places, const Kinds& kinds, bool memory) {
    std::string text = "| place |";
    std::string rule = "\n| --- |";
    for (const FaultKind kind : kinds)
        if (applies(kind, mode, memory)) {
            text += " " + std::string(name_of(kind)) + " |";
            rule += " --- |";
        }
    text += rule + "\n";
    const Outcome clean = run(small_job(mode));
    INFO(clean.text);
    REQUIRE(clean.catchers.empty());
    for (const Place& place : places) {
        if (mode == Mode::functional && std::string(place.name) == "triangle_queue.off_chip_memory")
            continue;
        text += "| " + std::string(place.name) + " |";
        for (const FaultKind kind : kinds) {
            if (!applies(kind, mode, memory))
                continue;
            const bool held_back = kind == FaultKind::back_pressure_ignored ||
                                   kind == FaultKind::request_before_end || kind == FaultKind::response_early;
            const bool first = held_back || (kind == FaultKind::reordered && place.has_two);
            const int transaction = first ? 1 : place.transaction;
            const Outcome outcome = run(with_fault(mode, kind, place.name, transaction, place.bit(mode)));
            INFO(name_of(kind) << " at " << place.name << ", " << name_of(mode) << ": " << outcome.text);
            if (held_back &&
                outcome.text.find("saw 0 transactions that were held back") != std::string::npos) {
                text += " . |";
                continue;
            }
            CHECK_THAT(outcome.catchers, !Contains("?"));
            if (outcome.catchers.empty())
                CHECK(outcome.mesh == clean.mesh);
            text += " " + (outcome.catchers.empty() ? "=" : outcome.catchers) + " |";
        }
        text += "\n";
    }
    return text;
}

/// The part of testbench/prove/faults/FAULT_COVERAGE.md under a heading. TESSERA_WRITE_FAULT_COVERAGE: written anew instead.
void compare_with_document(const std::string& heading, const std::string& found) {
    const std::string path = TESSERA_SOURCE_DIR "/testbench/prove/faults/FAULT_COVERAGE.md";
    std::stringstream stream;
    stream << std::ifstream(path).rdbuf();
    std::string document = stream.str();
    const std::size_t begin = document.find("## " + heading + "\n\n");
    REQUIRE(begin != std::string::npos);
    const std::size_t from = begin + heading.size() + 5;
    const std::size_t to = std::min(document.find("\n\n", from), document.size() - 1) + 1;
    if (std::getenv("TESSERA_WRITE_FAULT_COVERAGE") != nullptr) {
        document.replace(from, to - from, found);
        std::ofstream(path) << document;
        return;
    }
    INFO(
        "testbench/prove/faults/FAULT_COVERAGE.md says something else; TESSERA_WRITE_FAULT_COVERAGE=1 has "
        "the test write "
        "it");
    CHECK(document.substr(from, to - from) == found);
}

}  // namespace

TEST_CASE("faults on streams, functional mode: who catches which") {
    compare_with_document("Streams, functional mode", table(Mode::functional, streams, stream_kinds, false));
}

TEST_CASE("faults on streams, timed mode: who catches which") {
    compare_with_document("Streams, timed mode", table(Mode::timed, streams, stream_kinds, false));
}

TEST_CASE("faults at memories, functional mode: who catches which") {
    compare_with_document("Memories, functional mode", table(Mode::functional, memories, memory_kinds, true));
}

TEST_CASE("faults at memories, timed mode: who catches which") {
    compare_with_document("Memories, timed mode", table(Mode::timed, memories, memory_kinds, true));
}

TEST_CASE("read checks without a fault find none, and the mesh is the same") {
    for (const Mode mode : {Mode::functional, Mode::timed}) {
        Job job = small_job(mode);
        const Outcome plain = run(job);
        job.check.reads = true;
        const Outcome checked = run(job);
        INFO(checked.text);
        CHECK(checked.catchers.empty());
        CHECK(checked.mesh == plain.mesh);
    }
}

// The first edge is the plane's lower side, 32 texels long: its rectangles are 16 texels wide and 1 high. Rows of
// the table have 33 entries of 4 bytes. Timed mode: functional mode asks for one entry at a time.
TEST_CASE("read checks compare every entry of a rectangle, and name the address of the wrong one") {
    std::vector<std::uint64_t> wrong;
    for (const int corner : {0, 1, 2, 3}) {
        const Outcome outcome =
            run(with_fault(Mode::timed, FaultKind::bit_flip, summed_height_table, 1, 32 * corner));
        INFO(outcome.text);
        CHECK(outcome.catchers == "R");
        const std::string before = "a read at address ";
        const std::size_t at = outcome.text.find(before);
        REQUIRE(at != std::string::npos);
        wrong.push_back(std::stoull(outcome.text.substr(at + before.size()), nullptr, 16));
    }
    // top right, top left, bottom right, bottom left
    CHECK(wrong[0] - wrong[1] == 4 * 16);
    CHECK(wrong[0] - wrong[2] == 4 * 33);
    CHECK(wrong[2] - wrong[3] == 4 * 16);
}

TEST_CASE("a fault that cannot be is refused with what can") {
    CHECK_THAT(run(with_fault(Mode::timed, FaultKind::dropped, "displace_vertex.to_transforn", 1, 0)).text,
               Contains("did you mean \"displace_vertex.to_transform\"") &&
                   Contains("lighting.to_rasteriser") && Contains("triangle_queue.off_chip_memory"));
    CHECK_THAT(
        run(with_fault(Mode::timed, FaultKind::dropped, "displace_vertex.to_transform", 100000, 0)).text,
        Contains("fault.transaction = 100000 was never reached: displace_vertex.to_transform saw "));
    CHECK_THAT(run(with_fault(Mode::timed, FaultKind::bit_flip, "host.to_get_triangle", 1, 99999)).text,
               Contains("fault.bit = 99999"));
}
