#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>

#include "testbench/output/report/ply_writer.h"
#include "testbench/render/render_mesh.h"
#include "testbench/run_folder/ply_reader.h"
#include "testbench/tests/support/edited_mesh.h"
#include "testbench/tests/support/test_folder.h"

using namespace tessera;

namespace {

MachineSetup some_setup(const glm::dvec3& centre, double scale) {
    MachineSetup setup;
    setup.model_scale = {scale, centre};
    setup.registers.map.width = 64;
    setup.registers.map.height = 64;
    return setup;
}

/// A bumpy grid in the machine's number formats, in which all corners and triangles are distinguishable.
EmittedMesh some_mesh() {
    EmittedMesh mesh;
    const auto at = [](int x, int y) {
        EmittedTriangle::Corner corner;
        const int bump = (x * 7919 + y * 104729) % 99991;
        corner.position = {x * 123457, y * 98765, 0};
        corner.displaced = {x * 123457 + bump, y * 98765 - bump, bump * 3 - 100000};
        corner.displaced_normal = {static_cast<std::int16_t>(bump % 9000), static_cast<std::int16_t>(x - y), 14000};
        corner.texture.u = static_cast<std::uint32_t>(x * 4096);
        corner.texture.v = static_cast<std::uint32_t>(y * 4096);
        corner.generation = static_cast<std::uint8_t>((x + y) % 9);
        return corner;
    };
    const std::uint8_t stopped[] = {0, 4, 8, 16, 28};
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 12; ++x)
            for (int half = 0; half < 2; ++half) {
                EmittedTriangle triangle;
                triangle.corners = {at(x, y), half == 0 ? at(x + 1, y) : at(x + 1, y + 1),
                                    half == 0 ? at(x + 1, y + 1) : at(x, y + 1)};
                triangle.base = static_cast<std::uint32_t>(x / 3 + 4 * (y / 3));
                triangle.split_by = static_cast<std::uint8_t>((x + y) % 4);
                triangle.stopped_by = stopped[(x * y + half) % 5];
                triangle.culled = x == 5 && y > 7;
                mesh.triangles.push_back(triangle);
            }
    mesh.sort();
    return mesh;
}

}  // namespace

TEST_CASE("render: a mesh read back from mesh.ply equals the run's own, number for number") {
    const TestFolder here;
    for (const glm::dvec3& centre : {glm::dvec3(0), glm::dvec3(0.1, -7.3, 1e-3), glm::dvec3(1e6, 1.0 / 3, -12345.678)})
        for (const double scale : {1.0, 1.0 / 64, 4096.0}) {
            CAPTURE(centre.x, scale);
            const MachineSetup setup = some_setup(centre, scale);
            const EmittedMesh run = some_mesh();
            const RenderMesh made = make_render_mesh(run, setup);
            write_ply(here.path() / "mesh.ply", run, {setup.registers.formats, setup.registers.map, scale, centre});
            const RenderMesh read = make_render_mesh(read_ply(here.path() / "mesh.ply"));
            CHECK(made.origin == read.origin);
            CHECK((made.positions == read.positions));
            CHECK((made.normals == read.normals));
            CHECK(made.base_triangles == read.base_triangles);
            CHECK(made.base_triangles == 16);
            REQUIRE(made.triangles.size() == 288 - 8);  // eight were culled
            REQUIRE(made.triangles.size() == read.triangles.size());
            for (std::size_t i = 0; i < made.triangles.size(); ++i) {
                REQUIRE(made.triangles[i].vertices == read.triangles[i].vertices);
                REQUIRE(made.triangles[i].generation == read.triangles[i].generation);
                REQUIRE(made.triangles[i].deciding_test == read.triangles[i].deciding_test);
                REQUIRE(made.triangles[i].stopped_by == read.triangles[i].stopped_by);
            }
        }
}

TEST_CASE("render: positions keep full single precision for any position of the model") {
    const MachineSetup setup = some_setup({1e6, -3e6, 2e6}, 4);
    const EmittedMesh run = some_mesh();
    const RenderMesh mesh = make_render_mesh(run, setup);
    std::size_t drawn = 0;
    for (const EmittedTriangle& triangle : run.triangles) {
        if (triangle.culled)
            continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const datapath::Position& p = triangle.corners[k].displaced;
            const glm::dvec3 exact =
                glm::dvec3(p.x, p.y, p.z) * std::ldexp(0.25, -setup.registers.formats.position.fraction) +
                setup.model_scale.centre;
            const glm::dvec3 drawn_at = mesh.origin + glm::dvec3(mesh.positions[mesh.triangles[drawn].vertices[k]]);
            REQUIRE(glm::length(drawn_at - exact) < 1e-5);
        }
        ++drawn;
    }
}

TEST_CASE("render: a run without triangles gives an empty mesh") {
    const MachineSetup setup = some_setup({1, 2, 3}, 1);
    const EmittedMesh run = changed(some_mesh(), [](EmittedTriangle& triangle) { triangle.culled = true; });
    for (const RenderMesh& mesh : {make_render_mesh(run, setup), make_render_mesh(RecordedMesh{})}) {
        CHECK(mesh.triangles.empty());
        CHECK(mesh.positions.empty());
        CHECK(mesh.base_triangles == 0);
    }
}
