#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "testbench/check/conformance/end_to_end.h"
#include "testbench/check/conformance/scoreboard.h"
#include "testbench/check/mesh/invariants.h"
#include "testbench/common/error.h"
#include "testbench/explore/widths/widths_report.h"
#include "testbench/tests/support/timed_checks.h"

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

Job small_job() {
    Job job;
    job.mode = Mode::functional;
    job.map.width = job.map.height = 48;
    job.displacement.scale = 0.25;
    job.tests.generation_limit = 6;
    return job;
}

Job sphere_job() {
    Job job = small_job();
    job.mesh.source = MeshSource::sphere;
    job.mesh.columns = 8;
    job.mesh.rows = 6;
    job.map.address_u = Addressing::repeat;
    job.displacement.scale = 0.1;
    job.tests.threshold("summed_height_threshold") = 2;  // with 2 displacement bits a step of its register is 1 / 12
    return job;
}

WidthSweep sweep(const Job& job, const std::vector<SweptQuantity>& swept, unsigned threads = 1,
                 std::optional<double> flips = {}, std::optional<double> error = {}) {
    const auto [mesh, map, resolved] = load_inputs(job);
    const WidthRequest request{resolved.job, swept, threads, flips, error};
    return sweep_widths(request, mesh, map, [](const std::string&, double) {});
}

WidthTable table_of(const Job& job, const char* quantity, std::vector<std::int64_t> widths) {
    return sweep(job, {{find_quantity(quantity), std::move(widths)}}).tables.front();
}

WidthRun run_of(const Job& job) {
    const auto [mesh, map, resolved] = load_inputs(job);
    return run_widths(make_setup(resolved.job, mesh, map), ExactModel(resolved.job, mesh, map), 1'000'000);
}

/// Compares every figure that `tessera run` has, too.
void expect_the_simulation_figures(const Job& job) {
    const WidthRun run = run_of(job);
    const MachineSetup setup = setup_of(job);
    const GoldenInputs golden(setup);
    Scoreboard scoreboard(setup.registers, golden);
    Simulation simulation(setup, 1'000'000);
    simulation.pipeline.pass_or_tessellate.decided.bind(scoreboard);
    REQUIRE(simulation.run().empty());
    EmittedMesh& mesh = simulation.monitor.mesh;
    mesh.sort();
    const ConformanceResult conformance = scoreboard.result();
    const InvariantResult invariants = check_invariants(mesh, setup);
    const EndToEndResult end_to_end = compare_end_to_end(setup, golden, mesh);

    CHECK(run.triangles == mesh.triangles.size());
    CHECK(run.edges == simulation.pipeline.edges_tested());
    CHECK(run.edges_split == simulation.pipeline.pass_or_tessellate.counts().edges_split);
    CHECK(run.conformance.edges == conformance.edges);
    CHECK(run.conformance.base_vertices == conformance.base_vertices);
    CHECK(run.conformance.flipped_edges == conformance.flipped_edges);
    CHECK(run.conformance.mismatches == conformance.mismatches);
    REQUIRE(run.conformance.tests.size() == conformance.tests.size());
    for (std::size_t k = 0; k < conformance.tests.size(); ++k) {
        INFO(conformance.tests[k].name);
        CHECK(run.conformance.tests[k].allowed_flips == conformance.tests[k].allowed_flips);
        CHECK(run.conformance.tests[k].compared == conformance.tests[k].compared);
    }
    CHECK(run.invariants.cracks == invariants.cracks);
    CHECK(run.invariants.violations() == invariants.violations());
    CHECK(run.invariants.collapsed == invariants.collapsed);
    CHECK(run.end_to_end.golden_triangles == end_to_end.golden_triangles);
    CHECK(run.end_to_end.hardware_to_golden.max_model == end_to_end.hardware_to_golden.max_model);
    const datapath::Saturations counted = simulation.pipeline.saturations();
    CHECK(run.saturations.displaced_position == counted.displaced_position);
    CHECK(run.saturations.normal == counted.normal);
    CHECK(run.saturations.screen_position == counted.screen_position);
    CHECK(run.saturations.view_distance == counted.view_distance);
    CHECK(run.saturations.degenerate_normal == counted.degenerate_normal);
    CHECK(run.saturations.generation == counted.generation);
    CHECK(run.saturations.intensity == counted.intensity);
}

}  // namespace

