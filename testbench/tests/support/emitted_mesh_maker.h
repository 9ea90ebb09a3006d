#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "modules/datapath/edge_tests.h"
#include "modules/datapath/midpoint.h"
#include "modules/datapath/triangulate.h"
#include "testbench/machine/emitted_mesh.h"

namespace tessera {

/// A mesh made without the datapath: cut by edges alone, displaced by a function of t.
struct MeshMaker {
    std::function<bool(const datapath::Vertex&, const datapath::Vertex&)> split;
    std::function<std::int32_t(const datapath::TexCoord&)> height;
    unsigned generation_limit = 12;

    EmittedMesh make(const std::vector<datapath::Triangle>& base_triangles) const {
        EmittedMesh mesh;
        for (const datapath::Triangle& base : base_triangles) {
            datapath::Triangle triangle = base;
            for (datapath::Vertex& v : triangle.vertices)
                displace(v);
            cut(triangle, mesh);
        }
        return mesh;
    }

  private:
    void displace(datapath::Vertex& v) const {
        const std::int32_t h = height(v.texture);
        v.displaced = {v.position.x + (h * v.normal.x >> 14), v.position.y + (h * v.normal.y >> 14),
                       v.position.z + (h * v.normal.z >> 14)};
        v.displaced_normal = {v.normal.x, v.normal.y, (v.normal.z + h) & 0x3fff};
    }
    datapath::Vertex inserted(const datapath::Vertex& i, const datapath::Vertex& j) const {
        datapath::Vertex v;
        v.position = datapath::midpoint(i.position, j.position);
        v.normal = datapath::midpoint(i.normal, j.normal);
        v.texture = datapath::midpoint(i.texture, j.texture);
        v.generation = datapath::inserted_generation(i.generation, j.generation);
        displace(v);
        return v;
    }
    void cut(const datapath::Triangle& triangle, EmittedMesh& mesh) const {
        std::array<datapath::Vertex, 6> v;
        unsigned marks = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const datapath::Vertex &i = triangle.vertices[k], &j = triangle.vertices[(k + 1) % 3];
            v[k] = i;
            v[3 + k] = inserted(i, j);
            if (v[3 + k].generation <= generation_limit && split(i, j))
                marks |= 1u << k;
        }
        if (marks == 0) {
            mesh.triangles.push_back(EmittedTriangle::from(triangle, false));
            return;
        }
        const bool second = datapath::choose_second_diagonal(
            marks, datapath::Triangulation::shorter,
            [&](std::uint8_t index) -> const datapath::Position& { return v[index].displaced; });
        const datapath::ChildIndices indices = datapath::triangulate(marks, second);
        for (int c = 0; c < indices.count; ++c) {
            datapath::Triangle child = triangle;
            for (std::size_t k = 0; k < 3; ++k)
                child.vertices[k] = v[indices.children[static_cast<std::size_t>(c)][k]];
            child.split_by = datapath::normal_bit;
            cut(child, mesh);
        }
    }
};

/// A grid of quads, split from the (0,0) to the (1,1) corner. vertex(i, j) for i = 0..columns, j = 0..rows.
template <class MakeVertex>
std::vector<datapath::Triangle> make_grid(int columns, int rows, MakeVertex&& vertex) {
    std::vector<datapath::Triangle> result;
    const auto add = [&](const datapath::Vertex& a, const datapath::Vertex& b, const datapath::Vertex& c) {
        datapath::Triangle triangle;
        triangle.vertices = {a, b, c};
        triangle.base = static_cast<std::uint32_t>(result.size());
        result.push_back(triangle);
    };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            add(vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1));
            add(vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1));
        }
    return result;
}

/// A flat vertex at texel (u, v); a texel is a thousand LSB of the position wide.
inline datapath::Vertex flat_vertex(std::uint32_t u, std::uint32_t v) {
    datapath::Vertex vertex;
    vertex.position = {static_cast<std::int32_t>(1000 * u), static_cast<std::int32_t>(1000 * v), 0};
    vertex.normal = {0, 0, 16384};
    vertex.tangent = {16384, 0, 0};
    vertex.texture = {u << 12, v << 12};
    return vertex;
}

}  // namespace tessera
