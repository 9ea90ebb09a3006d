#include "testbench/prove/exact_arithmetic/exact_model.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <memory>
#include <stdexcept>

#include "golden/height_tests/summed_height_test.h"
#include "testbench/check/conformance/golden_inputs.h"
#include "testbench/setup/map_displacement.h"
#include "testbench/setup/mesh/whole_periods.h"

namespace tessera {

namespace {

/// Bits of a code for which no sum over the map reaches 2^52, the golden model's limit.
int code_bits(const HeightMap& map) {
    const double texels = static_cast<double>(map.width) * map.height;
    return std::min(32, 51 - static_cast<int>(std::ceil(std::log2(texels))));
}

double highest_code(const HeightMap& map) {
    return std::ldexp(1.0, code_bits(map)) - 1;
}

golden::AddressMode mode_of(Addressing mode) {
    return mode == Addressing::repeat ? golden::AddressMode::repeat : golden::AddressMode::clamp;
}

golden::Map exact_map(const Job& job, const HeightMap& map) {
    const double range = map.range_high - map.range_low;
    std::vector<double> codes;
    codes.reserve(map.values.size());
    for (const float value : map.values) {
        const double part = range > 0 ? (static_cast<double>(value) - map.range_low) / range : 0;
        codes.push_back(std::nearbyint(std::clamp(part, 0.0, 1.0) * highest_code(map)));
    }
    return {map.width, map.height, mode_of(job.map.address_u), mode_of(job.map.address_v), codes};
}

/// Sets the widest normals, since the half vector's register is rounded to their format.
Job with_widest_normals(Job job) {
    job.formats.normal_bits = 18;
    job.formats.normal_fraction = 16;
    return job;
}

/// Rounds up to 2^-30 texels, so that midpoints are exact in a double, and a whole number in rational arithmetic (three
/// quarters of a third of 256 texels) does not end up just below it.
glm::dvec2 exact_texels(const glm::dvec2& t) {
    return glm::ceil(t * 0x1p30) * 0x1p-30;
}

bool within_half_lsb(const golden::Vertex& exact, const datapath::Vertex& rounded, const MachineSetup& setup,
                     const ModelScale& scale) {
    const Dequantise dequantise(setup.registers.formats);
    constexpr double half = 0.5 + 1e-6;
    const double position_lsb = std::ldexp(1.0, -setup.registers.formats.position.fraction);
    const double texture_lsb = std::ldexp(1.0, -setup.registers.formats.texture.fraction);
    const glm::dvec3 p =
        setup.model_scale.to_world(scale.to_model(exact.position)) - dequantise.position(rounded.position);
    const glm::dvec2 t = exact.texture - dequantise.texture(rounded.texture);
    return glm::all(glm::lessThanEqual(glm::abs(p), glm::dvec3(half * position_lsb))) &&
           glm::all(glm::lessThanEqual(glm::abs(t), glm::dvec2(half * texture_lsb)));
}

}  // namespace

ExactModel::ExactModel(const Job& job, const BaseMesh& original, const HeightMap& map) : map_(exact_map(job, map)) {
    const MachineSetup setup = make_setup(with_widest_normals(job), original, map);
    model_scale_ = setup.model_scale;
    parameters_ = golden_parameters(setup.registers);  // transform, enabled tests, diagonal
    const double highest = highest_code(map);
    const MapDisplacement displacement = MapDisplacement::from(job.displacement, map);
    parameters_.scale = displacement.scale * (map.range_high - map.range_low) * model_scale_.scale / highest;
    parameters_.bias = displacement.of(map.range_low) * model_scale_.scale;
    const Job::Tests& tests = job.tests;
    parameters_.normal_threshold = tests.normal_threshold;
    map_.set_height_test(std::make_shared<golden::SummedHeightTest>(
        tests.threshold("summed_height_threshold") * highest, tests.summed_height_unit == SummedHeightUnit::area));
    parameters_.view_threshold = tests.view_threshold;
    parameters_.highlight_cosine = std::cos(tests.highlight_angle * glm::pi<double>() / 180);
    parameters_.highlight_normal_threshold = tests.highlight_normal_threshold;
    map_.derive_normals(parameters_.scale, {setup.texel_size[0], setup.texel_size[1]});

    const double texels = std::ldexp(1.0, static_cast<int>(job.formats.texture_integer));
    const BaseMesh mesh =
        bring_down_texture(original, {job.map.address_u == Addressing::repeat, job.map.address_v == Addressing::repeat},
                           {texels / map.width, texels / map.height});
    base_.reserve(mesh.triangles.size());
    for (const auto& corners : mesh.triangles)
        base_.push_back({base_vertex(mesh.vertices[corners[0]], mesh.beyond_map),
                         base_vertex(mesh.vertices[corners[1]], mesh.beyond_map),
                         base_vertex(mesh.vertices[corners[2]], mesh.beyond_map)});
}

golden::Vertex ExactModel::base_vertex(const BaseVertex& vertex, bool beyond_map) const {
    const glm::dvec2 size(map_.width(), map_.height());
    golden::Vertex result;
    result.position = model_scale_.to_world(vertex.position);
    result.normal = vertex.normal;
    result.tangent = vertex.tangent;
    result.handedness = vertex.handedness < 0 ? -1 : 1;
    result.texture = exact_texels(vertex.texture * size);
    if (!beyond_map && map_.address_u() == golden::AddressMode::clamp)
        result.texture.x = std::clamp(result.texture.x, 0.0, size.x);
    if (!beyond_map && map_.address_v() == golden::AddressMode::clamp)
        result.texture.y = std::clamp(result.texture.y, 0.0, size.y);
    return golden::complete_base_vertex(result, map_, parameters_);
}

std::vector<std::array<golden::Vertex, 3>> ExactModel::corners_of(const MachineSetup& setup) const {
    if (setup.base_dropped == 0)
        return base_;
    std::vector<std::array<golden::Vertex, 3>> result;
    for (const auto& exact : base_) {
        if (result.size() == setup.base_triangles.size())
            break;
        const auto& rounded = setup.base_triangles[result.size()].vertices;
        if (within_half_lsb(exact[0], rounded[0], setup, model_scale_) &&
            within_half_lsb(exact[1], rounded[1], setup, model_scale_) &&
            within_half_lsb(exact[2], rounded[2], setup, model_scale_))
            result.push_back(exact);
    }
    if (result.size() != setup.base_triangles.size())
        throw std::logic_error("exact model: a base triangle was not found in the exact model");
    return result;
}

}  // namespace tessera
