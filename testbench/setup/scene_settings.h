#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include "modules/datapath/parameters.h"
#include "testbench/setup/height_thresholds.h"

namespace tessera {

/// A number, or vector component, that has not been set.
inline constexpr double automatic = std::numeric_limits<double>::quiet_NaN();
inline constexpr std::array<double, 3> automatic_vector{automatic, automatic, automatic};

inline bool is_automatic(double value) {
    return std::isnan(value);
}
inline bool is_automatic(const std::array<double, 3>& value) {
    return std::isnan(value[0]) && std::isnan(value[1]) && std::isnan(value[2]);
}

/// Conversion of a map value to a height along the normal.
struct DisplacementSettings {
    double scale = automatic;  ///< model units from the map's low to its high end
    double bias = 0;           ///< model units at the low end
};

/// The camera, used by the View Test.
struct CameraSettings {
    std::array<double, 3> eye = automatic_vector;     ///< model units
    std::array<double, 3> target = automatic_vector;  ///< model units
    std::array<double, 3> up = automatic_vector;      ///< of any length
    double field_of_view = 36;                        ///< vertical, degrees
    double near_plane = automatic;                    ///< distance from the eye, model units
    std::int64_t viewport_width = 1024;               ///< pixels
    std::int64_t viewport_height = 768;
};

/// The measure of the Rank Test's thresholds.
enum class RankView : std::uint8_t {
    none,       ///< errors of the surface, independent of the view
    per_point,  ///< as seen: equal weight for every point of the map
    per_pixel,  ///< as seen: equal weight for every pixel covered
};

/// The height of a block of a mipmap. The paper names both without more detail (2.3.1): "mipmapping ... but with a
/// maximal filter".
enum class MipmapFilter : std::uint8_t {
    mean,    ///< of its texels, rounded to nearest, halves up
    maximum  ///< of its texels
};

/// The edge tests: split = (normal or summed_height or highlight) and view and tex_coord and generation. summed_height:
/// or the test that replaces it (SceneOptions::height_test).
struct TestSettings {
    bool normal = true;
    double normal_threshold = 0.12;  ///< difference of one component of two unit normals
    bool summed_height = true;
    HeightThresholds thresholds;  ///< of summed_height, or the test that replaces it
    datapath::SummedHeightUnit summed_height_unit = datapath::SummedHeightUnit::sum;
    RankView rank_view = RankView::none;
    MipmapFilter mipmap_filter = MipmapFilter::mean;
    bool view = true;
    double view_threshold = 5;  ///< pixels, Manhattan
    bool tex_coord = true;
    bool generation = true;
    std::int64_t generation_limit = 12;
    bool highlight = false;
    double highlight_angle = 25;               ///< degrees from the half vector
    double highlight_normal_threshold = 0.05;  ///< difference of one component of two unit normals

    /// One of `thresholds`, by its key: threshold("summed_height_threshold").
    double& threshold(std::string_view key) { return thresholds[key]; }
    double threshold(std::string_view key) const { return thresholds[key]; }
};

/// Fixed-point formats; bits include the sign, if any.
struct FormatSettings {
    std::int64_t position_bits = 32, position_fraction = 16;
    std::int64_t normal_bits = 16, normal_fraction = 14;
    std::int64_t texture_integer = 12, texture_fraction = 12;
    std::int64_t tex_coord_fraction = -1;  ///< bits the Tex Coord Test compares; -1: 1 if bilinear, else 0
    std::int64_t displacement_bits = 16;
    std::int64_t summed_height_bits = 0;  ///< 0: the narrowest of 32, 40, 48 that the mesh needs
    std::int64_t screen_bits = 24, screen_fraction = 8;
    std::int64_t generation_bits = 4;
    std::int64_t rank_bits = 8;   ///< of the Rank Table's entries; 0: no ranks
    std::int64_t bound_bits = 0;  ///< likewise: bounds
};

enum class Culling : std::uint8_t { none, back };

/// What the machine computes, besides the tests' switches and thresholds.
struct SceneOptions {
    datapath::Triangulation triangulation = datapath::Triangulation::shorter;
    datapath::HeightTest height_test = datapath::HeightTest::summed_height;
    Culling culling = Culling::none;
    bool final_edges = false;         ///< edges that are known not to split are not tested again
    bool one_texel_from_map = false;  ///< vertices carry their displacement codes, for a Summed Height Test
    datapath::MapFilter displacement_filter = datapath::MapFilter::nearest;
    std::array<double, 3> light{0.3, -0.4, 0.866};  ///< direction towards the light, world space, of any length
    double ambient = 0.2;                           ///< light on every surface, fraction of full scale
};

/// The inputs of the registers besides mesh and map. Ranges: those of the keys (testbench/job/README.md).
struct SceneSettings : SceneOptions {
    DisplacementSettings displacement;
    CameraSettings camera;
    TestSettings tests;
    FormatSettings formats;
    datapath::AddressMode address_u = datapath::AddressMode::clamp;  ///< outside the map's left and right border
    datapath::AddressMode address_v = datapath::AddressMode::clamp;  ///< outside its lower and upper border
    bool families = false;                                           ///< Design::work is Work::family
};

}  // namespace tessera
