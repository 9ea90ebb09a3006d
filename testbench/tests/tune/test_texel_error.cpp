#include "testbench/tune/texel_error.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "testbench/input/mesh/built_in.h"
#include "testbench/job/job_paths.h"
#include "testbench/job/read_job.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/inputs.h"
#include "testbench/machine/resolve_job.h"
#include "testbench/tests/support/source_folder.h"

using namespace tessera;

namespace {

/// Sums the errors of finished triangles.
struct Meter {
    struct Note {};

    const TexelError& errors;
    TexelError::Sum sum{};

    Note begin(const datapath::Triangle&) { return {}; }
    void decided(const datapath::TrianglePass&, const datapath::ChildIndices&, const Note&) {}
    Note child(const std::array<std::uint8_t, 3>&) { return {}; }
    void finished(const datapath::Triangle& triangle, bool) {
        sum.add(errors.of({&triangle.vertices[0], &triangle.vertices[1], &triangle.vertices[2]}, triangle.base));
    }
};

/// A plane over a map, with vertices at its border and every 16 texels from `first`.
BaseMesh plane_from(const glm::dvec2& first, const HeightMap& map, const Job::Mesh& size) {
    const auto lines = [](double from, int texels) {
        std::vector<double> at{0};
        for (double line = from; line < texels; line += 16)
            if (line > 0)
                at.push_back(line / texels);
        at.push_back(1);
        return at;
    };
    const std::vector<double> u = lines(first.x, map.width), v = lines(first.y, map.height);
    BaseMesh mesh = make_plane(static_cast<std::int64_t>(u.size()) - 1, static_cast<std::int64_t>(v.size()) - 1,
                               size.width, size.depth);
    for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
        BaseVertex& vertex = mesh.vertices[k];
        vertex.texture = {u[k % u.size()], v[k / u.size()]};
        vertex.position = {size.width * (vertex.texture.x - 0.5), size.depth * (vertex.texture.y - 0.5), 0};
    }
    return mesh;
}

/// RMS error in m at Crater Lake's grid points, with a bilinear filter and all edges split to the map's resolution.
double crater_lake_rms(const glm::dvec2& first, std::int64_t tex_coord_fraction) {
    Job job = read_job(source_folder() / "testbench/examples/jobs/crater_lake_704.toml");
    resolve_paths(job, {});
    job.hardware.displacement_filter = MapFilter::bilinear;
    job.formats.tex_coord_fraction = tex_coord_fraction;
    job.tests.view = false;
    job.tests.normal_threshold = 0;
    job.tests.threshold("summed_height_threshold") = 0;
    const HeightMap map = load_map(job);
    const BaseMesh mesh = plane_from(first, map, job.mesh);
    job = resolve_job(job, mesh, map).job;
    const MachineSetup setup = make_setup(job, mesh, map);
    const TexelError errors(setup, map, DisplacementOf::from(job, map));
    Meter meter{errors};
    BareRecursion(setup).walk(meter);
    return 1000 * std::sqrt(meter.sum.squares / meter.sum.weight);  // heights are in km
}

}  // namespace

TEST_CASE("a bilinear filter alone has an error below 1.3 m on Crater Lake, for any position of the base vertices") {
    constexpr std::int64_t by_the_filter = -1;
    // distances from a border in texels, on each axis
    for (const glm::dvec2 first :
         {glm::dvec2(0), glm::dvec2(0.25), glm::dvec2(0.5), glm::dvec2(0.75, 0.25), glm::dvec2(0, 0.5)}) {
        INFO("vertices " << first.x << ", " << first.y << " texels from a border");
        CHECK(crater_lake_rms(first, by_the_filter) < 0.9);
    }
}

TEST_CASE(
    "with formats.tex_coord_fraction = 0 the error is below 1.3 m only with base vertices off the texel borders") {
    CHECK(crater_lake_rms({0.5, 0.5}, 0) < 0.3);
    CHECK(crater_lake_rms({0.25, 0.25}, 0) < 1.3);
    CHECK(crater_lake_rms({0, 0}, 0) == Approx(1.59).epsilon(0.01));
}
