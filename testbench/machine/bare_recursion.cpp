#include "testbench/machine/bare_recursion.h"

#include <algorithm>

#include "modules/datapath/map_entry.h"

namespace tessera {

using namespace datapath;  // this file consists of calls to the datapath

template class BareEdges<BareRecursion>;

BareRecursion::BareRecursion(const MachineSetup& setup)
    : BareEdges(setup.registers.formats.height_test), setup_(setup) {
    const MapGeometry& map = setup.registers.map;
    const Formats& formats = setup.registers.formats;
    normals_.reserve(setup.map.codes.size());
    for (std::uint32_t y = 0; y < map.height; ++y)
        for (std::uint32_t x = 0; x < map.width; ++x)
            normals_.push_back(pack_normal(
                tessera::map_normal(setup.map, x, y, setup.height_per_code, setup.texel_size, formats.normal),
                formats.normal.bits));
    const TableLayout& table = setup.registers.height_table;
    height_table_.resize(table.bytes() + sizeof(std::uint64_t));
    for (unsigned k = 0; k < table.entry_bytes; ++k)
        height_entry_mask_ = height_entry_mask_ << 8 | 0xff;
    write_height_table(setup, [&](std::uint64_t address, const unsigned char* bytes, std::size_t count) {
        std::copy_n(bytes, count, height_table_.begin() + static_cast<std::ptrdiff_t>(address - table.base));
    });
}

ChildIndices BareRecursion::children_of(const TrianglePass& pass) const {
    const auto displaced = [&](std::uint8_t index) -> const Position& {
        return index < 3 ? pass.triangle.vertices[index].displaced : pass.new_vertex[index - 3u].displaced;
    };
    return triangulate(pass.split, choose_second_diagonal(pass.split, setup_.registers.triangulation, displaced));
}

void BareRecursion::transform_normals(Triangle& triangle) {
    for (Vertex& v : triangle.vertices)
        if (!v.screen_normal_known)
            v.screen_normal =
                transform_normal(v.displaced_normal, setup_.registers.transform, setup_.registers.formats, saturations);
}

namespace {

/// Records finished triangles only.
struct Emit {
    struct Note {};
    EmittedMesh& mesh;

    static Note begin(const Triangle&) { return {}; }
    static void decided(const TrianglePass&, const ChildIndices&, const Note&) {}
    static Note child(const std::array<std::uint8_t, 3>&) { return {}; }
    void finished(const Triangle& triangle, bool culled) {
        mesh.triangles.push_back(EmittedTriangle::from(triangle, culled));
    }
};

}  // namespace

std::uint64_t BareRecursion::run(EmittedMesh& mesh, std::uint64_t most_edges) {
    mesh.triangles.clear();
    Emit emit{mesh};
    return walk(emit, most_edges);
}

}  // namespace tessera
