#include "testbench/check/conformance/golden_job.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "testbench/check/conformance/golden_inputs.h"
#include "testbench/check/conformance/height_test_check.h"
#include "testbench/machine/resolve_job.h"

namespace tessera {

namespace {

glm::dvec3 vector(const std::array<double, 3>& a) {
    return {a[0], a[1], a[2]};
}

/// Golden's own heights; empty if all of the source's values are heights.
std::vector<float> own_heights(const Job& job, const HeightMap& map) {
    if (map.replaced.empty() && job.map.no_data.empty())
        return {};
    std::vector<float> source = map.values;
    for (const HeightMap::Replaced& replaced : map.replaced)
        source[replaced.texel] = replaced.was;
    return golden::heights_of(std::move(source), {job.map.no_data, map.source_units, map.significant_bits});
}

std::array<double, 2> range_of(const std::vector<float>& heights) {
    const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
    return {*low, *high};
}

/// The values of the lowest and the highest code.
std::array<double, 2> code_range_of(const Job& job, const HeightMap& map, const std::vector<float>& heights) {
    const bool whole_format = map.range_low == 0 && map.range_high == 1 && job.map.range.kind == MapRange::Kind::full;
    return whole_format ? std::array<double, 2>{0, 1} : range_of(heights);
}

/// The range of map values that displacement.scale spans, from map.range.
std::array<double, 2> span_of(const Job& job, const HeightMap& map, const std::vector<float>& heights) {
    if (job.map.range.kind == MapRange::Kind::full)
        return {0, 1};
    if (job.map.range.kind == MapRange::Kind::given)
        return {job.map.range.low / map.source_units, job.map.range.high / map.source_units};
    return range_of(heights);
}

/// The displacement of a map value, in model units.
double displacement_of(double value, const Job& job, const std::array<double, 2>& span) {
    const auto [low, high] = span;
    const double part = high > low ? (value - low) / (high - low) : 0;
    return job.displacement.bias + job.displacement.scale * part;
}

golden::BaseFrames frames_of(const BaseMesh& mesh) {
    std::vector<golden::BasePoint> points;
    points.reserve(mesh.vertices.size());
    for (const BaseVertex& vertex : mesh.vertices)
        points.push_back({vertex.position, vertex.normal, vertex.texture});
    return golden::derive_frames(points, mesh.triangles);
}

/// `size`: of the whole map, model units.
glm::dvec2 texel_size(const glm::dvec2& size, const HeightMap& map, double scale) {
    return scale * size / glm::dvec2(map.width, map.height);
}

/// Whole texels; with interpolated heights half texels, on the axes that texture coordinates can halve.
double texel_parts(const Job::Formats& formats, golden::Filter filter) {
    if (formats.tex_coord_fraction >= 0)
        return std::ldexp(1.0, static_cast<int>(formats.tex_coord_fraction));
    return filter == golden::Filter::bilinear && formats.texture_fraction > 0 ? 2 : 1;
}

golden::Scene make_scene(const Job& job, const glm::dvec2& size, const HeightMap& map,
                         const std::vector<float>& heights, const std::array<double, 2>& code_range,
                         const ModelScale& model_scale) {
    golden::Scene scene;
    const Job::Camera& camera = job.camera;
    scene.camera = {vector(camera.eye),   vector(camera.target), vector(camera.up),
                    camera.field_of_view, camera.near_plane,     {camera.viewport_width, camera.viewport_height}};
    scene.placement = {model_scale.centre, model_scale.scale};
    const glm::dvec2 texel = texel_size(size, map, model_scale.scale);
    scene.texel_area = texel.x * texel.y;
    const std::array<double, 2> span = span_of(job, map, heights);
    scene.lowest = displacement_of(code_range[0], job, span);
    scene.highest = displacement_of(code_range[1], job, span);
    scene.highest_code = std::ldexp(1.0, static_cast<int>(job.formats.displacement_bits)) - 1;

    const Job::Tests& tests = job.tests;
    scene.normal_threshold = tests.normal_threshold;
    scene.view_threshold = tests.view_threshold;
    scene.generation_limit = static_cast<int>(tests.generation_limit);
    scene.highlight_angle = tests.highlight_angle;
    scene.highlight_normal_threshold = tests.highlight_normal_threshold;
    scene.enabled = {tests.normal, tests.summed_height, tests.view, tests.tex_coord, tests.generation, tests.highlight};
    scene.diagonal = golden_diagonal(job.hardware.triangulation);
    scene.filter = golden_filter(job.hardware.displacement_filter);
    scene.texel_parts = texel_parts(job.formats, scene.filter);
    scene.light = vector(job.hardware.light);
    return scene;
}

golden::Map make_map(const Job& job, const HeightMap& height_map, const std::vector<float>& heights,
                     const std::array<double, 2>& code_range, const glm::dvec2& size, const golden::Scene& scene,
                     double scale_per_code) {
    std::vector<double> codes;
    codes.reserve(heights.size());
    for (const float height : heights)
        codes.push_back(std::floor(golden::code_of(height, code_range[0], code_range[1], scene.highest_code) + 0.5));
    golden::Map map(height_map.width, height_map.height, golden_mode(job.map.address_u), golden_mode(job.map.address_v),
                    codes);
    map.derive_normals(scale_per_code, texel_size(size, height_map, scene.placement.scale));
    return map;
}

const Job& resolved(const Job& job) {
    require_resolved(job, "GoldenJob");
    return job;
}

}  // namespace

GoldenJob::GoldenJob(const Job& job, const BaseMesh& mesh, const HeightMap& height_map, const ModelScale& model_scale,
                     const TakenFromHost& taken)
    : job_(resolved(job)),
      mesh_(mesh),
      height_map_(height_map),
      frames_(frames_of(mesh)),
      own_heights_(own_heights(job_, height_map)),
      code_range_(code_range_of(job_, height_map, heights())),
      view_distance_fraction_(taken.view_distance_fraction),
      scene_(make_scene(job_, frames_.size, height_map, heights(), code_range_, model_scale)),
      parameters_(golden::make_parameters(scene_)),
      map_(make_map(job_, height_map, heights(), code_range_, frames_.size, scene_, parameters_.scale)) {
    set_heights(map_, taken.fitted_heights);
    map_.set_height_test(check_of(job_.hardware.height_test).of_job(*this, taken));
}

golden::Vertex GoldenJob::vertex(std::uint32_t triangle, std::size_t corner) const {
    const BaseVertex& given = mesh_.vertices[mesh_.triangles[triangle][corner]];
    const golden::Frame& frame = frames_.corners[triangle][corner];
    golden::Vertex vertex;
    vertex.position = given.position;
    vertex.normal = given.normal;
    vertex.tangent = frame.tangent;
    vertex.handedness = frame.handedness;
    return golden::place_vertex(vertex, given.texture, scene_.placement, map_, mesh_.beyond_map);
}

glm::dvec2 GoldenJob::texel_size() const {
    return tessera::texel_size(frames_.size, height_map_, scene_.placement.scale);
}

double GoldenJob::unrounded_code(std::size_t texel) const {
    return golden::code_of(heights()[texel], code_range_[0], code_range_[1], scene_.highest_code);
}

}  // namespace tessera
