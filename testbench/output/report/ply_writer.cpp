#include "testbench/output/report/ply_writer.h"

#include <fmt/format.h>

#include <cstring>
#include <string>

#include "testbench/common/atomic_file.h"
#include "testbench/output/report/indexed_mesh.h"

namespace tessera {
namespace {

/// Little-endian bytes, whatever the machine's order.
class Record {
  public:
    explicit Record(AtomicFile& file) : file_(file) {}

    void put(std::uint8_t value) { bytes_[size_++] = static_cast<char>(value); }
    void put(std::uint32_t value) { put_bytes(value, 4); }
    void put(float value) {
        std::uint32_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        put_bytes(bits, 4);
    }
    void put(double value) {
        std::uint64_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        put_bytes(bits, 8);
    }
    void finish() {
        file_.write({bytes_, size_});
        size_ = 0;
    }

  private:
    void put_bytes(std::uint64_t value, int count) {
        for (int i = 0; i < count; ++i)
            put(static_cast<std::uint8_t>(value >> (8 * i) & 0xff));
    }

    AtomicFile& file_;
    char bytes_[64];
    std::size_t size_ = 0;
};

}  // namespace

void write_ply(const std::filesystem::path& path, const EmittedMesh& mesh, const MeshUnits& units) {
    const IndexedMesh indexed = IndexedMesh::from(mesh);
    const bool highlight = mesh.has_highlight_splits();
    const std::string height_test = functions_of(units.formats.height_test).title();
    AtomicFile file(path);
    file.write(
        fmt::format("ply\n"
                    "format binary_little_endian 1.0\n"
                    "comment tessera: adaptively tessellated, displaced mesh; culled triangles left out\n"
                    "comment x y z: displaced position, model units; nx ny nz: normal of the displaced surface\n"
                    "comment s t: texture coordinates, 0..1 spans the map, t = 0 is its bottom row\n"
                    "comment generation: of the triangle's youngest vertex; 0 is a base triangle's\n"
                    "comment split_by: tests that split the parent: 0 none (a base triangle), 1 Normal Test, "
                    "2 {0}, 3 both{3}\n"
                    "comment stopped_by: tests that stopped a split requested by the Normal{1} {0}{2}: "
                    "sum of 4 View Test, 8 Tex Coord Test, 16 Generation Test\n"
                    "comment base: the base triangle it descends from\n"
                    "element vertex {4}\n"
                    "property double x\n"
                    "property double y\n"
                    "property double z\n"
                    "property float nx\n"
                    "property float ny\n"
                    "property float nz\n"
                    "property double s\n"
                    "property double t\n"
                    "element face {5}\n"
                    "property list uchar int vertex_indices\n"
                    "property uchar generation\n"
                    "property uchar split_by\n"
                    "property uchar stopped_by\n"
                    "property int base\n"
                    "end_header\n",
                    height_test, highlight ? "," : " or", highlight ? " or Highlight Test" : "",
                    highlight ? "; 32 is added where the Highlight Test was true" : "", indexed.vertices.size(),
                    indexed.triangles.size()));
    Record record(file);
    for (const std::uint32_t vertex : indexed.vertices) {
        const EmittedTriangle::Corner& corner = mesh.triangles.corners()[vertex];
        const glm::dvec3 position = units.position(corner.displaced);
        const glm::vec3 normal = units.normal(corner.displaced_normal);
        const glm::dvec2 texture = units.texture(corner.texture);
        for (int k = 0; k < 3; ++k)
            record.put(position[k]);
        for (int k = 0; k < 3; ++k)
            record.put(normal[k]);
        record.put(texture.x);
        record.put(texture.y);
        record.finish();
    }
    for (const IndexedMesh::Triangle& t : indexed.triangles) {
        const EmittedTriangle& triangle = mesh.triangles[t.triangle];
        record.put(std::uint8_t{3});
        for (const std::uint32_t vertex : t.vertices)
            record.put(vertex);
        record.put(triangle_generation(triangle));
        record.put(triangle.split_by);
        record.put(triangle.stopped_by);
        record.put(triangle.base);
        record.finish();
    }
    file.commit();
}

}  // namespace tessera
