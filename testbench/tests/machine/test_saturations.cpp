#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "testbench/output/report/saturation_figures.h"
#include "testbench/tests/modules/datapath/datapath_reference.h"
#include "testbench/tests/support/bare_mesh.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/refusals.h"
#include "testbench/tests/support/timed_checks.h"

// Values that do not fit their format are counted as often as a recount in the test, in other integer widths, says.

using namespace tessera;
using namespace tessera::testing;
using datapath::Saturations;
using datapath::TrianglePass;

namespace {

/// Observes every decided pass.
class Watcher : public tlm::tlm_analysis_if<TrianglePass> {
  public:
    explicit Watcher(std::function<void(const TrianglePass&)> look) : look_(std::move(look)) {}
    void write(const TrianglePass& pass) override { look_(pass); }

  private:
    std::function<void(const TrianglePass&)> look_;
};

Saturations run_watched(const MachineSetup& setup, const std::function<void(const TrianglePass&)>& look) {
    Simulation simulation(setup, 1'000'000, 100'000);
    Watcher watcher(look);
    simulation.machine.pass_or_tessellate.decided.bind(watcher);
    run_timed(simulation);
    return simulation.machine.saturations();
}

Job small_job(const std::string& settings = "") {
    return with_settings(timed_job(), "map.width=32 map.height=32 tests.generation_limit=4 " + settings);
}

bool beyond(Wide value, const datapath::Format& format) {
    return value < format.lowest || value > format.highest;
}

/// Calls look(P, N, t, P', P's) for every vertex that the machine displaces on this pass.
template <class Look>
void for_each_displaced(const TrianglePass& pass, Look&& look) {
    for (std::size_t k = 0; k < 3; ++k) {
        const datapath::Vertex& v = pass.triangle.vertices[k];
        if ((pass.new_vertices >> k & 1) != 0)
            look(v.position, v.normal, v.texture, v.displaced, v.screen);
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const datapath::NewVertex& made = pass.new_vertex[k];
        look(made.position, pass.edges[k].normal, made.texture, made.displaced, made.screen);
    }
}

}  // namespace

TEST_CASE("saturations: the default job has none in any quantity") {
    const MachineSetup setup = setup_of(timed_job());
    Simulation simulation(setup, 1'000'000, 100'000);
    REQUIRE(simulation.run().empty());
    const auto figures = saturation_figures(setup, simulation.machine.saturations());
    CHECK(figures.size() == 12);
    for (const SaturationFigure& figure : figures) {
        INFO(figure.name);
        CHECK(figure.count == 0);
    }
    CHECK(saturations_text(figures) == "none");
    CHECK(saturation_warnings(figures).empty());
}

TEST_CASE("saturations: displaced positions are counted as with 128-bit integers") {
    MachineSetup setup = setup_of(small_job());
    datapath::Registers& r = setup.registers;
    r.displacement.bias = static_cast<std::int32_t>(r.formats.position.highest / 5 * 4);
    r.displacement.scale = static_cast<std::int32_t>(r.formats.position.highest / 3);
    std::uint64_t expected = 0, wrong = 0;
    const Saturations counted = run_watched(setup, [&](const TrianglePass& pass) {
        for_each_displaced(pass, [&](const auto& p, const auto& n, const auto& t, const auto& displaced, const auto&) {
            const auto texel = [&](std::uint32_t c, std::uint32_t size) {
                return std::min(c >> r.formats.texture.fraction, size - 1);
            };
            const Wide code = setup.map.code(texel(t.u, r.map.width), texel(t.v, r.map.height));
            const Wide height = nearest(r.displacement.scale * code, r.formats.displacement.bits) + r.displacement.bias;
            const auto count = [&](std::int32_t base, std::int32_t normal, std::int32_t machine) {
                const Wide exact = base + nearest(height * normal, r.formats.normal.fraction);
                expected += beyond(exact, r.formats.position) ? 1u : 0u;
                wrong += machine == clamped(exact, r.formats.position.lowest, r.formats.position.highest) ? 0u : 1u;
            };
            count(p.x, n.x, displaced.x);
            count(p.y, n.y, displaced.y);
            count(p.z, n.z, displaced.z);
        });
    });
    CHECK(expected > 50);
    CHECK(counted.displaced_position == expected);
    CHECK(wrong == 0);
}

TEST_CASE("saturations: screen positions are counted as with a division in doubles") {
    const MachineSetup setup =
        setup_of(small_job("formats.screen_bits=13 formats.screen_fraction=2 camera.eye=[0.2,-0.5,0.4]"));
    const datapath::TransformParameters& transform = setup.registers.transform;
    const datapath::Format& screen = setup.registers.formats.screen;
    std::uint64_t certain = 0, possible = 0;
    const Saturations counted = run_watched(setup, [&](const TrianglePass& pass) {
        for_each_displaced(pass, [&](const auto&, const auto&, const auto&, const auto& p, const auto& on_screen) {
            if (!on_screen.in_front)
                return;
            const auto along = [&](const std::array<std::int64_t, 4>& row) {
                return static_cast<double>(Wide{row[0]} * p.x + Wide{row[1]} * p.y + Wide{row[2]} * p.z + row[3]);
            };
            for (const auto& row : {transform.row_x, transform.row_y}) {
                const double exact =
                    std::ldexp(along(row) / along(transform.row_w), transform.exponent + screen.fraction);
                const double room = 0.5 + std::abs(exact) * 0x1p-28;
                const auto lowest = static_cast<double>(screen.lowest), highest = static_cast<double>(screen.highest);
                certain += exact > highest + 0.5 + room || exact < lowest - 0.5 - room ? 1u : 0u;
                possible += exact > highest + 0.5 - room || exact < lowest - 0.5 + room ? 1u : 0u;
            }
        });
    });
    CHECK(certain > 50);
    CHECK(counted.screen_position >= certain);
    CHECK(counted.screen_position <= possible);
    CHECK(possible - certain < certain / 20);
    CHECK(counted.total() == counted.screen_position);
    const auto warnings = saturation_warnings(saturation_figures(setup, counted));
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0], Catch::StartsWith("screen position: ") && Catch::Contains("formats.screen_bits"));
}