TEST_CASE("widths: a row's figures are the simulation's, narrow normals and positions") {
    Job job = small_job();
    job.formats.normal_bits = 8;
    job.formats.normal_fraction = 6;
    job.formats.position_bits = 14;
    job.formats.position_fraction = 3;
    const WidthRun run = run_of(job);
    CHECK(run.conformance.flipped_edges > 0);
    CHECK(run.flips_of(Decided::normal) > run.conformance.flipped_edges / 10);
    expect_the_simulation_figures(job);
}
TEST_CASE("widths: a row's figures are the simulation's, a screen that saturates and culling") {
    Job job = small_job();
    job.formats.screen_bits = 13;
    job.formats.screen_fraction = 2;
    job.camera.eye = {0.2, -0.5, 0.4};
    job.hardware.culling = Culling::back;
    job.tests.highlight = true;
    CHECK(run_of(job).saturations.screen_position > 0);
    expect_the_simulation_figures(job);
}
TEST_CASE("widths: a row's figures are the simulation's, full light") {
    Job job = small_job();
    job.map.source = MapSource::constant;
    job.camera.eye = {0, -3, 0};
    job.camera.target = {0, 0, 0};
    job.hardware.light = {0, 0, 1};
    CHECK(run_of(job).saturations.intensity == 54);
    Job culled = job;
    culled.hardware.culling = Culling::back;  // seen edge-on everywhere: nothing is lit
    CHECK(run_of(culled).saturations.intensity == 0);
    expect_the_simulation_figures(job);
}
TEST_CASE("widths: a row's figures are the simulation's, a sphere of few texture bits") {
    Job job = sphere_job();
    job.formats.texture_fraction = 2;
    job.formats.displacement_bits = 5;
    expect_the_simulation_figures(job);
}

TEST_CASE("widths: values that the formats hold exactly give the results of exact arithmetic") {
    // a plane of 4 x 4 quads on 64 texels: all coordinates are dyadic, and on a constant map no normal is rounded
    Job job = small_job();
    job.mesh.columns = job.mesh.rows = 4;
    job.map.source = MapSource::constant;
    job.map.value = 0;
    job.map.width = job.map.height = 64;
    job.tests.normal_threshold = 0;
    job.tests.threshold("summed_height_threshold") = 0;
    const WidthRun whole = run_of(job);
    CHECK(whole.position_max == 0);
    for (const std::uint64_t flips : whole.flips)
        CHECK(flips == 0);

    // heights of one bit: 0 and full scale are exact, one half is not
    job.map.source = MapSource::ramp;
    job.tests.normal_threshold = 0.12;
    job.formats.displacement_bits = 1;
    const WidthRun steps = run_of(job);
    CHECK(steps.position_max > 0.1 * job.displacement.scale);
    CHECK(steps.position_max <= 0.5 * job.displacement.scale * (1 + 1e-6));
}

TEST_CASE("widths: on a flat surface a position's error is the midpoint's rounding") {
    Job job = small_job();
    job.displacement.scale = 0;
    job.displacement.bias = 0;
    job.formats.position_bits = 12;
    job.formats.position_fraction = 2;
    job.tests.threshold("summed_height_threshold") = 0.05;
    const WidthRun run = run_of(job);
    REQUIRE(run.edges_split > 20);
    // every generation rounds down by at most half an LSB per axis: E_g <= (E_i + E_j) / 2 + 1/2
    const double generations = static_cast<double>(job.tests.generation_limit);
    CHECK(run.position_max > 0);
    CHECK(run.position_max <= run.position_lsb * std::sqrt(2.0) * (0.5 + 0.5 * generations));
    CHECK(run.position_rms <= run.position_max);
}

