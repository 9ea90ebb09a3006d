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

struct Row {
    std::string name;
    std::string settings;
};

const CaseTable designs(
    "the paper's mesh with ",
    {
        Row{"final edges", "hardware.final_edges=true"},
        {"final edges, functional", "hardware.final_edges=true mode=functional"},
        {"cheap tests first", "hardware.test_order=cheap_first"},
        {"cheap tests first, functional", "hardware.test_order=cheap_first mode=functional"},
        {"cheap tests and final edges", "hardware.test_order=cheap_first hardware.final_edges=true"},
        {"cheap tests and final edges, functional",
         "hardware.test_order=cheap_first hardware.final_edges=true mode=functional"},
        {"cheap tests and final edges, three tests units",
         "hardware.test_order=cheap_first hardware.final_edges=true hardware.tests_units=3"},
        {"cheap tests and final edges, last in first out, buffers for one item",
         "hardware.test_order=cheap_first hardware.final_edges=true hardware.queue_order=lifo "
         "timing.edges_in_sequence=1 timing.results_buffer=1 timing.pass_or_tessellate_buffer=1"},
        {"cheap tests and final edges, a queue of one place that spills",
         "hardware.test_order=cheap_first hardware.final_edges=true hardware.queue_capacity=1"},
        {"cheap tests and final edges, random stalls",
         "hardware.test_order=cheap_first hardware.final_edges=true timing.stalls_seed=3 "
         "timing.stalls_per_mille=300 timing.stalls_longest=20"},
        {"cheap tests and final edges, Highlight Test and culling",
         "hardware.test_order=cheap_first hardware.final_edges=true tests.highlight=true hardware.culling=back"},
        {"cheap tests and final edges, no Normal Test",
         "hardware.test_order=cheap_first hardware.final_edges=true tests.normal=false"},
        {"cheap tests and final edges, no Summed Height Test",
         "hardware.test_order=cheap_first hardware.final_edges=true tests.summed_height=false"},
        {"sums over one texel from the map", "hardware.one_texel_from_map=true"},
        {"sums over one texel from the map, functional", "hardware.one_texel_from_map=true mode=functional"},
        {"sums over one texel from the map, base edges within a texel",
         "hardware.one_texel_from_map=true mesh.columns=8 mesh.rows=8 map.width=8 map.height=8 tests.tex_coord=false "
         "tests.generation_limit=4 tests.normal_threshold=0 tests.view_threshold=0"},
        {"sums over one texel from a slow map, three tests units, random stalls",
         "hardware.one_texel_from_map=true hardware.tests_units=3 timing.displacement_map_latency=30 "
         "timing.stalls_seed=3 timing.stalls_per_mille=300 timing.stalls_longest=20"},
        {"all three options",
         "hardware.one_texel_from_map=true hardware.test_order=cheap_first hardware.final_edges=true"},
        {"all three options, functional",
         "hardware.one_texel_from_map=true hardware.test_order=cheap_first hardware.final_edges=true mode=functional"},
        {"all three options, three tests units, random stalls",
         "hardware.one_texel_from_map=true hardware.test_order=cheap_first hardware.final_edges=true "
         "hardware.tests_units=3 timing.stalls_seed=5 timing.stalls_per_mille=300 timing.stalls_longest=20"},
        {"sums over one texel from the map, no Summed Height Test",
         "hardware.one_texel_from_map=true tests.summed_height=false"},
        {"all tables behind caches",
         "timing.displacement_map_cache_bytes=4096 timing.normal_map_cache_bytes=4096 "
         "timing.summed_height_table_cache_bytes=8192"},
        {"all three options, all tables behind caches",
         "hardware.one_texel_from_map=true hardware.test_order=cheap_first hardware.final_edges=true "
         "timing.displacement_map_cache_bytes=4096 timing.normal_map_cache_bytes=4096 "
         "timing.summed_height_table_cache_bytes=8192"},
        {"all three options, all tables behind caches, functional",
         "hardware.one_texel_from_map=true hardware.test_order=cheap_first hardware.final_edges=true "
         "timing.displacement_map_cache_bytes=4096 timing.normal_map_cache_bytes=4096 "
         "timing.summed_height_table_cache_bytes=8192 mode=functional"},
        {"caches of one line of one entry, a queue of one place that spills, random stalls",
         "hardware.final_edges=true timing.displacement_map_cache_bytes=1 timing.normal_map_cache_bytes=1 "
         "timing.summed_height_table_cache_bytes=1 timing.displacement_map_line_bytes=1 timing.normal_map_line_bytes=1 "
         "timing.summed_height_table_line_bytes=1 timing.summed_height_table_cache_fills=1 "
         "hardware.queue_capacity=1 timing.stalls_seed=3 timing.stalls_per_mille=300 timing.stalls_longest=20"},
        {"families", "hardware.work=family"},
        {"families, functional", "hardware.work=family mode=functional"},
        {"families, one at a time, a queue of one place that spills",
         "hardware.work=family timing.pass_or_tessellate_buffer=1 hardware.queue_capacity=1"},
        {"families, random stalls",
         "hardware.work=family timing.stalls_seed=3 timing.stalls_per_mille=300 timing.stalls_longest=20"},
        {"families, cheap tests first", "hardware.work=family hardware.test_order=cheap_first"},
        {"families, sums over one texel from the map",
         "hardware.work=family hardware.test_order=cheap_first hardware.one_texel_from_map=true"},
        {"families, sums over one texel from the map, functional",
         "hardware.work=family hardware.test_order=cheap_first hardware.one_texel_from_map=true mode=functional"},
        {"families, sums over one texel from the map, base edges within a texel",
         "hardware.work=family hardware.test_order=cheap_first hardware.one_texel_from_map=true mesh.columns=8 mesh.rows=8 map.width=8 map.height=8 tests.tex_coord=false "
         "tests.generation_limit=4 tests.normal_threshold=0 tests.view_threshold=0"},
        {"families, three lanes",
         "hardware.work=family hardware.test_order=cheap_first hardware.one_texel_from_map=true hardware.edge_lanes=3"},
        {"families, three lanes, functional",
         "hardware.work=family hardware.test_order=cheap_first hardware.one_texel_from_map=true hardware.edge_lanes=3 mode=functional"},
        {"families, nine lanes, three Normal Tests, last in first out, buffers for one item",
         "hardware.work=family hardware.test_order=cheap_first hardware.one_texel_from_map=true hardware.edge_lanes=9 hardware.normal_tests=3 hardware.queue_order=lifo "
         "timing.edges_in_sequence=1 timing.results_buffer=1 timing.pass_or_tessellate_buffer=1"},
        {"families, two lanes, two Normal Tests, a queue of one place that spills, random stalls",
         "hardware.work=family hardware.test_order=cheap_first hardware.one_texel_from_map=true hardware.edge_lanes=2 hardware.normal_tests=2 hardware.queue_capacity=1 "
         "timing.stalls_seed=5 timing.stalls_per_mille=300 timing.stalls_longest=20"},
        {"families, three lanes, Highlight Test and culling",
         "hardware.work=family hardware.test_order=cheap_first hardware.one_texel_from_map=true hardware.edge_lanes=3 tests.highlight=true hardware.culling=back"},
        {"families, three lanes, no Normal Test",
         "hardware.work=family hardware.test_order=cheap_first hardware.one_texel_from_map=true hardware.edge_lanes=3 tests.normal=false"},
        {"families, three lanes, no Summed Height Test",
         "hardware.work=family hardware.test_order=cheap_first hardware.one_texel_from_map=true hardware.edge_lanes=3 tests.summed_height=false"},
        {"families, three lanes, all tables behind caches",
         "hardware.work=family hardware.test_order=cheap_first hardware.one_texel_from_map=true hardware.edge_lanes=3 timing.displacement_map_cache_bytes=4096 "
         "timing.normal_map_cache_bytes=4096 timing.summed_height_table_cache_bytes=8192"},
        {"families, three lanes, one family, caches of one line of one entry, a queue of one place that spills",
         "hardware.design=modern timing.pass_or_tessellate_buffer=1 hardware.queue_capacity=1 "
         "timing.displacement_map_cache_bytes=1 timing.normal_map_cache_bytes=1 timing.summed_height_table_cache_bytes=1 "
         "timing.displacement_map_line_bytes=1 timing.normal_map_line_bytes=1 timing.summed_height_table_line_bytes=1 "
         "timing.displacement_map_cache_fills=1 timing.normal_map_cache_fills=1 "
         "timing.summed_height_table_cache_fills=1"},
        {"a bilinear filter", "hardware.displacement_filter=bilinear"},
        {"a bilinear filter, functional", "hardware.displacement_filter=bilinear mode=functional"},
        {"a bilinear filter, three tests units, random stalls",
         "hardware.displacement_filter=bilinear hardware.tests_units=3 timing.stalls_seed=3 "
         "timing.stalls_per_mille=300 timing.stalls_longest=20"},
        {"a bilinear filter, sums over one texel from the map",
         "hardware.displacement_filter=bilinear hardware.one_texel_from_map=true hardware.final_edges=true"},
        {"a bilinear filter, banks of maps",
         "hardware.displacement_filter=bilinear timing.displacement_map_banks=4 timing.normal_map_banks=16 "
         "timing.normal_map_ports=2 timing.normal_map_latency=7"},
        {"a bilinear filter, caches of one line of one entry, a queue of one place that spills, random stalls",
         "hardware.displacement_filter=bilinear timing.displacement_map_cache_bytes=1 "
         "timing.normal_map_cache_bytes=1 timing.displacement_map_line_bytes=1 timing.normal_map_line_bytes=1 "
         "timing.displacement_map_cache_fills=1 timing.normal_map_cache_fills=1 hardware.queue_capacity=1 "
         "timing.stalls_seed=3 timing.stalls_per_mille=300 timing.stalls_longest=20"},
        {"a bilinear filter, families", "hardware.displacement_filter=bilinear hardware.design=modern"},
        {"a bilinear filter, families, functional",
         "hardware.displacement_filter=bilinear hardware.design=modern mode=functional"},
        {"a bilinear filter, families, all tables behind caches, random stalls",
         "hardware.displacement_filter=bilinear hardware.design=modern timing.displacement_map_cache_bytes=4096 "
         "timing.normal_map_cache_bytes=4096 timing.summed_height_table_cache_bytes=8192 timing.stalls_seed=5 "
         "timing.stalls_per_mille=300 timing.stalls_longest=20"},
        {"a bilinear filter, three machines of families, a queue of one place that spills",
         "hardware.displacement_filter=bilinear hardware.machines=3 hardware.design=modern "
         "hardware.queue_capacity=1"},
        {"a bilinear filter, Highlight Test and culling",
         "hardware.displacement_filter=bilinear tests.highlight=true hardware.culling=back"},
        {"three machines", "hardware.machines=3"},
        {"three machines, functional", "hardware.machines=3 mode=functional"},
        {"three machines of families, three lanes, a queue of one place that spills, random stalls",
         "hardware.machines=3 hardware.design=modern hardware.queue_capacity=1 timing.stalls_seed=7 "
         "timing.stalls_per_mille=200 timing.stalls_longest=15"},
        {"sixteen machines of families, three lanes, all tables behind caches",
         "hardware.machines=16 hardware.design=modern timing.displacement_map_cache_bytes=4096 "
         "timing.normal_map_cache_bytes=4096 timing.summed_height_table_cache_bytes=8192"},
        {"all three options, a queue of one place that spills",
         "hardware.one_texel_from_map=true hardware.test_order=cheap_first hardware.final_edges=true "
         "hardware.queue_capacity=1 timing.summed_height_table_banks=8 timing.summed_height_table_interleave=xor "
         "timing.summed_height_table_window=12"},
    },
    [](const Row& row) {
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
        const bool bilinear = run.setup.registers.formats.filter == datapath::MapFilter::bilinear;
        CHECK(2 * totals.normal_map_reads == (bilinear ? 4 : 1) * (2 * corners + expected.normal));
        const Decisions::Counts& counts = totals.decided;
        CHECK(counts.split_by_both == expected.split_by_both);
        CHECK(counts.stopped_by_view_alone == expected.stopped_by_view_alone);
        CHECK(counts.stopped_by_several == expected.stopped_by_several);
        if (run.setup.registers.formats.final_edges)
            CHECK(totals.counts.edges_tested == 3 * run.setup.base_triangles.size() + 4 * run.counts.edges_split);
        if (expected.families)
            CHECK(totals.counts.edges_tested == 3 * run.counts.finished);
        for (const auto& machine : run.simulation.machines)
            CHECK(machine->pipeline.pass_or_tessellate.counts().finished > 0);
    });

}  // namespace
