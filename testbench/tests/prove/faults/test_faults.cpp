#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "testbench/check/conformance/scoreboard.h"
#include "testbench/check/mesh/invariants.h"
#include "testbench/check/transport/conservation.h"
#include "testbench/common/child_process.h"
#include "testbench/common/error.h"
#include "testbench/prove/faults/faulty_units.h"
#include "testbench/tests/support/expect_section.h"
#include "testbench/tests/support/timed_checks.h"

// Every kind of fault at every place, in both modes: which checks detect it. An undetected one changes nothing.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

/// The result of a run with a fault.
struct Outcome {
    /// The checks that detected it, as in FAULT_COVERAGE.md. Empty: none; a point: the fault's transaction did not
    /// occur; with a question mark: the run says nothing about the fault.
    std::string catchers;
    std::string mesh;  ///< a hash of the emitted set of triangles
    std::string text;  ///< what each of them found first, a line each

    void catch_by(char catcher, const std::string& evidence) {
        catchers += catcher;
        text += evidence.substr(0, evidence.find('\n')) + "\n";
    }
};

std::string mesh_hash(const EmittedMesh& mesh) {
    std::uint64_t hash = 0;
    for (const Key& key : keys(mesh))
        for (const std::int64_t value : key)
            hash = (hash ^ static_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15u + 1;
    return std::to_string(hash);
}

/// Two triangles, with all edges split twice and a queue that spills: a few hundred transactions on each wire.
Job small_job(Mode mode) {
    Job job = full_split_job(1, 2);
    job.mode = mode;
    job.map.width = job.map.height = 32;
    job.hardware.queue.capacity = 4;
    job.timing.stalls = {5, 400, 24};
    return job;
}

char catcher_of(const sc_core::sc_report& report) {
    const std::string_view type = report.get_msg_type();
    if (type == "tessera/protocol")
        return 'P';
    if (type == "tessera/memory")
        return 'M';
    return type.substr(0, 8) == "tessera/" ? 'U' : '?';
}

/// With all checks.
Outcome run_here(Mode mode, const std::optional<Fault>& fault) {
    const MachineSetup setup = setup_of(small_job(mode));
    const GoldenInputs golden(setup);
    std::optional<FaultyUnits> units;
    if (fault)
        units.emplace(*fault, setup.registers.formats, tag_bits_in_use(setup.design));
    Simulation simulation(setup, 5000, 5000, units ? &*units : nullptr);
    Scoreboard scoreboard(setup.registers, golden);
    TransportCheck work(setup.registers, setup.base_triangles);
    simulation.machine.pass_or_tessellate.decided.bind(scoreboard);
    observe(simulation, work);

    Outcome outcome;
    if (fault && !units->placed())
        outcome.catch_by('?', "there is no " + fault->place);
    try {
        if (const std::string stuck = simulation.run(); !stuck.empty())
            outcome.catch_by('D', stuck);
    } catch (const sc_core::sc_report& report) {
        outcome.catch_by(catcher_of(report), report.get_msg());
    } catch (const ResourceError& error) {
        outcome.catch_by('L', error.what());
    }
    const bool drained = outcome.catchers.empty();
    // A check that stops a run with an error may do so before the next transaction.
    if (units && units->trigger().waits_for_next() && (drained || outcome.catchers == "D"))
        outcome.catch_by('?', "no later transaction came to change places with");
    if (units && !units->trigger().injected())
        outcome.catch_by('.', "its transaction never came");
    // A run that an error stops need not have compared every read.
    if (units && (drained ? !units->result().passed() : units->result().wrong > 0))
        outcome.catch_by('R', units->result().first_wrong);
    if (scoreboard.result().mismatches > 0)
        outcome.catch_by('S', scoreboard.result().first_mismatch);
    if (drained) {
        const WorkResult conserved = work_result(work, simulation);
        if (!conserved.passed())
            outcome.catch_by('W', conserved.first_violation);
        const InvariantResult invariants = check_invariants(simulation.monitor.mesh, setup);
        if (!invariants.passed())
            outcome.catch_by('I', invariants.first_violation);
    }
    outcome.mesh = mesh_hash(simulation.monitor.mesh);
    return outcome;
}

/// In a child process, since SystemC elaborates once per process.
Outcome run(Mode mode, const std::optional<Fault>& fault) {
    const ChildEnd end = run_in_child([&] {
        Outcome outcome;
        try {
            outcome = run_here(mode, fault);
        } catch (const std::exception& error) {
            outcome.catch_by('?', error.what());
        }
        return outcome.catchers + "\n" + outcome.mesh + "\n" + outcome.text;
    });
    REQUIRE(end.failure.empty());
    std::istringstream lines(end.told);
    Outcome outcome;
    std::getline(lines, outcome.catchers);
    std::getline(lines, outcome.mesh);
    std::getline(lines, outcome.text, '\0');
    return outcome;
}

/// Finds the position of a field of an item.
struct FieldFinder {
    std::string name, component;
    std::uint64_t bits = 0;
    std::optional<std::uint64_t> found = std::nullopt;

    std::int64_t field(const datapath::Field& field, std::int64_t value) {
        if (!found && field.index <= 0 && field.name == name && field.component == component)
            found = bits;
        bits += static_cast<std::uint64_t>(field.bits);
        return value;
    }
    std::uint32_t annotation(const char*, std::uint32_t value) const { return value; }
};

template <class Item>
std::uint64_t bit_of(const char* name, const char* component, Mode mode) {
    const MachineSetup setup = setup_of(small_job(mode));
    FieldFinder finder{name, component};
    const Item item{};
    describe_item(finder, item, setup.registers.formats, tag_bits_in_use(setup.design));
    REQUIRE(finder.found);
    return *finder.found;
}

/// A wire, and a significant bit of its items.
struct Place {
    const char* name;
    std::uint64_t transaction;  ///< that both modes have
    std::function<std::uint64_t(Mode)> bit;
    bool has_two = false;  ///< transactions: the second has none to change places with

    Place(const char* its_name, std::uint64_t its_transaction, std::uint64_t its_bit, bool two = false)
        : name(its_name), transaction(its_transaction), bit([its_bit](Mode) { return its_bit; }), has_two(two) {}
    template <class Item>
    Place(const char* its_name, std::uint64_t its_transaction, const Item*, const char* field, const char* component,
          std::uint64_t bit_of_field = 0)
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

/// A column of the table.
struct Kind {
    FaultKind kind;
    const char* name;
    bool without_cycles;  ///< functional mode has it
};
const std::vector<Kind> stream_kinds = {
    {FaultKind::bit_flip, "bit_flip", true},
    {FaultKind::dropped, "dropped", true},
    {FaultKind::doubled, "doubled", true},
    {FaultKind::reordered, "reordered", true},
    {FaultKind::back_pressure_ignored, "back_pressure_ignored", false},
    {FaultKind::request_before_end, "request_before_end", false},
    {FaultKind::end_request_doubled, "end_request_doubled", false},
};
const std::vector<Kind> memory_kinds = {
    {FaultKind::bit_flip, "bit_flip", true},
    {FaultKind::address_flip, "address_flip", true},
    {FaultKind::dropped, "dropped", true},
    {FaultKind::doubled, "doubled", false},
    {FaultKind::request_before_end, "request_before_end", false},
    {FaultKind::end_request_doubled, "end_request_doubled", false},
    {FaultKind::error_response, "error_response", true},
    {FaultKind::response_lost, "response_lost", true},
    {FaultKind::response_doubled, "response_doubled", false},
    {FaultKind::response_early, "response_early", false},
    {FaultKind::response_reordered, "response_reordered", false},
};

/// One mode's table, with a row for each place and a column for each kind.
std::string table(Mode mode, const std::vector<Place>& places, std::vector<Kind> kinds) {
    if (mode == Mode::functional)
        kinds.erase(std::remove_if(kinds.begin(), kinds.end(), [](const Kind& k) { return !k.without_cycles; }),
                    kinds.end());
    std::string text = "| place |";
    std::string rule = "\n| --- |";
    for (const Kind& kind : kinds) {
        text += " " + std::string(kind.name) + " |";
        rule += " --- |";
    }
    text += rule + "\n";
    const Outcome clean = run(mode, std::nullopt);
    INFO(clean.text);
    REQUIRE(clean.catchers.empty());
    for (const Place& place : places) {
        if (mode == Mode::functional && std::string(place.name) == "triangle_queue.off_chip_memory")
            continue;
        const std::string unit = "tessellation_tests_0.", name = place.name;
        text += "| " + name.substr(name.rfind(unit, 0) == 0 ? unit.size() : 0) + " |";
        for (const Kind& kind : kinds) {
            const bool held_back = strikes_held_back(kind.kind);
            const bool first = held_back || (kind.kind == FaultKind::reordered && place.has_two);
            const Outcome outcome =
                run(mode, Fault{kind.kind, place.name, first ? 1 : place.transaction, place.bit(mode)});
            INFO(kind.name << " at " << place.name << ": " << outcome.text);
            CHECK_THAT(outcome.catchers, !Contains("?"));
            if (outcome.catchers.find('.') != std::string::npos)
                CHECK((held_back && outcome.catchers == "."));
            if (outcome.catchers.empty())
                CHECK(outcome.mesh == clean.mesh);
            text += " " + (outcome.catchers.empty() ? "=" : outcome.catchers) + " |";
        }
        text += "\n";
    }
    return text;
}

/// The part of testbench/prove/faults/FAULT_COVERAGE.md under a heading.
void compare_with_document(const std::string& heading, const std::string& found) {
    testing::expect_section("testbench/prove/faults/FAULT_COVERAGE.md", "## " + heading + "\n\n", found,
                            testing::SectionEnd::empty_line);
}

}  // namespace

TEST_CASE("faults on streams, functional mode, are caught as documented") {
    compare_with_document("Streams, functional mode", table(Mode::functional, streams, stream_kinds));
}

TEST_CASE("faults on streams, timed mode, are caught as documented") {
    compare_with_document("Streams, timed mode", table(Mode::timed, streams, stream_kinds));
}

TEST_CASE("faults at memories, functional mode, are caught as documented") {
    compare_with_document("Memories, functional mode", table(Mode::functional, memories, memory_kinds));
}

TEST_CASE("faults at memories, timed mode, are caught as documented") {
    compare_with_document("Memories, timed mode", table(Mode::timed, memories, memory_kinds));
}

// The first edge is the plane's lower side, 32 texels long: its rectangles are 16 texels wide and 1 high. Rows of the
// table have 33 entries of 4 bytes. In timed mode; functional mode requests one entry at a time.
TEST_CASE("read checks compare every entry of a rectangle and name the address of the wrong one") {
    std::vector<std::uint64_t> wrong;
    for (const std::uint64_t corner : {0U, 1U, 2U, 3U}) {
        // A bit of the corner's entry, in another byte for each corner.
        const Outcome outcome = run(Mode::timed, Fault{FaultKind::bit_flip, summed_height_table, 1, (32 + 9) * corner});
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

TEST_CASE("an impossible fault is not counted as injected") {
    const auto catchers = [](const Fault& fault) { return run(Mode::timed, fault).catchers; };
    CHECK(catchers({FaultKind::dropped, "displace_vertex.to_transforn", 1, 0}) == "?.");
    CHECK(catchers({FaultKind::dropped, "displace_vertex.to_transform", 100000, 0}) == ".");
    CHECK(catchers({FaultKind::bit_flip, "host.to_get_triangle", 1, 99999}) == "?");
    CHECK(catchers({FaultKind::bit_flip, "displace_vertex.displacement_map", 1, 99999}) == "?");
    CHECK(catchers({FaultKind::address_flip, "displace_vertex.displacement_map", 1, 64}) == "?");
    CHECK_THAT(catchers({FaultKind::reordered, "host.to_get_triangle", 2, 0}), Contains("?"));
}
