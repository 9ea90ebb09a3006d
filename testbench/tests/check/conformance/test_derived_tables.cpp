// Golden's own Rank and Curvature Tables: a fault of the host's is noticed, though golden is given the same table.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <regex>
#include <set>
#include <string>
#include <utility>

#include "testbench/check/conformance/setup_check.h"
#include "testbench/machine/inputs.h"
#include "testbench/machine/simulation.h"
#include "testbench/tests/check/conformance/setup_run.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/expect_section.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/source_folder.h"
#include "testbench/tests/support/test_folder.h"

using namespace tessera;
using Catch::Contains;
using testing::SetupRun;

namespace {

/// A fault of the host's Rank Table, made before it is written.
struct TableFault {
    std::string name;
    void (*make)(MachineSetup&);
    std::string noticed;
};

/// Of the k-th bisection.
std::size_t entry(const MachineSetup& setup, std::size_t k) {
    const datapath::TexCoord& at = setup.rank_tables.midpoints[k];
    const int fraction = setup.registers.formats.texture.fraction;
    return std::size_t{at.v >> fraction} * setup.rank_tables.columns + (at.u >> fraction);
}

void scale_bounds(MachineSetup& setup, double by) {
    const double steps = std::ldexp(std::log2(by), setup.registers.formats.bound_bits - 5);
    for (std::uint16_t& bound : setup.rank_tables.bound)
        if (bound > 0)
            bound = static_cast<std::uint16_t>(std::lround(bound + steps));
}

void require_noticed(const TableFault& fault, const std::string& settings) {
    Job job = testing::with_settings({}, "map.source=noise map.width=60 map.height=44 " + settings);
    job.mode = Mode::functional;
    const Inputs inputs = load_inputs(job);
    const Job& resolved = inputs.resolved.job;
    MachineSetup setup = make_setup(resolved, inputs.mesh, inputs.map);
    fault.make(setup);
    const GoldenJob golden(resolved, inputs.mesh, inputs.map, setup.model_scale, setup);
    Simulation simulation(setup, 1000000);
    REQUIRE(simulation.run().empty());
    const SetupResult result = check_setup(setup, golden, simulation);
    INFO(result.first_wrong);
    CHECK(result.wrong() > 0);
    CHECK_THAT(result.first_wrong, Contains(fault.noticed));
}

const testing::CaseTable table_faults(
    "golden's own Rank Table: ",
    {TableFault{"bounds 3 % too small", [](MachineSetup& s) { scale_bounds(s, 0.97); }, ".bound"},
     {"bounds 3 % too large", [](MachineSetup& s) { scale_bounds(s, 1.03); }, ".bound"},
     {"one bound", [](MachineSetup& s) { ++s.rank_tables.bound[entry(s, 100)]; }, ".bound"},
     {"a bound where no edge is bisected", [](MachineSetup& s) { s.rank_tables.bound[0] = 1; }, "(0, 0).bound"},
     {"one rank", [](MachineSetup& s) { --s.rank_tables.rank[entry(s, 100)]; }, ".rank"},
     {"two ranks exchanged",
      [](MachineSetup& s) { std::swap(s.rank_tables.rank[entry(s, 0)], s.rank_tables.rank[entry(s, 300)]); }, ".rank"},
     {"radii of one", [](MachineSetup& s) { std::fill(s.rank_tables.radius.begin(), s.rank_tables.radius.end(), 1); },
      ".radius"},
     {"one radius too small", [](MachineSetup& s) { --s.rank_tables.radius[entry(s, 50)]; }, ".radius"},
     {"two bisections exchanged",
      [](MachineSetup& s) { std::swap(s.rank_tables.midpoints[0], s.rank_tables.midpoints[400]); }, "bisection"},
     {"a bisection left out", [](MachineSetup& s) { s.rank_tables.midpoints.pop_back(); }, "never bisected"},
     {"the highest threshold", [](MachineSetup& s) { --s.rank_tables.highest_bound_threshold; },
      "highest_bound_threshold"},
     {"its columns", [](MachineSetup& s) { ++s.rank_tables.columns; }, "columns"}},
    [](const TableFault& fault) {
        require_noticed(
            fault,
            "hardware.height_test=rank mesh.source=lattice mesh.spacing=16 formats.bound_bits=16 formats.rank_bits=16 "
            "hardware.test_order=cheap_first tests.rank_view=per_point hardware.triangulation=greatest_rank "
            "map.address_v=clamp");
    });

const testing::CaseTable curvature_faults(
    "golden's own Curvature Table: ",
    {TableFault{"one entry", [](MachineSetup& s) { ++s.curvature_table.entries[100]; }, "curvature table: 100."},
     {"an entry left out", [](MachineSetup& s) { s.curvature_table.entries.pop_back(); }, "curvature_table.columns"},
     {"its columns", [](MachineSetup& s) { ++s.curvature_table.covered.width; }, "columns"}},
    [](const TableFault& fault) { require_noticed(fault, "hardware.height_test=curvature"); });

struct DerivedTable {
    std::string name, settings;
};

/// Jobs whose tables golden derives without a difference.
const testing::CaseTable derived_tables(
    "golden derives the table of a ",
    {DerivedTable{"lattice that repeats", "map.width=64 map.height=48 map.address_u=repeat map.address_v=repeat"},
     {"lattice longer than the map, which repeats", "map.width=60 map.address_u=repeat mesh.spacing=32"},
     {"lattice where an edge without an error is a period from a bisected one",
      "map.source=text map.text=. map.width=20 map.height=22 map.address_u=repeat map.address_v=repeat mesh.spacing=8"},
     {"lattice with entries of 6 bits", "formats.rank_bits=6 formats.bound_bits=6 mesh.spacing=64"},
     {"lattice with bounds alone, of 16 bits", "formats.rank_bits=0 formats.bound_bits=16"},
     {"plane off the lattice", "mesh.source=plane mesh.columns=2 mesh.rows=2 map.width=20 map.height=12"},
     {"plane with edges without an error beside the bisected ones",
      "mesh.source=plane mesh.columns=2 mesh.rows=1 map.width=1 map.height=64"},
     {"cylinder", "mesh.source=cylinder mesh.columns=8 mesh.rows=2 map.width=32 map.height=8 map.address_u=repeat"},
     {"lattice seen from near",
      "hardware.test_order=cheap_first tests.rank_view=per_point camera.eye=[0.2,0.3,0.5] camera.target=[0.5,0.5,0]"},
     {"Curvature Test on a lattice that repeats", "hardware.height_test=curvature map.width=64 map.address_u=repeat"},
     {"Curvature Test of a flat map", "hardware.height_test=curvature map.source=constant"}},
    [](const DerivedTable& row) {
        SetupRun run{testing::with_settings(
            {},
            "map.source=noise mesh.source=lattice mesh.spacing=16 map.width=60 map.height=44 formats.bound_bits=8 "
            "hardware.height_test=rank hardware.triangulation=greatest_rank tests.normal=false tests.view=false " +
                row.settings +
                (row.settings.find("curvature") != std::string::npos ? " hardware.triangulation=shorter" : ""))};
        const SetupResult result = run.check();
        INFO(result.first_wrong);
        CHECK(result.passed());
        CHECK(result.parts.size() == 6);
    });

}  // namespace

