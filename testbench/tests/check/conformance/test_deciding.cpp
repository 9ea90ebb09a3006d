// Counts how often each test alone decided, and how many edges lie beside a texel's border. SystemC elaborates once per
// process, so each case runs one simulation.
#include <catch2/catch.hpp>
#include <cmath>

#include "testbench/check/conformance/golden_inputs.h"
#include "testbench/check/conformance/scoreboard.h"
#include "testbench/check/conformance/texel_borders.h"
#include "testbench/tests/support/timed_checks.h"

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

/// A plane of one quad over noise: two triangles, 6 edges. With thresholds of 0 the Normal Test and the Summed Height
/// Test ask to split every edge, and only generation 1 stops them.
Job one_quad() {
    Job job;
    job.mode = Mode::functional;
    job.mesh.columns = job.mesh.rows = 1;
    job.map.source = MapSource::noise;
    job.map.width = job.map.height = 64;
    job.tests.normal_threshold = 0;
    job.tests.threshold("summed_height_threshold") = 0;
    job.tests.view = false;
    job.tests.generation_limit = 1;
    return job;
}

Decisions::Counts counts_of(const Job& job) {
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000);
    REQUIRE(simulation.run().empty());
    const Decisions::Counts& counts = simulation.decisions.counts();
    CHECK(counts.split_by_normal + counts.split_by_summed_height + counts.split_by_both + counts.split_by_highlight ==
          simulation.machine.pass_or_tessellate.counts().edges_split);
    return counts;
}

void expect_split(const Decisions::Counts& c, std::uint64_t normal, std::uint64_t summed_height, std::uint64_t both) {
    CHECK(c.split_by_normal == normal);
    CHECK(c.split_by_summed_height == summed_height);
    CHECK(c.split_by_both == both);
}

void expect_stopped(const Decisions::Counts& c, std::uint64_t view, std::uint64_t tex_coord, std::uint64_t generation,
                    std::uint64_t several) {
    CHECK(c.stopped_by_view_alone == view);
    CHECK(c.stopped_by_tex_coord_alone == tex_coord);
    CHECK(c.stopped_by_generation_alone == generation);
    CHECK(c.stopped_by_several == several);
}

/// The expected counters, from the golden model's evaluations of the edges that the machine decided.
class GoldenCount : public tlm::tlm_analysis_if<datapath::TrianglePass> {
  public:
    explicit GoldenCount(const MachineSetup& setup) : inputs_(setup), dequantise_(setup.registers.formats) {}

    void write(const datapath::TrianglePass& pass) override {
        for (int k = 0; k < 3; ++k) {
            const golden::EdgeEvaluation e =
                golden::evaluate_edge(dequantise_.vertex(pass.edge_begin(k)), dequantise_.vertex(pass.edge_end(k)),
                                      inputs_.map, inputs_.parameters);
            if (e.split) {
                counts.split_by_normal += e.normal_test && !e.summed_height_test ? 1u : 0u;
                counts.split_by_summed_height += e.summed_height_test && !e.normal_test ? 1u : 0u;
                counts.split_by_both += e.normal_test && e.summed_height_test ? 1u : 0u;
                counts.split_by_highlight += !e.normal_test && !e.summed_height_test ? 1u : 0u;
            } else if (e.normal_test || e.summed_height_test || e.highlight_test) {
                const bool view = !e.view_test, tex_coord = !e.tex_coord_test, generation = !e.generation_test;
                counts.stopped_by_view_alone += view && !tex_coord && !generation ? 1u : 0u;
                counts.stopped_by_tex_coord_alone += tex_coord && !view && !generation ? 1u : 0u;
                counts.stopped_by_generation_alone += generation && !view && !tex_coord ? 1u : 0u;
                counts.stopped_by_several += int{view} + int{tex_coord} + int{generation} > 1 ? 1u : 0u;
            }
        }
    }

    Decisions::Counts counts;

  private:
    GoldenInputs inputs_;
    Dequantise dequantise_;
};

/// A pass with only its texture coordinates set: three ends, then the midpoints of edges 0-1, 1-2, 2-0.
datapath::TrianglePass pass_at(const std::array<datapath::TexCoord, 6>& t) {
    datapath::TrianglePass pass;
    for (std::size_t k = 0; k < 3; ++k) {
        pass.triangle.vertices[k].texture = t[k];
        pass.edges[k].texture = t[3 + k];
        pass.edges[k].evaluated = datapath::all_tests;
    }
    return pass;
}

}  // namespace

