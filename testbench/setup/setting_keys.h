#pragma once
#include "modules/datapath/format.h"
#include "testbench/setup/height_tests/height_test_host.h"
#include "testbench/setup/key_range.h"
#include "testbench/setup/scene_settings.h"

// The ranges, units and meanings of SceneSettings' members: keys of a job file, checked by check_settings(), too.
//
//   key.add(name, member, description)                a flag or a choice
//   key.add(name, member, unit, range, description)   a number, or a vector: the range of its components
//   key.add_double(name, member, ...)                 likewise; member(settings) is a reference to the number

namespace tessera {

// clang-format off
template <typename Keys>
void declare_displacement_keys(const Keys& key) {
    key.add("scale", &DisplacementSettings::scale, "model units", auto_or(coordinate_range), "Difference in height between the low and the high end of map.range; auto: an eighth of the base mesh's largest extent if the mesh is flat (its smallest extent less than a tenth of the next), else a fortieth; reduced if values lie outside map.range, so that the highest displacement stays the same");
    key.add("bias", &DisplacementSettings::bias, "model units", coordinate_range, "Height at the low end of map.range");
}

template <typename Keys>
void declare_camera_keys(const Keys& key) {
    key.add("eye", &CameraSettings::eye, "model units", auto_or(coordinate_range), "Position of the camera; auto: 20 degrees to the right of the front and 38 degrees above it, at the distance at which the bounding box of the displaced model fits into 90 % of the picture's width and height. The front is -y, or z if up is y");
    key.add("target", &CameraSettings::target, "model units", auto_or(coordinate_range), "Point that the camera looks at; auto: the centre of that bounding box");
    key.add("up", &CameraSettings::up, "-", auto_or(coordinate_range), "Direction that points up in the picture, of any length; auto: for an OBJ file y, or if it is flat the axis perpendicular to it, on the side of its normals; for a run on an OBJ file (or on a run) the earlier run's camera.up; for any other source z. If the camera looks along that axis, the direction away from the model's front");
    key.add("field_of_view", &CameraSettings::field_of_view, "degrees", between(0.1, 179), "Vertical field of view");
    key.add("near_plane", &CameraSettings::near_plane, "model units", auto_or(distance_range), "Distance of the near plane; vertices on or behind it have no screen position; auto: a thousandth of the distance from eye to target");
    key.add("viewport_width", &CameraSettings::viewport_width, "pixels", between(1, 16384), "Width of the picture");
    key.add("viewport_height", &CameraSettings::viewport_height, "pixels", between(1, 16384), "Height of the picture");
}

template <typename Keys>
void declare_tests_keys(const Keys& key) {
    key.add("normal", &TestSettings::normal, "Normal Test; off: never requests a split");
    key.add("normal_threshold", &TestSettings::normal_threshold, "unit normal component", between(0, 2), "Normal Test: an edge requests a split if a component of two of its normals differs by more");
    key.add("summed_height", &TestSettings::summed_height, "Summed Height Test, or its replacement (hardware.height_test); off: never requests a split");
    for (const HeightTestHost* host : height_test_hosts())
        for (const HeightThresholdKey& it : host->thresholds())
            key.add_double(it.name, [name = it.name](auto& tests) -> decltype(auto) { return tests.threshold(name); }, it.unit, it.range, it.meaning);
    key.add("summed_height_unit", &TestSettings::summed_height_unit, "Quantity that the threshold is compared with: sums over rectangles, or the second difference of their mean heights (area)");
    key.add("rank_view", &TestSettings::rank_view, "With hardware.height_test = \"rank\": the error that its thresholds measure. none: on the surface; per_point, per_pixel: in the picture, in pixels, so that triangles are smaller nearer to camera.eye, with each point of the map, or each pixel, weighted equally. The latter two need hardware.test_order = \"cheap_first\"");
    key.add("mipmap_filter", &TestSettings::mipmap_filter, "With hardware.height_test = \"mipmap\": height of a block of texels, their mean or their maximum");
    key.add("view", &TestSettings::view, "View Test; off: allows every split");
    key.add("view_threshold", &TestSettings::view_threshold, "pixels", between(0, 1e6), "View Test: only an edge that is longer on the screen (Manhattan length) may be split");
    key.add("tex_coord", &TestSettings::tex_coord, "Tex Coord Test: stops at the map's resolution; off: allows every split");
    key.add("generation", &TestSettings::generation, "Generation Test; off: allows every split, so that a run may never end");
    key.add("generation_limit", &TestSettings::generation_limit, "generations", between(0, 15), "Generation Test: largest generation of a new vertex, at most 2^formats.generation_bits - 1");
    key.add("highlight", &TestSettings::highlight, "Highlight Test, for per-vertex lighting: smaller triangles in the Phong highlight of hardware.light; off: the design has no Highlight Test");
    key.add("highlight_angle", &TestSettings::highlight_angle, "degrees", between(0, 90), "Highlight Test: a normal lies in the highlight if it is within this angle of the half vector between the directions to the light and to the viewer (camera.eye - camera.target)");
    key.add("highlight_normal_threshold", &TestSettings::highlight_normal_threshold, "unit normal component", between(0, 2), "Highlight Test: an edge with a normal in the highlight requests a split if a component of two of its normals differs by more");
}

template <typename Keys>
void declare_formats_keys(const Keys& key) {
    using Limits = datapath::FormatLimits;
    const auto within = [](const Limits::Range& range) { return between(range.least, range.most); };
    key.add("position_bits", &FormatSettings::position_bits, "bits", within(Limits::position_bits), "Positions, signed");
    key.add("position_fraction", &FormatSettings::position_fraction, "bits", within(Limits::position_fraction), "Positions: fraction bits, fewer than position_bits");
    key.add("normal_bits", &FormatSettings::normal_bits, "bits", within(Limits::normal_bits), "Components of normals and tangents, signed");
    key.add("normal_fraction", &FormatSettings::normal_fraction, "bits", within(Limits::normal_fraction), "Normals: fraction bits, at least 2 fewer than normal_bits");
    key.add("texture_integer", &FormatSettings::texture_integer, "bits", within(Limits::texture_integer), "Texture coordinates, unsigned, in texels: integer bits");
    key.add("texture_fraction", &FormatSettings::texture_fraction, "bits", within(Limits::texture_fraction), "Texture coordinates: fraction bits");
    key.add("tex_coord_fraction", &FormatSettings::tex_coord_fraction, "bits", between(-1, Limits::tex_coord_fraction.most), "Tex Coord Test: fraction bits of the texture coordinates it compares, at most texture_fraction. 0 (the paper's): it stops at texels; 1: at half texels; -1: 1 with hardware.displacement_filter = \"bilinear\", whose heights vary within texels, else 0");
    key.add("displacement_bits", &FormatSettings::displacement_bits, "bits", within(Limits::displacement_bits), "Displacement map, unsigned");
    key.add("summed_height_bits", &FormatSettings::summed_height_bits, "bits", zero_or_between(Limits::summed_height_bits.least, Limits::summed_height_bits.most), "Summed Height Table, unsigned; 0: the least of 32, 40 and 48 that the mesh needs");
    key.add("screen_bits", &FormatSettings::screen_bits, "bits", within(Limits::screen_bits), "Screen positions, signed, in pixels");
    key.add("screen_fraction", &FormatSettings::screen_fraction, "bits", within(Limits::screen_fraction), "Screen positions: fraction bits, fewer than screen_bits");
    key.add("rank_bits", &FormatSettings::rank_bits, "bits", zero_or_between(Limits::rank_bits.least, Limits::rank_bits.most), "Rank Table: width of a rank; 0: the table has none");
    key.add("bound_bits", &FormatSettings::bound_bits, "bits", zero_or_between(Limits::bound_bits.least, Limits::bound_bits.most), "Rank Table: width of a bound; 0: the table has none");
    key.add("generation_bits", &FormatSettings::generation_bits, "bits", within(Limits::generation_bits), "Generation of a vertex, unsigned");
}

template <typename Keys>
void declare_scene_keys(const Keys& key) {
    key.add("triangulation", &SceneOptions::triangulation, "Diagonal when two edges split: the shorter one, or always the first or the second; greatest_rank, with hardware.height_test = \"rank\": only the edge of greatest rank is split, of those that request it");
    key.add("height_test", &SceneOptions::height_test, meaning_of_height_tests());
    key.add("culling", &SceneOptions::culling, "Back-face culling of finished triangles");
    key.add("final_edges", &SceneOptions::final_edges, "An edge that was tested in a parent and not split is not tested again in its children; off: the paper's; the mesh is the same");
    key.add("one_texel_from_map", &SceneOptions::one_texel_from_map, "Vertices carry their displacement codes; for rectangles of one texel, the Summed Height Test uses these and one read of the displacement map instead of the Summed Height Table; off: the paper's; the mesh is the same");
    key.add("displacement_filter", &SceneOptions::displacement_filter, "Filter of the displacement map and the normal map. nearest: the texel under a vertex (the paper's); bilinear: between the four texels around it, which gives another surface and takes four reads instead of one");
    key.add("light", &SceneOptions::light, "-", coordinate_range, "Direction towards the light, world space, of any length");
    key.add("ambient", &SceneOptions::ambient, "full scale", between(0, 1), "Ambient light");
}

// clang-format on

}  // namespace tessera
