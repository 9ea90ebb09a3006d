#pragma once
#include <cstddef>
#include <cstdint>

namespace tessera {

// Limits of a base mesh. Beyond the first five: ResourceError; beyond grid, size and coordinate: InputError.

constexpr std::size_t largest_base_triangles = 4'000'000;
constexpr std::size_t largest_face_corners = 65'536;             ///< corners of one polygon in a file
constexpr std::size_t largest_obj_records = 16'000'000;          ///< `v` lines in a file; the same for `vt` and `vn`
constexpr std::size_t largest_mesh_file = std::size_t{1} << 30;  ///< bytes
/// Point-in-triangle tests for all polygons of a file that are not convex: a few seconds.
constexpr std::uint64_t largest_cutting_work = 1'000'000'000;
/// Steps of the search for T-junctions, a few seconds. Beyond, the search stops and the mesh is still accepted.
constexpr std::uint64_t largest_search = 50'000'000;

constexpr std::int64_t largest_grid = 4096;                   ///< columns or rows of a built-in mesh
constexpr double smallest_size = 1e-30, largest_size = 1e30;  ///< width, depth, radius, height: model units
constexpr double largest_coordinate = 3.4028234663852886e38;  ///< in a file: the limit of single precision

}  // namespace tessera
