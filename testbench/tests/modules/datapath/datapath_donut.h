#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

#include "testbench/input/map/built_in_maps.h"
#include "testbench/prove/random_edges/datapath_edge.h"

namespace tessera::testing {

inline constexpr std::uint32_t donut_side = 256;
/// Texels per world unit: the plane is [-1, 1] x [-1, 1] in the default position format.
inline constexpr double texels_per_unit = donut_side / 2.0;

/// The half-donut map on the plane [-1, 1]^2, with scale 1/4 so that it is round; View Test off. Thresholds in the
/// paper's units: NT a component of the normal, SHT codes times texels.
inline EdgeMachine half_donut_machine(double normal_threshold, double summed_height_threshold) {
    const HeightMap map = half_donut_map(donut_side, donut_side);
    datapath::Registers registers;
    registers.map = {donut_side, donut_side, datapath::AddressMode::clamp, datapath::AddressMode::clamp};
    const auto at = [&](int x, int y) {
        const auto inside = [](int k) { return k < 0 ? 0 : (k > 255 ? 255 : k); };
        return static_cast<double>(std::lround(static_cast<double>(map.at(inside(x), inside(y))) * 65535));
    };
    constexpr double height_per_code = 0.25 / 65536;
    std::vector<std::uint32_t> codes;
    std::vector<datapath::Direction> normals;
    for (int y = 0; y < static_cast<int>(donut_side); ++y) {
        for (int x = 0; x < static_cast<int>(donut_side); ++x) {
            codes.push_back(static_cast<std::uint32_t>(at(x, y)));
            const auto slope = [&](double difference, int place) {
                const double distance = place == 0 || place == 255 ? 1 : 2;
                return height_per_code * difference / distance * texels_per_unit;
            };
            const double du = slope(at(x + 1, y) - at(x - 1, y), x);
            const double dv = slope(at(x, y + 1) - at(x, y - 1), y);
            const double length = std::sqrt(du * du + dv * dv + 1);
            const auto fixed = [&](double value) {
                return static_cast<std::int32_t>(std::lround(value / length * 16384));
            };
            normals.push_back({fixed(-du), fixed(-dv), fixed(1)});
        }
    }
    Tables tables = make_tables(registers, codes, normals);
    registers.displacement.scale = 1 << 14;
    registers.tests.view_test = false;
    registers.tests.normal_threshold = static_cast<std::uint32_t>(std::floor(normal_threshold * 16384));
    registers.tests.height_thresholds[0] = static_cast<std::int64_t>(std::floor(summed_height_threshold * 4));
    return EdgeMachine(registers, std::move(tables));
}

/// A vertex of this plane at texture coordinates given in texels.
inline datapath::Vertex plane_vertex(double u, double v) {
    datapath::Vertex vertex;
    vertex.texture = {static_cast<std::uint32_t>(std::lround(u * 4096)),
                      static_cast<std::uint32_t>(std::lround(v * 4096))};
    const auto world = [](double t) {
        return static_cast<std::int32_t>(std::lround((t / texels_per_unit - 1) * 65536));
    };
    vertex.position = {world(u), world(v), 0};
    vertex.normal = {0, 0, 16384};
    vertex.tangent = {16384, 0, 0};
    return vertex;
}

inline datapath::Triangle triangle_of(const datapath::Vertex& a, const datapath::Vertex& b, const datapath::Vertex& c) {
    datapath::Triangle triangle;
    triangle.vertices = {a, b, c};
    return triangle;
}

/// 3 x 3 squares of two triangles each.
inline std::vector<datapath::Triangle> plane_of_18() {
    const auto line = [](int k) { return k * double{donut_side} / 3; };
    std::vector<datapath::Triangle> base;
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 3; ++x) {
            const datapath::Vertex a = plane_vertex(line(x), line(y)), b = plane_vertex(line(x + 1), line(y));
            const datapath::Vertex c = plane_vertex(line(x + 1), line(y + 1)), d = plane_vertex(line(x), line(y + 1));
            base.push_back(triangle_of(a, b, c));
            base.push_back(triangle_of(a, c, d));
        }
    }
    return base;
}

}  // namespace tessera::testing