TEST_CASE("widths: more bits give less error and fewer flips") {
    const WidthTable normals = table_of(sphere_job(), "normal", {18, 14, 10, 7});
    const WidthTable positions = table_of(sphere_job(), "position", {32, 24, 18, 12});
    for (std::size_t k = 1; k < 4; ++k) {
        INFO(k);
        CHECK(normals.rows[k].run.flips_of(Decided::normal) > normals.rows[k - 1].run.flips_of(Decided::normal));
        CHECK(positions.rows[k].run.position_rms >= positions.rows[k - 1].run.position_rms);
    }
    CHECK(positions.rows[3].run.position_rms > 10 * positions.rows[0].run.position_rms);
    const WidthTable codes = table_of(sphere_job(), "displacement", {16, 8, 4, 2});
    for (std::size_t k = 1; k < 4; ++k)
        CHECK(codes.rows[k].run.position_rms > codes.rows[k - 1].run.position_rms);
    for (const WidthTable* const table : {&normals, &positions, &codes})
        for (const WidthRow& row : table->rows) {
            CHECK(row.refused.empty());
            CHECK(row.run.conformance.mismatches == 0);
            CHECK(row.run.invariants.passed());
        }
}

TEST_CASE("widths: refused widths keep their row, with the reason") {
    Job job = small_job();
    job.formats.generation_bits = 4;
    const WidthTable generations = table_of(job, "generation", {4, 3, 2});
    CHECK(generations.rows[0].refused.empty());
    CHECK(generations.rows[0].of_the_job);
    CHECK(generations.rows[1].refused.empty());
    CHECK_THAT(generations.rows[2].refused, Contains("tests.generation_limit") && Contains("formats.generation_bits"));
    const WidthTable texture = table_of(job, "texture", {13, 12, 11});
    CHECK_THAT(texture.rows[2].refused, Contains("formats.texture_fraction") && Contains("-1"));
    const WidthTable normals = table_of(job, "normal", {19, 18, 6, 5});
    CHECK_THAT(normals.rows[0].refused, Contains("formats.normal_bits") && Contains("19"));
    CHECK_THAT(normals.rows[3].refused, Contains("formats.normal_bits"));
    const WidthTable screen = table_of(job, "screen", {16, 15, 8});
    CHECK(screen.rows[0].refused.empty());
    CHECK(screen.rows[0].fraction == 0);
    CHECK_THAT(screen.rows[1].refused, Contains("formats.screen_bits = 24") &&
                                           Contains("formats.screen_fraction = 8") && Contains("16 integer bits") &&
                                           Contains("screen_range"));
    const WidthTable range = table_of(job, "screen_range", {9, 8});
    CHECK_THAT(range.rows[1].refused, Contains("reaches only 0 pixels"));
    const std::string csv = widths_csv({0, {normals, screen}, {}});
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 8);
    CHECK_THAT(csv, Contains("out of range"));
}

TEST_CASE("widths: the knee is the narrowest width that, with all wider ones, meets all limits") {
    Job job = sphere_job();
    job.check.allowed_flips = 100;
    const std::vector<SweptQuantity> swept{{find_quantity("normal"), {18, 15, 12, 9, 7}}};
    const auto knee = [&](std::optional<double> flips, std::optional<double> error) {
        return sweep(job, swept, 1, flips, error).tables.front();
    };
    const WidthTable anything = knee(100.0, 1e9);
    REQUIRE(anything.knee.row);
    CHECK(*anything.knee.row == 4);
    CHECK_FALSE(knee(100.0, 0.0).knee.row);
    // with the third row's own figures as limits the knee is the third row
    const WidthRun& third = anything.rows[2].run;
    REQUIRE(anything.rows[3].run.split_flips_percent() > third.split_flips_percent());
    const WidthTable at_third = knee(third.split_flips_percent(), 1e9);
    REQUIRE(at_third.knee.row);
    CHECK(*at_third.knee.row == 2);
    CHECK(at_third.knee.flips_given);
    // a run at the next width would fail
    const ConformanceResult& local = anything.rows[2].run.conformance;
    REQUIRE(anything.rows[3].run.conformance.flips_percent() > local.flips_percent());
    job.check.allowed_flips = local.flips_percent();
    CHECK(*knee(100.0, 1e9).knee.row == 2);
    job.check.allowed_flips = 100;
    const WidthTable relative = knee({}, {});
    CHECK(relative.knee.most_flips == anything.rows[0].run.split_flips_percent() + 0.5);
    WidthRequest request{job, swept, 1, {}, {}};
    const WidthSweep none{0, {knee(100.0, 0.0)}, {}};
    CHECK_THAT(widths_text(request, none), Contains("knee: none; even the widest"));
    CHECK_THAT(widths_text(request, {0, {at_third}, {}}), Contains("knee: 12 bits, 10 of them fraction"));
}

