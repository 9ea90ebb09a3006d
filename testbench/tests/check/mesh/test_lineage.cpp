#include "testbench/check/mesh/lineage.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "modules/datapath/tessellate.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/inputs.h"
#include "testbench/tests/support/job_setup.h"

/// The check by descent: with the datapath as it is, on base meshes of all kinds, and with a faulty one.
namespace tessera {
namespace {

using datapath::Triangle;
using datapath::TrianglePass;
using testing::noise_job;
using testing::setup_of;

MachineSetup round_setup(Addressing address_u) {
    Job job = noise_job();
    job.mesh.source = MeshSource::cylinder;
    job.mesh.columns = 6;
    job.mesh.rows = 1;
    job.map.address_u = address_u;
    return setup_of(job);
}

InvariantResult check(const MachineSetup& setup) {
    BareRecursion bare(setup);
    Lineage lineage(setup, bare);
    bare.walk(lineage);
    return lineage.finish();
}

/// Requires these counts of cracks, T-vertices and inconsistent vertices.
void require_faults(const InvariantResult& result, std::uint64_t cracks, std::uint64_t t_vertices,
                    std::uint64_t unlike_vertices) {
    INFO(result.first_violation);
    CHECK(result.cracks == cracks);
    CHECK(result.t_vertices == t_vertices);
    CHECK(result.inconsistent_vertices == unlike_vertices);
    CHECK(result.first_violation.empty() == (cracks + t_vertices + unlike_vertices == 0));
}

/// A faulty datapath, which alters one of its passes or one of the children it makes.
struct Broken {
    using Note = Lineage::Note;
    Lineage& lineage;
    /// Called for each pass with its number; forwards what the check sees.
    std::function<void(Broken&, std::size_t, const TrianglePass&, const Note&)> pass;
    /// Called for each child with its number; returns its corners.
    std::function<std::array<std::uint8_t, 3>(std::size_t, std::array<std::uint8_t, 3>)> corners;
    std::size_t passes = 0, children = 0;

    Note begin(const Triangle& base) { return lineage.begin(base); }
    void decided(const TrianglePass& seen, const datapath::ChildIndices&, const Note& note) {
        if (pass)
            pass(*this, passes++, seen, note);
        else
            forward(seen, note);
    }
    Note child(const std::array<std::uint8_t, 3>& right) {
        return lineage.child(corners ? corners(children++, right) : right);
    }
    void finished(const Triangle&, bool) {}