TEST_CASE("deciding: the Normal Test alone splits 6 edges, the Generation Test alone stops their 24 children") {
    Job job = one_quad();
    job.tests.summed_height = false;
    const auto counts = counts_of(job);
    expect_split(counts, 6, 0, 0);
    expect_stopped(counts, 0, 0, 24, 0);
}

TEST_CASE("deciding: the Summed Height Test alone") {
    Job job = one_quad();
    job.tests.normal = false;
    const auto counts = counts_of(job);
    expect_split(counts, 0, 6, 0);
    expect_stopped(counts, 0, 0, 24, 0);
}

TEST_CASE("deciding: with both tests on, neither decides alone") {
    const auto counts = counts_of(one_quad());
    expect_split(counts, 0, 0, 6);
    expect_stopped(counts, 0, 0, 24, 0);
}

TEST_CASE("deciding: the View Test alone stops 6 edges, all shorter than 4000 pixels") {
    Job job = one_quad();
    job.tests.view = true;
    job.tests.view_threshold = 4000;
    const auto counts = counts_of(job);
    expect_split(counts, 0, 0, 0);
    expect_stopped(counts, 6, 0, 0, 0);
}

TEST_CASE("deciding: View Test and Generation Test stop 6 edges together") {
    Job job = one_quad();
    job.tests.view = true;
    job.tests.view_threshold = 4000;
    job.tests.generation_limit = 0;
    const auto counts = counts_of(job);
    expect_split(counts, 0, 0, 0);
    expect_stopped(counts, 0, 0, 0, 6);
}

TEST_CASE("deciding: the Tex Coord Test alone stops all 96 edges of quads of one texel") {
    // Each midpoint lies in the texel of one end; the normal at the other end is that of another texel.
    Job job = one_quad();
    job.mesh.columns = job.mesh.rows = job.map.width = job.map.height = 4;
    job.map.address_u = job.map.address_v = Addressing::repeat;
    const auto counts = counts_of(job);
    expect_split(counts, 0, 0, 0);
    expect_stopped(counts, 0, 96, 0, 0);
}

TEST_CASE("deciding: the counters agree with the golden model's evaluations") {
    Job job;
    job.mode = Mode::functional;
    job.map.width = job.map.height = 96;
    job.tests.generation_limit = 8;
    job.tests.highlight = true;
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000);
    GoldenCount golden(setup);
    const GoldenInputs inputs(setup);
    Scoreboard scoreboard(setup.registers, inputs);
    simulation.machine.pass_or_tessellate.decided.bind(golden);
    simulation.machine.pass_or_tessellate.decided.bind(scoreboard);
    REQUIRE(simulation.run().empty());
    REQUIRE(scoreboard.result().flipped_edges == 0);

    const auto& counts = simulation.decisions.counts();
    expect_split(golden.counts, counts.split_by_normal, counts.split_by_summed_height, counts.split_by_both);
    CHECK(golden.counts.split_by_highlight == counts.split_by_highlight);
    expect_stopped(golden.counts, counts.stopped_by_view_alone, counts.stopped_by_tex_coord_alone,
                   counts.stopped_by_generation_alone, counts.stopped_by_several);
    // The job is a useful test only if no counter stays zero.
    CHECK(counts.split_by_normal > 0);
    CHECK(counts.split_by_summed_height > 0);
    CHECK(counts.split_by_both > 0);
    CHECK(counts.split_by_highlight > 0);
    CHECK(counts.stopped_by_view_alone > 0);
    CHECK(counts.stopped_by_tex_coord_alone > 0);
    CHECK(counts.stopped_by_generation_alone > 0);
    CHECK(counts.stopped_by_several > 0);
}