TEST_CASE("widths: the output is the same with any number of threads") {
    const std::vector<SweptQuantity> swept{{find_quantity("normal"), {16, 12, 8}},
                                           {find_quantity("screen_range"), {24, 16, 11}}};
    WidthRequest request{small_job(), swept, 1, {}, {}};
    const WidthSweep one = sweep(small_job(), swept, 1), three = sweep(small_job(), swept, 3);
    CHECK(widths_csv(one) == widths_csv(three));
    CHECK(widths_json(request, one) == widths_json(request, three));
    CHECK(widths_text(request, one) == widths_text(request, three));
    CHECK(one.exact_triangles > 18);
    CHECK(nlohmann::json::parse(widths_json(request, one)).at("quantities").at("normal").at("rows").size() == 3);
}

TEST_CASE("widths: a sweep lists its widths from the widest, the job's own included") {
    for (const Quantity& quantity : quantities()) {
        INFO(quantity.name);
        Job::Formats formats;
        formats.position_bits = 31;
        formats.position_fraction = 15;
        const std::vector<std::int64_t> widths = usual_widths(quantity, formats);
        CHECK(std::is_sorted(widths.rbegin(), widths.rend()));
        CHECK(widths.size() > 1);
        CHECK(widths.size() <= 17);
        if (quantity.bits(formats) != 0)  // 0: the Summed Height Table's width is chosen automatically
            CHECK(std::count(widths.begin(), widths.end(), quantity.bits(formats)) == 1);
        for (const std::int64_t bits : widths) {
            Job::Formats changed = formats;
            CHECK(quantity.set(changed, bits).empty());
            CHECK(quantity.bits(changed) == bits);
        }
    }
    CHECK(find_quantity("normals") == nullptr);
}

TEST_CASE("widths: base triangles that collapse in a narrow format are left out on both sides") {
    Job job = small_job();
    job.mesh.columns = 200;
    job.mesh.rows = 1;
    job.tests.generation_limit = 1;
    job.formats.position_bits = 8;
    job.formats.position_fraction = 2;
    job.formats.texture_fraction = 0;
    const MachineSetup setup = setup_of(job);
    REQUIRE(setup.base_dropped > 0);
    const auto [mesh, map, resolved] = load_inputs(job);
    const ExactModel exact(resolved.job, mesh, map);
    const auto corners = exact.corners_of(setup);
    REQUIRE(corners.size() == setup.base_triangles.size());
    const WidthRun run = run_widths(setup, exact, 1'000'000);
    // P' of a wrong triangle would be at least a column away; rounding moves it by less than this
    CHECK(run.position_max < 1.0);
    for (std::size_t k = 0; k < corners.size(); ++k)
        for (std::size_t c = 0; c < 3; ++c) {
            const double lsb = run.position_lsb;
            const glm::dvec3 rounded = setup.model_scale.to_model(
                Dequantise(setup.registers.formats).position(setup.base_triangles[k].vertices[c].position));
            CHECK(glm::length(rounded - exact.model_scale().to_model(corners[k][c].position)) < 2 * lsb);
        }
}