    void forward(const TrianglePass& seen, const Note& note) { lineage.decided(seen, {}, note); }
    /// Forwards the pass of a finished triangle as if edge k were split and both children finished.
    void split_alone(const TrianglePass& whole, const Note& note, int k) {
        TrianglePass broken = whole;
        broken.split = static_cast<std::uint8_t>(1U << k);
        forward(broken, note);
        const datapath::ChildIndices indices = datapath::triangulate(broken.split, false);
        std::size_t number = 0;
        std::array<TrianglePass, 2> finished;
        std::array<Note, 2> notes{};
        datapath::Saturations ignored;
        datapath::tessellate(broken, datapath::Triangulation::first, {}, ignored, [&](const Triangle& made) {
            finished[number].triangle = made;
            notes[number] = lineage.child(indices.children[number]);
            ++number;
        });
        forward(finished[0], notes[0]);
        forward(finished[1], notes[1]);
    }
};

InvariantResult check_broken(const MachineSetup& setup, decltype(Broken::pass) pass,
                             decltype(Broken::corners) corners = {}) {
    BareRecursion bare(setup);
    Lineage lineage(setup, bare);
    Broken broken{lineage, std::move(pass), std::move(corners)};
    bare.walk(broken);
    return lineage.finish();
}

bool is_on_border(const MachineSetup& setup, const TrianglePass& pass, int k) {
    const std::uint32_t side = setup.registers.map.width << setup.registers.formats.texture.fraction;
    const auto a = pass.edge_begin(k).texture, b = pass.edge_end(k).texture;
    return (a.u == b.u && a.u % side == 0) || (a.v == b.v && a.v % side == 0);
}

}  // namespace

TEST_CASE("lineage: a plane has no faults") {
    const MachineSetup setup = setup_of(noise_job());
    const InvariantResult result = check(setup);
    require_faults(result, 0, 0, 0);
    CHECK(result.base_edges == 16);
    CHECK(result.border_base_edges == 8);
    EmittedMesh mesh;
    BareRecursion(setup).run(mesh);
    CHECK(mesh.triangles.size() > 100);
}

TEST_CASE("lineage: any finished triangle left out, doubled or turned over is found") {
    const MachineSetup setup = setup_of(noise_job());
    std::size_t passes = 0;
    check_broken(setup, [&](Broken& broken, std::size_t, const TrianglePass& pass, const Lineage::Note& note) {
        ++passes;
        broken.forward(pass, note);
    });
    std::size_t tried = 0;
    for (std::size_t n = 0; n < passes; n += 5) {
        bool finished = false;
        const auto with = [&](auto change) {
            return check_broken(
                setup, [&](Broken& broken, std::size_t number, const TrianglePass& pass, const Lineage::Note& note) {
                    if (number == n && pass.split == 0) {
                        finished = true;
                        change(broken, pass, note);
                    } else {
                        broken.forward(pass, note);
                    }
                });
        };
        const InvariantResult missing = with([](Broken&, const TrianglePass&, const Lineage::Note&) {});
        if (!finished)
            continue;
        ++tried;
        require_faults(missing, 3, 0, 0);
        require_faults(with([](Broken& broken, const TrianglePass& pass, const Lineage::Note& note) {
                           broken.forward(pass, note);
                           broken.forward(pass, note);
                       }),
                       3, 0, 0);
        require_faults(with([](Broken& broken, const TrianglePass& pass, Lineage::Note note) {
                           for (Lineage::Side& side : note.edges)
                               side = side.turned();
                           broken.forward(pass, note);
                       }),
                       3, 0, 0);
    }
    CHECK(tried > 100);
}

TEST_CASE("lineage: an edge split by one triangle alone is a T-vertex, except on the base mesh's border") {
    const MachineSetup setup = setup_of(noise_job());
    std::size_t inside = 0, on_border = 0;
    for (std::size_t n = 0; n < 600; n += 5)
        for (int k = 0; k < 3; ++k) {
            std::optional<bool> border;
            const InvariantResult result = check_broken(
                setup, [&](Broken& broken, std::size_t number, const TrianglePass& pass, const Lineage::Note& note) {
                    if (number == n && pass.split == 0) {
                        border = is_on_border(setup, pass, k);
                        broken.split_alone(pass, note, k);
                    } else {
                        broken.forward(pass, note);
                    }
                });
            if (!border)
                continue;
            // Two pieces, which the triangle on the other side lacks.
            require_faults(result, *border ? 0 : 2, *border ? 0 : 1, 0);
            ++(*border ? on_border : inside);
        }
    CHECK(inside > 100);
    CHECK(on_border > 2);
}

TEST_CASE("lineage: a vertex that differs between triangles in any field is found, once") {
    const MachineSetup setup = setup_of(noise_job());
    const std::vector<std::function<void(datapath::Vertex&)>> changes{[](auto& v) { v.position.x += 1; },
                                                                      [](auto& v) { v.normal.y += 1; },
                                                                      [](auto& v) { v.tangent.z += 1; },
                                                                      [](auto& v) { v.texture.u += 1; },
                                                                      [](auto& v) { v.texture.v += 1; },
                                                                      [](auto& v) { v.handedness = static_cast<std::int8_t>(-v.handedness); },
                                                                      [](auto& v) { v.generation ^= 1; },
                                                                      [](auto& v) { v.displaced.x += 1; },
                                                                      [](auto& v) { v.displaced_normal.x += 1; },
                                                                      [](auto& v) { v.screen.w += 1; }};
    for (const auto& change : changes)
        for (const std::size_t n : {0U, 3U, 40U, 77U}) {
            std::size_t finished = 0;
            const InvariantResult result = check_broken(
                setup, [&](Broken& broken, std::size_t, const TrianglePass& pass, const Lineage::Note& note) {
                    TrianglePass seen = pass;
                    if (pass.split == 0 && finished++ == n)
                        change(seen.triangle.vertices[n % 3]);
                    broken.forward(seen, note);
                });
            require_faults(result, 0, 0, 1);
            CHECK(result.first_violation.find(": a vertex differs between triangles: P (") != std::string::npos);
        }
}

TEST_CASE("lineage: a wrong triangulation leaves edges without their triangles") {
    const MachineSetup setup = setup_of(noise_job());
    SECTION("a child wound the other way") {
        for (const std::size_t n : {0U, 5U, 50U}) {
            const InvariantResult result = check_broken(setup, {}, [&](std::size_t number, auto corners) {
                if (number == n)
                    std::swap(corners[0], corners[1]);
                return corners;
            });
            CHECK(result.cracks > 2);
        }
    }
    SECTION("one child twice, the other missing") {
        std::array<std::uint8_t, 3> first{};
        const InvariantResult result = check_broken(setup, {}, [&](std::size_t number, auto corners) {
            if (number == 0)
                first = corners;
            return number == 1 ? first : corners;
        });
        CHECK(result.cracks > 2);
    }
    SECTION("a child with its parent's whole edge, though the edge is split") {
        const InvariantResult result = check_broken(setup, {}, [&](std::size_t number, auto corners) {
            return number == 0 ? std::array<std::uint8_t, 3>{0, 1, 2} : corners;
        });
        CHECK(result.cracks + result.t_vertices > 2);
    }
}

TEST_CASE("lineage: a shared base vertex with two generations is found with its cracks") {
    const MachineSetup setup = setup_of(noise_job());
    // One copy of a shared vertex is of the last generation, so that its triangles do not split their edges there.
    MachineSetup older = setup;
    older.base_triangles[1].vertices[1].generation = static_cast<std::uint8_t>(setup.registers.tests.generation_limit);
    const InvariantResult result = check(older);
    CHECK(result.inconsistent_vertices == 1);
    CHECK(result.t_vertices > 0);
    CHECK(result.cracks > 1);  // the halves on the other side
    CHECK(result.first_violation.find("base triangle ") == 0);
}

TEST_CASE("lineage: duplicated base triangles and a mesh folded onto itself are not faults") {
    MachineSetup setup = setup_of(noise_job());
    const std::size_t once = setup.base_triangles.size();
    for (std::size_t b = 0; b < once; ++b) {  // a second copy, wound the opposite way
        Triangle other = setup.base_triangles[b];
        std::swap(other.vertices[0], other.vertices[1]);
        other.base = static_cast<std::uint32_t>(once + b);
        setup.base_triangles.push_back(other);
    }
    InvariantResult result = check(setup);
    require_faults(result, 0, 0, 0);
    CHECK(result.base_edges == 16);
    CHECK(result.border_base_edges == 0);
    CHECK(result.non_manifold_base_edges == 8);

    setup.base_triangles.resize(once + 1);
    setup.base_triangles[once] = setup.base_triangles[0];
    setup.base_triangles[once].base = static_cast<std::uint32_t>(once);
    result = check(setup);
    require_faults(result, 0, 0, 0);
    CHECK(result.non_manifold_base_edges > 0);
}

TEST_CASE("lineage: a cylinder's seam") {
    SECTION("is closed and checked in repeat") {
        const MachineSetup setup = round_setup(Addressing::repeat);
        const InvariantResult result = check(setup);
        require_faults(result, 0, 0, 0);
        CHECK(result.base_edges == 24);
        CHECK(result.border_base_edges == 12);
        CHECK(result.texture_seams == 0);
        CHECK(result.open_texture_seam_edges == 0);

        const std::uint32_t last = setup.registers.map.width << setup.registers.formats.texture.fraction;
        const InvariantResult open =
            check_broken(setup, [&](Broken& broken, std::size_t, const TrianglePass& pass, const Lineage::Note& note) {
                TrianglePass seen = pass;
                for (datapath::Vertex& v : seen.triangle.vertices)
                    v.displaced.x += v.texture.u == last ? 1 : 0;
                broken.forward(seen, note);
            });
        CHECK(open.inconsistent_vertices > 2);
    }
    SECTION("in clamp, open edges are counted as a texture seam") {
        const InvariantResult result = check(round_setup(Addressing::clamp));
        require_faults(result, 0, 0, 0);
        CHECK(result.base_edges == 24);
        CHECK(result.border_base_edges == 12);
        CHECK(result.texture_seams == 1);
        CHECK(result.open_texture_seam_edges > 2);
        CHECK(result.open_crease_edges == 0);
    }
    SECTION("texture coordinates off by part of a period do not join in repeat") {
        MachineSetup setup = round_setup(Addressing::repeat);
        const std::uint32_t last = setup.registers.map.width << setup.registers.formats.texture.fraction;
        for (Triangle& base : setup.base_triangles)
            for (datapath::Vertex& v : base.vertices)
                v.texture.u -= v.texture.u == last ? 9000 : 0;
        const InvariantResult result = check(setup);
        require_faults(result, 0, 0, 0);
        CHECK(result.texture_seams == 1);
        CHECK(result.open_texture_seam_edges > 2);
    }
}

TEST_CASE("lineage: open pieces along a seam are counted on the finer side") {
    // Two triangles over one map; the copies of their common edge are half the map apart. One splits, one does not.
    MachineSetup setup = setup_of(noise_job());
    setup.base_triangles.resize(2);
    for (datapath::Vertex& v : setup.base_triangles[1].vertices)
        v.generation = static_cast<std::uint8_t>(setup.registers.tests.generation_limit);  // does not split
    std::uint64_t pieces = 0;
    for (datapath::Vertex& v : setup.base_triangles[1].vertices)
        v.texture.u += 1;
    EmittedMesh mesh;
    BareRecursion(setup).run(mesh);
    const auto diagonal = [](const EmittedTriangle::Corner& c) { return c.texture.u == c.texture.v; };
    for (const EmittedTriangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            pieces += t.base == 0 && diagonal(t.corners[k]) && diagonal(t.corners[(k + 1) % 3]) ? 1U : 0U;
    const InvariantResult result = check(setup);
    require_faults(result, 0, 0, 0);
    CHECK(result.texture_seams == 1);
    CHECK(pieces > 1);
    CHECK(result.open_texture_seam_edges == pieces);
}

TEST_CASE("lineage: open edges along a crease of the base mesh are not faults") {
    MachineSetup setup = setup_of(noise_job());
    for (std::size_t b = 4; b < 8; ++b)
        for (datapath::Vertex& v : setup.base_triangles[b].vertices)
            v.normal = {0, 11585, 11585};
    const InvariantResult result = check(setup);
    require_faults(result, 0, 0, 0);
    CHECK(result.creases == 2);
    CHECK(result.open_crease_edges > 4);
    CHECK(result.texture_seams == 0);
    CHECK(result.open_texture_seam_edges == 0);
}

}  // namespace tessera
