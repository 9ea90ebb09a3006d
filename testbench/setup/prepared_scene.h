#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"
#include "testbench/setup/quantised_map.h"
#include "testbench/setup/scene_settings.h"
#include "testbench/setup/tables/curvature_table.h"
#include "testbench/setup/tables/mipmap_table.h"
#include "testbench/setup/tables/rank_table.h"

namespace tessera {

/// Host values that did not fit their format and were saturated. fit_model() leaves room, so normally there are none.
struct InputSaturations {
    std::uint64_t position = 0;   ///< components of base vertices
    std::uint64_t normal = 0;     ///< components of base vertices' normals and tangents
    std::uint64_t registers = 0;  ///< displacement's scale and bias, directions of view and light
};

/// Sizes and axes of texels on the triangles against the one size, with perpendicular axes, that the normal map is made for,
/// and what it does to N'.
struct TexelSpread {
    static constexpr double noticeable = 2;  ///< degrees; what N' of a mesh with one size is right to

    std::array<double, 2> mean{1, 1}, smallest{1, 1}, largest{1, 1};  ///< |dp/du|, |dp/dv|: model units per map
    double shear = 0;                                                 ///< most that dp/du, dp/dv miss 90 degrees by
    double median_error = 0, largest_error = 0;                       ///< of N', degrees
    double wrong_percent = 0;      ///< of the surface, where N' is off by more than `noticeable`
    double wrong_map_percent = 0;  ///< of the map's area on it

    /// The part of the error that is due to displacements along diverging or converging normals, likewise.
    double curved_median = 0, curved_largest = 0, curved_percent = 0;
};

/// The host's data: everything rounded to the hardware's formats.
struct PreparedScene {
    datapath::Registers registers;
    QuantisedMap map;
    /// The displacement map's contents if they differ from the map's codes; else empty.
    std::vector<std::uint16_t> fitted_heights;
    std::vector<datapath::Triangle> base_triangles;
    RankTables rank_tables;          ///< with a Rank Test
    CurvatureTable curvature_table;  ///< with a Curvature Test
    MipmapTable mipmap_table;        ///< with a Mipmap Test

    /// The machine's world = scale * (model - centre); scale is a power of two.
    double scale = 1;
    std::array<double, 3> centre{};

    double height_per_code = 0;              ///< world units: S * code / 2^bits, S as rounded
    std::array<double, 2> texel_size{1, 1};  ///< world size of a texel along u and v

    std::uint64_t largest_rectangle_sum = 0;  ///< bound on any rectangle's sum over this mesh, in codes
    std::uint64_t base_dropped = 0;           ///< triangles of which two vertices coincide after rounding
    std::uint64_t texture_clamped = 0;        ///< vertices whose u or v lay outside a clamped map
    InputSaturations input_saturations;
    TexelSpread texel_spread;
    std::vector<std::string> remarks;  ///< one sentence each, for a report
    bool bound_asked = false;          ///< tests.bound_threshold is asked for
    bool bound_promised = false;       ///< and all its conditions are met (bound_promise.h)

    /// The displacement map's contents. All other tables are made from `map`.
    const std::vector<std::uint16_t>& heights() const { return fitted_heights.empty() ? map.codes : fitted_heights; }
};

/// Receives bytes for an address of the machine's memory.
using TableSink = std::function<void(std::uint64_t address, const unsigned char* bytes, std::size_t count)>;

/// Writes the displacement map, the normal map and the height test's table, row by row, little endian, at the addresses
/// of the registers' layouts.
void write_tables(const PreparedScene& scene, const TableSink& sink);
/// The last of these. Throws InputError if the test's part writes what the table does not hold.
void write_height_table(const PreparedScene& scene, const TableSink& sink);

}  // namespace tessera
