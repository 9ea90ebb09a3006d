#pragma once
#include <cstdint>

#include "modules/datapath/format.h"

namespace tessera::datapath {

/// Bits per item of each stream, the cost of a design's buses and buffers.
struct Widths {
    std::uint32_t base_vertex = 0;      ///< host to Get Triangle: P, N, T, handedness, t
    std::uint32_t vertex = 0;           ///< in the Triangle Queue: all fields of a vertex
    std::uint32_t triangle = 0;         ///< Triangle Queue entry: describe_triangle
    std::uint32_t emitted_vertex = 0;   ///< to Lighting: P's, N's, t
    std::uint32_t finished_vertex = 0;  ///< a vertex of the tessellated mesh, if the host sent it: P', N', t
};

constexpr Widths stream_widths(const Formats& f) {
    const auto bits = [](int value) { return static_cast<std::uint32_t>(value); };
    const std::uint32_t position = bits(3 * f.position.bits);
    const std::uint32_t direction = bits(3 * f.normal.bits);
    const std::uint32_t texture = bits(2 * f.texture.bits);
    const std::uint32_t screen = bits(2 * f.screen.bits + f.view_distance.bits + 1);
    const std::uint32_t distance = bits(f.distances ? f.view_distance.bits : 0);
    constexpr std::uint32_t handedness = 1;
    constexpr std::uint32_t known = 2;  // P', P's, N' known; N's known
    Widths widths;
    widths.base_vertex = position + 2 * direction + handedness + texture;
    widths.vertex = widths.base_vertex + bits(f.generation_bits) + known + position + 2 * direction + screen +
                    distance + bits(f.codes ? f.displacement.bits : 0);
    widths.triangle = 3 * widths.vertex + (f.highlight_tag ? 3 : 2) + 3 + 1 + (f.final_edges ? 3 : 0) +
                      (f.families ? 3 + 9 * direction : 0) + (f.families && f.height_test == HeightTest::rank ? 3 : 0);
    widths.emitted_vertex = screen + direction + texture;
    widths.finished_vertex = position + direction + texture;
    return widths;
}

}  // namespace tessera::datapath
