#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/checked_run.h"
#include "testbench/tests/support/job_settings.h"

// Designs that leave out tests which cannot change a decision: the mesh, with its tags, and the reports' counts are
// those of the paper's design; exactly those tests are evaluated that the rules of modules/README.md require.

using namespace tessera;
using namespace tessera::testing;

namespace {

/// The tests that a design must evaluate, from a recursion that evaluates everything.
struct Expected {
    struct Note {
        bool base = false;
        unsigned final_edges = 0;
        unsigned inside = 0;  // bit k: edge k belongs to two children
    };
    const MachineSetup& setup;
    bool cheap_first = setup.design.test_order == TestOrder::cheap_first;
    bool families = setup.design.work == Work::family;
    bool final_edges = setup.registers.formats.final_edges || families;
    bool from_map = setup.registers.formats.codes;

    std::uint64_t edges = 0, normal = 0, summed_height = 0, by_codes = 0;  // counted twice
    std::uint64_t split_by_both = 0, stopped_by_view_alone = 0, stopped_by_several = 0;

    static Note begin(const datapath::Triangle&) { return {true}; }
    void decided(const datapath::TrianglePass& pass, const datapath::ChildIndices&, const Note& note) {
        for (unsigned k = 0; k < 3; ++k) {
            const unsigned tests = pass.edges[k].tests;
            add_to_report(tests, (pass.split >> k & 1u) != 0);
            if (final_edges && (note.final_edges >> k & 1u) != 0)
                continue;
            const unsigned once = families && (note.inside >> k & 1u) != 0 ? 1 : 2;
            edges += once;
            const bool gates = (tests & datapath::gating_tests) == datapath::gating_tests;
            const bool splits = (tests & (datapath::normal_bit | datapath::highlight_bit)) != 0;
            normal += !cheap_first || gates || (note.base && !families) ? once : 0u;
            const bool its_height = !cheap_first || (gates && !splits);
            summed_height += its_height ? once : 0u;
            const bool codes = from_map && (families || !note.base);
            by_codes += its_height && codes && within_texels(pass, static_cast<int>(k)) ? once : 0u;
        }
    }
    /// A child's edge is final if it is a whole edge of the parent, from corner to corner, and half an edge if it joins
    /// a corner to the midpoint (3 + k) of an edge k that ends there; every other is inside the parent.
    static Note child(const std::array<std::uint8_t, 3>& corners) {
        Note note;
        for (unsigned k = 0; k < 3; ++k) {
            const int least = std::min(corners[k], corners[k == 2 ? 0 : k + 1]);
            const int most = std::max(corners[k], corners[k == 2 ? 0 : k + 1]);
            if (most <= 2)
                note.final_edges |= 1u << k;
            else if (least > 2 || (least != most - 3 && least != (most - 2) % 3))
                note.inside |= 1u << k;
        }
        return note;
    }
    void finished(const datapath::Triangle&, bool) {}