TEST_CASE("golden takes from the host only what its specification lists, each with a test") {
    const auto text = [](const char* file) { return read_all(source_folder() / file); };
    const auto all = [](const std::string& from, const char* pattern) {
        std::multiset<std::string> found;
        const std::regex matcher(pattern);
        for (std::sregex_iterator it(from.begin(), from.end(), matcher), end; it != end; ++it)
            found.insert((*it)[1]);
        return found;
    };
    const auto between = [](const std::string& in, const std::string& start, const std::string& end) {
        const std::size_t at = in.find(start);
        REQUIRE(at != std::string::npos);
        return in.substr(at + start.size(), in.find(end, at + start.size()) - at - start.size());
    };
    const std::string job = text("testbench/check/conformance/golden_job.h");
    std::multiset<std::string> taken =
        all(between(between(job, "struct TakenFromHost {", "};"), "}", "$"), R"((\w+);)");
    const char* const argument = R"((\w+)(?: = [^,]*)?(?:,|$))";
    taken.merge(all(between(job, "    GoldenJob(", ");"), argument));
    taken.merge(all(between(text("testbench/check/conformance/end_to_end.h"), "    GoldenRun(", ");"), argument));
    for (const char* const other : {"taken", "golden", "most"})  // these members; its own inputs; a limit
        REQUIRE(taken.erase(other) == 1);

    const std::string table = between(text("golden/ALGORITHM.md"), "| taken |", "\n\n");
    CHECK(all(table, R"(\n\| `(\w+)`)") == taken);

    const std::string tests = testing::all_test_sources();
    const auto named = all(table, R"(\| ([^|\n]*[^-|\n ]) \|(?=\n|$))");
    CHECK(named.size() == 11);
    for (const std::string& name : named)
        if (name != "test (first words)") {
            INFO(name);
            CHECK(tests.find('"' + name) != std::string::npos);
        }
}
