#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "modules/datapath/rank.h"
#include "testbench/input/mesh/built_in.h"
#include "testbench/machine/resolve_job.h"
#include "testbench/setup/mesh/smooth_normals.h"
#include "testbench/setup/mesh/tangent_frames.h"
#include "testbench/setup/mesh/texture_scale.h"
#include "testbench/setup/tables/rank_table.h"
#include "testbench/tests/setup/tables/refined_mesh.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/checked_run.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/source_folder.h"

// Every height test on base meshes of every kind, in one of both designs and modes: closed, the bare recursion's mesh bit
// for bit, every decision golden's within its bound. The set-up reports what the Rank Test cannot do.

using namespace tessera;
using namespace tessera::testing;

namespace {

/// Quads over the whole map, with inner lines at no multiple of a texel.
BaseMesh plane_off_the_lattice() {
    BaseMesh mesh = make_plane(4, 3, 2, 2);
    for (BaseVertex& vertex : mesh.vertices) {
        for (const int axis : {0, 1}) {
            double& t = vertex.texture[axis];
            t += 0.2 * t * t * (1 - t);  // 0 and 1 do not move
            vertex.position[axis] = 2 * t - 1;
        }
    }
    return mesh;
}

/// Six faces, each with the whole map, rotated by quarter turns, so that their triangles conflict on its texels.
BaseMesh cube() {
    BaseMesh mesh;
    for (std::uint32_t face = 0; face < 6; ++face) {
        const int axis = static_cast<int>(face % 3), side = face < 3 ? 1 : -1;
        for (std::uint32_t corner = 0; corner < 4; ++corner) {
            const auto square = [](std::uint32_t k) { return glm::dvec2(k == 1 || k == 2 ? 1 : 0, k >= 2 ? 1 : 0); };
            const glm::dvec2 at = square(corner) * 2.0 - 1.0;
            BaseVertex vertex;
            vertex.position[axis] = side;
            vertex.position[(axis + 1) % 3] = side * at.x;
            vertex.position[(axis + 2) % 3] = at.y;
            vertex.normal = glm::normalize(vertex.position);
            vertex.texture = square((corner + face) % 4);
            mesh.vertices.push_back(vertex);
        }
        const std::uint32_t a = 4 * face;
        mesh.triangles.push_back({a, a + 1, a + 2});
        mesh.triangles.push_back({a, a + 2, a + 3});
    }
    complete_tangent_frames(mesh);
    measure_texture_scale(mesh);
    return mesh;
}

struct Base {
    std::string name, settings;
    bool closed;              ///< no seam of its texture coordinates but where the map repeats
    std::string rank_remark;  ///< what the setup says of it to the Rank Test; empty: nothing
    BaseMesh (*mesh)() = nullptr;
};

const std::array bases{
    Base{"a cylinder whose seam is a period of the map",
         "mesh.source=cylinder mesh.columns=8 mesh.rows=2 map.width=32 map.height=8 map.address_u=repeat", true,
         "errors of up to"},
    Base{"a cylinder whose quads are not whole texels",
         "mesh.source=cylinder mesh.columns=6 mesh.rows=2 map.width=26 map.height=9 map.address_u=repeat", true,
         "never split"},
    Base{"a sphere", "mesh.source=sphere mesh.columns=8 mesh.rows=4 map.width=32 map.height=16 map.address_u=repeat",
         false, "errors of up to"},
    Base{"a plane off the lattice", "map.width=24 map.height=20", true, "never split", plane_off_the_lattice},
    Base{"a plane that can be halved once", "mesh.columns=2 mesh.rows=2 map.width=20 map.height=12", true,
         "errors of up to"},
    Base{"a cube with the whole map on each face", "map.width=16 map.height=16", false, "share a texel", cube},
    Base{"the teapot",
         "mesh.source=file mesh.file=teapot.obj map.width=8 map.height=8 map.address_u=repeat map.address_v=repeat",
         false, "errors of up to"},
    Base{"a lattice whose spacing divides the periods",
         "mesh.source=lattice mesh.spacing=8 map.width=24 map.height=16 map.address_u=repeat map.address_v=repeat",
         true, ""},
    Base{"a lattice whose spacing does not divide the periods",
         "mesh.source=lattice mesh.spacing=8 map.width=22 map.height=13 map.address_u=repeat map.address_v=repeat",
         true, "share a texel"},
};

struct Named {
    const char *name, *settings;
};

constexpr std::array height_tests{
    Named{"Summed Height Test", "tests.summed_height_threshold=0.2"},
    Named{"Mipmap Test", "hardware.height_test=mipmap"},
    Named{"Curvature Test", "hardware.height_test=curvature"},
    Named{"Rank Test", "hardware.height_test=rank hardware.triangulation=greatest_rank"},
    Named{"Bound Test",
          "hardware.height_test=rank hardware.triangulation=greatest_rank formats.rank_bits=0 "
          "formats.bound_bits=10 tests.bound_threshold=0.03"},
    Named{"Rank and Bound Test, all edges cut at once",
          "hardware.height_test=rank formats.bound_bits=10 tests.bound_threshold=0.03"},
};

constexpr std::array designs{
    Named{"the paper's design", ""},
    Named{"the modern design", "hardware.design=modern"},
    Named{"the modern design, functional", "hardware.design=modern mode=functional"},
};

MachineSetup setup_on(const Base& base, const std::string& settings) {
    Job job =
        with_settings(timed_job(), "map.source=noise tests.normal=false tests.view=false displacement.scale=0.1 " +
                                       base.settings + ' ' + settings);
    job.mesh.path = (source_folder() / "testbench/examples/jobs" / job.mesh.file).string();
    if (base.mesh == nullptr)
        return setup_of(job);
    const BaseMesh mesh = base.mesh();
    const HeightMap map = load_map(job);
    return make_setup(resolve_job(job, mesh, map).job, mesh, map);
}

/// Whether edges are cut in the host's order of ranks, so that a bound holds.
bool keeps_order(const datapath::Registers& registers) {
    return registers.triangulation == Triangulation::greatest_rank;
}

/// Requires the set-up's remarks about the base mesh and the bound, and no others about the height test.
void check_remarks(const Base& base, const CheckedRun& run) {
    const datapath::Registers& registers = run.setup.registers;
    std::string of_base, of_bound;
    for (const std::string& remark : run.setup.remarks) {
        if (remark.find("the Rank Test") != std::string::npos)
            of_base += remark;
        if (remark.find(" is not guaranteed") != std::string::npos)
            of_bound += remark;
    }
    INFO(of_base << '\n' << of_bound);
    if (registers.formats.height_test != HeightTest::rank || base.rank_remark.empty())
        CHECK(of_base.empty());
    else
        CHECK_THAT(of_base, Catch::Contains(base.rank_remark) && Catch::Contains("support any base mesh"));
    CHECK(of_bound.empty() ==
          (registers.formats.bound_bits == 0 || (keeps_order(registers) && base.rank_remark.empty())));
}

/// No grid point is farther from the mesh, along the normal, than the threshold or the error that the set-up reports.
void check_bound(const CheckedRun& run) {
    const MachineSetup& setup = run.setup;
    const datapath::Formats& formats = setup.registers.formats;
    if (formats.height_test != HeightTest::rank || formats.bound_bits == 0 || setup.rank_tables.clashes > 0 ||
        !keeps_order(setup.registers))
        return;
    std::vector<TextureTriangle> triangles;
    for (const EmittedTriangle& t : run.mesh.triangles)
        triangles.push_back({t.corners[0].texture, t.corners[1].texture, t.corners[2].texture});
    const double largest =
        tables_test::error_figures(tables_test::vertical_errors(setup.map, triangles, formats.texture.fraction))
            .largest;
    const double bound =
        bound_error(static_cast<std::uint32_t>(setup.registers.tests.height_thresholds[datapath::bound_number]),
                    formats.bound_bits);
    CHECK(largest <= std::max(bound, setup.rank_tables.least_error) + 1e-6);
}

void run_on(const Base& base, const Named& test, const Named& design) {
    const CheckedRun run(setup_on(base, std::string(test.settings) + ' ' + design.settings));
    const bool rank = run.setup.registers.formats.height_test == HeightTest::rank;
    if (rank && base.rank_remark == "never split")
        CHECK(run.counts.edges_split == 0);
    else
        CHECK(run.counts.edges_split >= 8);
    if (base.closed)
        run.expect_closed_in_texture();
    check_remarks(base, run);
    check_bound(run);
}

struct Row {
    std::string name;
    const Base* base;
    Named test, design;
};

/// Each test on each base mesh once, each base mesh and each test in every design.
std::vector<Row> every_pair() {
    std::vector<Row> rows;
    for (std::size_t b = 0; b < bases.size(); ++b)
        for (std::size_t t = 0; t < height_tests.size(); ++t) {
            const Named &test = height_tests[t], &design = designs[(b + t) % designs.size()];
            rows.push_back({bases[b].name + ", " + test.name + ", " + design.name, &bases[b], test, design});
        }
    return rows;
}

const CaseTable all("on ", every_pair(), [](const Row& row) { run_on(*row.base, row.test, row.design); });

}  // namespace