TEST_CASE("saturations: view distances are counted as with 128-bit integers") {
    MachineSetup setup = setup_of(small_job());
    datapath::Format& format = setup.registers.formats.view_distance;
    format.fraction = setup.registers.formats.position.fraction;  // more than the host would choose
    const auto& row = setup.registers.transform.row_w;
    const int shift =
        datapath::TransformParameters::matrix_fraction + setup.registers.formats.position.fraction - format.fraction;
    std::uint64_t expected = 0;
    const Saturations counted = run_watched(setup, [&](const TrianglePass& pass) {
        for_each_displaced(pass, [&](const auto&, const auto&, const auto&, const auto& p, const auto&) {
            const Wide w = Wide{row[0]} * p.x + Wide{row[1]} * p.y + Wide{row[2]} * p.z + row[3];
            expected += beyond(nearest(w, shift), format) ? 1u : 0u;
        });
    });
    CHECK(expected > 50);
    CHECK(counted.view_distance == expected);
}

// The host's normals have two integer bits, so that 1.0 fits: only a format with one saturates.
TEST_CASE("saturations: normals beyond a format of one integer bit are counted") {
    MachineSetup setup = setup_of(small_job("map.source=constant"));
    datapath::Formats& formats = setup.registers.formats;
    formats.normal = datapath::Format::make_signed(16, 15);
    for (datapath::Triangle& triangle : setup.base_triangles)
        for (datapath::Vertex& v : triangle.vertices) {
            v.normal = {0, 0, 32767};
            v.tangent = {32767, 0, 0};
        }
    Simulation simulation(setup, 1'000'000, 100'000);
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    // beyond what the registers hold, so that one component suffices
    setup.registers.transform.normal_rows = {{{0, 0, 32768}, {0, 1000, 0}, {0, 0, 60000}}};
    REQUIRE(simulation.run().empty());
    const Saturations counted = simulation.machine.saturations();
    const std::uint64_t edges = simulation.machine.edges_tested(), base = setup.base_triangles.size();
    // N_ij in two units, T_ij, N'_ij; N' of each base triangle's corners
    CHECK(counted.normal == 4 * edges + 3 * base);
    // 32767 * 60000 / 2^15 does not fit; 32767 * 32768 / 2^15 does
    CHECK(counted.screen_normal == simulation.machine.transform.normals());
    CHECK(counted.screen_normal == 3 * base);
}

TEST_CASE("saturations: zero vectors from opposite normals are counted") {
    MachineSetup setup = setup_of(small_job());
    for (datapath::Triangle& triangle : setup.base_triangles) {
        datapath::Direction& n = triangle.vertices[1].normal;
        n = {-n.x, -n.y, -n.z};
    }
    std::uint64_t expected = 0;
    const auto zero = [](const datapath::Direction& d) { return d == datapath::Direction{}; };
    const Saturations counted = run_watched(setup, [&](const TrianglePass& pass) {
        for (int k = 0; k < 3; ++k) {
            const datapath::Vertex &i = pass.edge_begin(k), &j = pass.edge_end(k);
            const datapath::EdgeTests& edge = pass.edges[static_cast<std::size_t>(k)];
            // the sum of the ends is 0 or rounds to 0: 1 / 2 is rounded down
            const auto mean_is_zero = [](const datapath::Direction& a, const datapath::Direction& b) {
                const auto none = [](std::int32_t s) { return s == 0 || s == 1; };
                return none(a.x + b.x) && none(a.y + b.y) && none(a.z + b.z);
            };
            expected += mean_is_zero(i.normal, j.normal) ? 2u : 0u;  // in two units
            expected += mean_is_zero(i.tangent, j.tangent) ? 1u : 0u;
            expected += zero(edge.displaced_normal) ? 1u : 0u;
        }
        for (std::size_t k = 0; k < 3; ++k)
            if ((pass.new_vertices >> k & 1) != 0)
                expected += zero(pass.triangle.vertices[k].displaced_normal) ? 1u : 0u;
    });
    CHECK(expected > 50);
    CHECK(counted.degenerate_normal == expected);
}

TEST_CASE("saturations: generations beyond their field are counted, with the Generation Test off") {
    // spilled triangles are packed: their values fit their fields
    const MachineSetup setup =
        setup_of(with_settings(full_split_job(1, 3),
                               "map.width=16 map.height=16 tests.generation=false formats.generation_bits=2 "
                               "hardware.queue_capacity=4"));
    std::uint64_t expected = 0;
    int deepest = 0;
    Simulation simulation(setup, 100'000, 100'000);
    Watcher watcher([&](const TrianglePass& pass) {
        for (int k = 0; k < 3; ++k) {
            const int oldest = std::max(pass.edge_begin(k).generation, pass.edge_end(k).generation);
            deepest = std::max(deepest, oldest);
            expected += (pass.split >> k & 1) != 0 && oldest == 3 ? 1u : 0u;
        }
    });
    simulation.machine.pass_or_tessellate.decided.bind(watcher);
    run_timed(simulation);
    CHECK(deepest == 3);
    CHECK(expected > 50);
    CHECK(simulation.machine.saturations().generation == expected);
    CHECK(simulation.machine.triangle_queue.spilled() > 0);

    const BareRun bare(setup);
    CHECK(bare.saturations.generation == expected);
    expect_mesh(simulation.monitor.mesh, bare.mesh);
}

TEST_CASE("saturations: vertices that fully face the light are counted") {
    const MachineSetup setup = setup_of(with_settings(
        timed_job(), "map.source=constant camera.eye=[0,-3,0] camera.target=[0,0,0] hardware.light=[0,0,1]"));
    Simulation simulation(setup, 1'000'000, 100'000);
    REQUIRE(simulation.run().empty());
    const Saturations counted = simulation.machine.saturations();
    CHECK(counted.intensity == 3 * setup.base_triangles.size());
    CHECK(counted.total() == counted.intensity);
    const auto figures = saturation_figures(setup, counted);
    CHECK(saturations_text(figures) == "intensity 54");
    CHECK(saturation_warnings(figures).empty());  // no width helps
    const auto notes = saturation_notes(figures);
    REQUIRE(notes.size() == 1);
    CHECK_THAT(notes[0],
               Catch::Contains("intensity: 54 values saturated") && Catch::Contains("no key widens Lighting's 8 bits"));
}

TEST_CASE("saturations: each has a remedy, a meaning or a remark of the setup") {
    for (const SaturationFigure& figure : saturation_figures(setup_of(small_job()), {})) {
        INFO(figure.name);
        CHECK((figure.remedy != nullptr || figure.meaning != nullptr) == (figure.name != std::string("input_texture")));
    }
}

TEST_CASE("saturations: texture coordinates beyond a clamped map are counted, with a remark of the setup") {
    const Job job = small_job();
    BaseMesh mesh = load_mesh(job);
    mesh.vertices.front().texture.x = -0.25;
    const HeightMap map = load_map(job);
    const MachineSetup setup = make_setup(resolve_job(job, mesh, map).job, mesh, map);
    const auto figures = saturation_figures(setup, {});
    CHECK(saturations_text(figures) == "input texture 1");
    CHECK(saturation_warnings(figures).empty());
    CHECK(saturation_notes(figures).empty());
    CHECK(std::count_if(setup.remarks.begin(), setup.remarks.end(), [](const std::string& remark) {
              return remark.find("set to the map's border") != std::string::npos &&
                     remark.find("map.address_u") != std::string::npos;
          }) == 1);
}

TEST_CASE("saturations: values that the host saturates are counted too") {
    // S is twice the range of a one-bit map: 2^(bits - 1), one LSB more than its register holds
    const MachineSetup setup =
        setup_of(small_job("formats.displacement_bits=1 tests.summed_height_threshold=2 displacement.scale=1 "
                           "displacement.bias=-0.5 mesh.width=0.5 mesh.depth=0.5"));
    CHECK(setup.registers.displacement.scale == setup.registers.formats.position.highest);
    CHECK(setup.input_saturations.registers == 1);
    CHECK(setup.input_saturations.position == 0);
    const auto warnings = saturation_warnings(saturation_figures(setup, {}));
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0], Catch::Contains("input register") && Catch::Contains("set formats.displacement_bits = 2"));
}

TEST_CASE("a threshold that its register rounds to 0 is refused with the register's step") {
    const auto error_of = [](const std::string& settings) {
        return input_error_of([&] { setup_of(with_settings({}, settings)); });
    };
    expect_refusals(
        {
            {"tests.normal_threshold=1e-5",
             {"tests.normal_threshold = 1e-05", "6.103515625e-05", "set it at least to that step"}},
            {"tests.highlight=true tests.highlight_normal_threshold=6e-5",
             {"tests.highlight_normal_threshold = 6e-05", "6.103515625e-05"}},
            {"tests.view_threshold=0.003", {"tests.view_threshold = 0.003", "0.00390625"}},
            {"tests.summed_height_threshold=3e-6",
             {"tests.summed_height_threshold", "set it to 0, or at least to that step"}},
            {"tests.summed_height_threshold=0.4 tests.summed_height_unit=area formats.displacement_bits=1",
             {"tests.summed_height_threshold = 0.4"}},
            {"tests.normal_threshold=6.103515625e-05", {}},
            {"tests.normal_threshold=0", {}},
            {"tests.highlight_normal_threshold=1e-5", {}},  // there is no such test
            {"tests.normal=false tests.normal_threshold=1e-5", {}},
        },
        error_of);
}
