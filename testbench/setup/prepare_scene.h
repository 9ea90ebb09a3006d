#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "testbench/setup/prepared_scene.h"
#include "testbench/setup/scene_settings.h"

namespace tessera {

struct SceneVertex {
    std::array<double, 3> position{};  ///< model units
    std::array<double, 2> texture{};   ///< u, v; 0..1 spans the map once, v = 0 is its bottom row
    std::array<double, 3> normal{};    ///< of any length; zero: a smooth normal is calculated
};

/// A base mesh, a displacement map, and the view.
struct Scene {
    std::vector<SceneVertex> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< vertex indices, counter-clockwise from outside

    int map_width = 0, map_height = 0;  ///< texels
    std::vector<float> map;             ///< row by row, bottom row first
    double map_low = 0, map_high = 1;   ///< values of the lowest and the highest displacement code

    SceneSettings settings;  ///< displacement.scale and camera.eye, target, up, near_plane have no default
};

/// Rounds a scene to the hardware's formats. Tangents are derived from the texture coordinates; triangles without area
/// are dropped, with a remark. Throws InputError (testbench/common/error.h) with value, limit and remedy: a vertex
/// index out of range, a number that is not finite, a map of another size, a setting that is not set or out of range,
/// or a value that does not fit its format.
PreparedScene prepare(const Scene& scene);

}  // namespace tessera