TEST_CASE("texel borders: edges with an end or a midpoint one LSB below a border are counted, once each") {
    const datapath::Formats formats;  // 12 fraction bits: a texel is 4096
    const auto below = [&](const std::array<datapath::TexCoord, 6>& t) {
        TexelBorders borders(formats);
        borders.write(pass_at(t));
        CHECK(borders.count().edges == 3);
        return borders.count().below;
    };
    const datapath::TexCoord on{4096, 8192}, above{4097, 8193}, inside{2048, 6000};
    const datapath::TexCoord left{4095, 6000}, under{6000, 8191}, corner{8191, 8191}, two_below{4094, 4094};
    CHECK(below({on, above, inside, on, above, inside}) == 0);
    CHECK(below({on, on, on, left, on, on}) == 1);
    CHECK(below({on, on, on, on, under, on}) == 1);
    CHECK(below({corner, on, on, on, on, on}) == 2);  // this vertex is an end of two edges
    CHECK(below({corner, on, on, left, on, on}) == 2);
    CHECK(below({on, on, on, two_below, on, on}) == 0);

    datapath::TrianglePass pass = pass_at({on, on, on, left, left, on});
    pass.edges[0].evaluated = 0;  // a final edge: not tested
    pass.triangle.final_edges = 1;
    TexelBorders borders(formats);
    borders.write(pass);
    CHECK(borders.count().edges == 2);
    CHECK(borders.count().below == 1);
}

TEST_CASE("texel borders: the limit is one per cent of the edges and twice the rate by chance") {
    CHECK_FALSE(TexelBorderCount{12, 0, 0}.many());
    CHECK_FALSE(TexelBorderCount{12, 1000, 10}.many());
    CHECK(TexelBorderCount{12, 1000, 11}.many());
    // 6 values of 2^6 are 9.4 %, twice that 18.8 %
    CHECK_FALSE(TexelBorderCount{6, 1000, 187}.many());
    CHECK(TexelBorderCount{6, 1000, 188}.many());
}

TEST_CASE("texel borders: the warning names the next map size and number of quads that avoid them") {
    const TexelBorderCount few{12, 1000, 10}, many{12, 1000, 148};
    Job job;
    CHECK(texel_borders_warning(few, job, 256, 256).empty());
    const std::string built_in = texel_borders_warning(many, job, 256, 256);
    CHECK_THAT(built_in, Contains("148 of 1000 edges (14.8 %)") &&
                             Contains("map.width = 264 (a multiple of 3 quads), or mesh.columns = 4") &&
                             Contains("map.height = 264 (a multiple of 3 quads), or mesh.rows = 4"));
    job.mesh.columns = 7;
    job.mesh.rows = 8;  // divides the map's height
    const std::string one_axis = texel_borders_warning(many, job, 100, 100);
    CHECK_THAT(one_axis, Contains("map.width = 112 (a multiple of 7 quads), or mesh.columns = 8") && !Contains("rows"));
    job.mesh = {};
    for (const MeshSource source : {MeshSource::cylinder, MeshSource::sphere}) {
        job.mesh.source = source;  // 32 quads a side for every map
        CHECK(texel_borders_warning(many, job, 264, 100).empty());
    }
    job.mesh.columns = 30;  // the next multiple of 240, 4320, exceeds the largest map
    CHECK_THAT(texel_borders_warning(many, job, 4096, 100), Contains("map.width = 4080 (a multiple of 30 quads)"));
    job.mesh.columns = 600;  // so does 4800; the limit is 2048 quads, and 512 divides the map
    job.formats.texture_fraction = 0;
    job.mesh.rows = 1;
    CHECK_THAT(texel_borders_warning(many, job, 512, 100),
               Contains("Use mesh.columns = 512 for a map of 512 texels") && !Contains("map.width"));
    job.formats.texture_fraction = 12;
    job.mesh.columns = 7;
    job.mesh.rows = 8;
    job.map.source = MapSource::file;  // a file has a fixed size
    CHECK_THAT(texel_borders_warning(many, job, 100, 100),
               Contains("Use mesh.columns = 8 for a map of 100 texels") && !Contains("map.width"));
    CHECK(texel_borders_warning(many, job, 700, 100).empty());  // the quads divide both sides
    job.mesh.source = MeshSource::file;                         // a file has fixed coordinates, in decimals
    CHECK(texel_borders_warning({12, 1000, 200}, job, 100, 50).empty());
    CHECK_THAT(texel_borders_warning({12, 1000, 201}, job, 100, 50), Contains("multiples of 1/100 and 1/50"));
}
