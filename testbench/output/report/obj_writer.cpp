#include "testbench/output/report/obj_writer.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <array>
#include <iterator>
#include <string_view>
#include <vector>

#include "testbench/common/atomic_file.h"
#include "testbench/machine/deciding_test.h"
#include "testbench/output/report/indexed_mesh.h"

namespace tessera {
namespace {

constexpr std::size_t generations = 256;

std::size_t group_of(const EmittedTriangle& triangle) {
    return static_cast<std::size_t>(deciding_test_of(triangle.split_by)) * generations + triangle_generation(triangle);
}

/// Triangle indices in the order of their groups; stable. begins[g]: start of group g.
struct Grouped {
    std::vector<std::uint32_t> order;
    std::vector<std::size_t> begins;
};

Grouped group(const EmittedMesh& mesh, const IndexedMesh& indexed) {
    Grouped result;
    result.begins.assign(deciding_tests * generations + 1, 0);
    for (const auto& t : indexed.triangles)
        ++result.begins[group_of(mesh.triangles[t.triangle]) + 1];
    for (std::size_t g = 1; g < result.begins.size(); ++g)
        result.begins[g] += result.begins[g - 1];
    std::vector<std::size_t> next = result.begins;
    result.order.resize(indexed.triangles.size());
    for (std::uint32_t i = 0; i < indexed.triangles.size(); ++i)
        result.order[next[group_of(mesh.triangles[indexed.triangles[i].triangle])]++] = i;
    return result;
}

}  // namespace

void write_obj(const std::filesystem::path& path, const EmittedMesh& mesh, const MeshUnits& units) {
    const IndexedMesh indexed = IndexedMesh::from(mesh);
    const datapath::HeightTestFunctions& height_test = functions_of(units.formats.height_test);
    const std::array<std::string_view, deciding_tests> test_names = {"base", "normal", height_test.name, "both",
                                                                     "highlight"};
    AtomicFile file(path);
    fmt::memory_buffer line;
    const auto put = [&](const auto& format, const auto&... values) {
        fmt::format_to(std::back_inserter(line), format, values...);
        if (line.size() >= std::size_t{1} << 16) {
            file.write({line.data(), line.size()});
            line.clear();
        }
    };
    put(FMT_COMPILE("# tessera: adaptively tessellated, displaced mesh; culled triangles left out\n"
                    "# {} vertices, {} triangles\n"
                    "# v: displaced position, model units; vn: normal of the displaced surface\n"
                    "# vt: texture coordinates, 0..1 spans the map, v = 0 is its bottom row\n"
                    "# g and usemtl <test>_g<generation>:\n"
                    "#   test: which test split the triangle's parent: normal (Normal Test),\n"
                    "#     {} ({}), both,{} or base: it is a base triangle\n"
                    "#   generation: of its youngest vertex, 0 for a base triangle\n"),
        indexed.vertices.size(), indexed.triangles.size(), height_test.name, height_test.title(),
        mesh.has_highlight_splits() ? " highlight (Highlight Test alone)," : "");
    const std::vector<EmittedTriangle::Corner>& corners = mesh.triangles.corners();
    for (const std::uint32_t vertex : indexed.vertices) {
        const glm::dvec3 p = units.position(corners[vertex].displaced);
        put(FMT_COMPILE("v {} {} {}\n"), p.x, p.y, p.z);
    }
    for (const std::uint32_t vertex : indexed.vertices) {
        const glm::vec2 t(units.texture(corners[vertex].texture));
        put(FMT_COMPILE("vt {} {}\n"), t.x, t.y);
    }
    for (const std::uint32_t vertex : indexed.vertices) {
        const glm::vec3 n = units.normal(corners[vertex].displaced_normal);
        put(FMT_COMPILE("vn {} {} {}\n"), n.x, n.y, n.z);
    }
    const Grouped grouped = group(mesh, indexed);
    for (std::size_t g = 0; g + 1 < grouped.begins.size(); ++g) {
        if (grouped.begins[g] == grouped.begins[g + 1])
            continue;
        const std::string_view test = test_names[g / generations];
        const std::size_t generation = g % generations;
        put(FMT_COMPILE("g {}_g{}\nusemtl {}_g{}\n"), test, generation, test, generation);
        for (std::size_t i = grouped.begins[g]; i < grouped.begins[g + 1]; ++i) {
            const auto& v = indexed.triangles[grouped.order[i]].vertices;
            const std::uint32_t a = v[0] + 1, b = v[1] + 1, c = v[2] + 1;
            put(FMT_COMPILE("f {}/{}/{} {}/{}/{} {}/{}/{}\n"), a, a, a, b, b, b, c, c, c);
        }
    }
    file.write({line.data(), line.size()});
    file.commit();
}

}  // namespace tessera