  private:
    /// |du| / 2 and |dv| / 4, rounded down, are 0 or 1.
    bool within_texels(const datapath::TrianglePass& pass, int edge) const {
        const datapath::TexCoord& i = pass.edge_begin(edge).texture;
        const datapath::TexCoord& j = pass.edge_end(edge).texture;
        const std::int64_t texel = std::int64_t{1} << setup.registers.formats.texture.fraction;
        return std::llabs(std::int64_t{i.u} - j.u) < 4 * texel && std::llabs(std::int64_t{i.v} - j.v) < 8 * texel;
    }
    void add_to_report(unsigned tests, bool split) {
        const bool normal_test = (tests & datapath::normal_bit) != 0;
        const bool summed_height_test = (tests & datapath::summed_height_bit) != 0;
        split_by_both += split && normal_test && summed_height_test ? 1u : 0u;
        if (split || (tests & datapath::requesting_tests) == 0)
            return;
        const bool view = (tests & datapath::view_bit) != 0, tex_coord = (tests & datapath::tex_coord_bit) != 0,
                   generation = (tests & datapath::generation_bit) != 0;
        stopped_by_view_alone += !view && tex_coord && generation ? 1u : 0u;
        stopped_by_several += int{view} + int{tex_coord} + int{generation} < 2 ? 1u : 0u;
    }
};

const std::string functional = "mode=functional ", cheap_first = "hardware.test_order=cheap_first ",
                  final_edges = "hardware.final_edges=true ", one_texel = "hardware.one_texel_from_map=true ",
                  all_three = one_texel + cheap_first + final_edges, families = "hardware.work=family ",
                  lanes = families + cheap_first + one_texel + "hardware.edge_lanes=3 ",
                  modern = "hardware.design=modern ", bilinear = "hardware.displacement_filter=bilinear ",
                  spills = "hardware.queue_capacity=1 ", highlight = "tests.highlight=true hardware.culling=back ",
                  small_buffers =
                      "timing.edges_in_sequence=1 timing.results_buffer=1 "
                      "timing.pass_or_tessellate_buffer=1 ",
                  base_edges_within_a_texel =
                      "mesh.columns=8 mesh.rows=8 map.width=8 map.height=8 "
                      "tests.tex_coord=false tests.generation_limit=4 "
                      "tests.normal_threshold=0 tests.view_threshold=0 ";

/// Each test that a design may leave out, alone and beside the others; what could lose an edge's tests: units side by
/// side, full buffers, stalls, caches, triangles that spill. Random cases combine the rest.
const CaseTable designs(
    "the paper's mesh with ",
    {
        SettingsRow{"final edges", final_edges},
        {"cheap tests first", cheap_first},
        {"cheap tests and final edges, functional", cheap_first + final_edges + functional},
        {"cheap tests and final edges, three tests units", cheap_first + final_edges + "hardware.tests_units=3"},
        {"cheap tests and final edges, last in first out, buffers for one item",
         cheap_first + final_edges + small_buffers + "hardware.queue_order=lifo"},
        {"cheap tests and final edges, a queue of one place that spills, random stalls",
         cheap_first + final_edges + spills + random_stalls(3, 300, 20)},
        {"cheap tests and final edges, Highlight Test and culling", cheap_first + final_edges + highlight},
        {"cheap tests and final edges, no Normal Test", cheap_first + final_edges + "tests.normal=false"},
        {"cheap tests and final edges, no Summed Height Test", cheap_first + final_edges + "tests.summed_height=false"},
        {"sums over one texel from the map", one_texel},
        {"sums over one texel from the map, base edges within a texel", one_texel + base_edges_within_a_texel},
        {"sums over one texel from a slow map, three tests units, random stalls",
         one_texel + "hardware.tests_units=3 timing.displacement_map_latency=30 " + random_stalls(3, 300, 20)},
        {"sums over one texel from the map, no Summed Height Test", one_texel + "tests.summed_height=false"},
        {"all three options, functional", all_three + functional},
        {"all three options, a queue of one place that spills, banks that overlap rectangles",
         all_three + spills +
             "timing.summed_height_table_banks=8 timing.summed_height_table_interleave=xor "
             "timing.summed_height_table_window=12"},
        {"all tables behind caches", all_cached(4096)},
        {"caches of one line of one entry, a queue of one place that spills, random stalls",
         final_edges + all_cached(1, 1, 1) + spills + random_stalls(3, 300, 20)},
        {"families", families},
        {"families, functional", families + functional},
        {"families, one at a time, a queue of one place that spills",
         families + spills + "timing.pass_or_tessellate_buffer=1"},
        {"families, sums over one texel from the map, base edges within a texel",
         families + cheap_first + one_texel + base_edges_within_a_texel},
        {"families, nine lanes, three Normal Tests, last in first out, buffers for one item",
         lanes + small_buffers + "hardware.edge_lanes=9 hardware.normal_tests=3 hardware.queue_order=lifo"},
        {"families, two lanes, two Normal Tests, a queue of one place that spills, random stalls",
         lanes + spills + random_stalls(5, 300, 20) + "hardware.edge_lanes=2 hardware.normal_tests=2"},
        {"families, three lanes, Highlight Test and culling", lanes + highlight},
        {"families, three lanes, no Normal Test", lanes + "tests.normal=false"},
        {"families, three lanes, no Summed Height Test", lanes + "tests.summed_height=false"},
        {"families, three lanes, one family, caches of one line of one entry, a queue of one place that spills",
         modern + spills + all_cached(1, 1, 1) + "timing.pass_or_tessellate_buffer=1"},
        {"a bilinear filter, three tests units, random stalls",
         bilinear + "hardware.tests_units=3 " + random_stalls(3, 300, 20)},
        {"a bilinear filter, sums over one texel from the map", bilinear + one_texel + final_edges},
        {"a bilinear filter, banks of maps",
         bilinear + "timing.displacement_map_banks=4 timing.normal_map_banks=16 timing.normal_map_ports=2 "
                    "timing.normal_map_latency=7"},
        {"a bilinear filter, caches of one line of one entry, a queue of one place that spills, random stalls",
         bilinear + all_cached(1, 1, 1) + spills + random_stalls(3, 300, 20)},
        {"a bilinear filter, families, functional", bilinear + modern + functional},
        {"a bilinear filter, families, all tables behind caches, random stalls",
         bilinear + modern + all_cached(4096) + random_stalls(5, 300, 20)},
        {"three machines, functional", "hardware.machines=3 " + functional},
        {"three machines of families, three lanes, a queue of one place that spills, random stalls",
         "hardware.machines=3 " + modern + spills + random_stalls(7, 200, 15)},
        {"sixteen machines of families, three lanes", "hardware.machines=16 " + modern},
    },
    [](const SettingsRow& row) {
        const CheckedRun run(with_settings(timed_job(), row.settings));
        const Totals totals(run.simulation);
        REQUIRE(run.counts.edges_split > 1000);

        BareRecursion bare(run.setup);
        Expected expected{run.setup};
        bare.walk(expected);
        const bool summed_height = run.setup.registers.tests.summed_height_test;
        CHECK(2 * totals.counts.edges_tested == expected.edges);
        CHECK(totals.height_table_reads == (summed_height ? 6 * (expected.summed_height - expected.by_codes) : 0));
        if (expected.from_map && summed_height) {
            CHECK(expected.by_codes > 1000);
            CHECK((expected.families || expected.by_codes < expected.summed_height));  // else base edges have no codes
        }
        const std::uint64_t corners = (run.setup.design.tests_units == 1 ? 3 : 6) * run.setup.base_triangles.size();
        CHECK(2 * totals.normal_map_reads ==
              datapath::map_entry_count(run.setup.registers.formats) * (2 * corners + expected.normal));
        const Decisions::Counts& counts = totals.decided;
        CHECK(counts.split_by_both == expected.split_by_both);
        CHECK(counts.stopped_by_view_alone == expected.stopped_by_view_alone);
        CHECK(counts.stopped_by_several == expected.stopped_by_several);
        for (const auto& hosted : run.simulation.machines)
            CHECK(hosted->machine.pass_or_tessellate.counts().finished > 0);
    });

}  // namespace
