#include "testbench/check/conformance/golden_inputs.h"

#include <cstdint>
#include <utility>

#include "testbench/check/conformance/height_test_check.h"

namespace tessera {

golden::AddressMode golden_mode(datapath::AddressMode mode) {
    return mode == datapath::AddressMode::repeat ? golden::AddressMode::repeat : golden::AddressMode::clamp;
}

golden::Diagonal golden_diagonal(datapath::Triangulation choice) {
    switch (choice) {
        case datapath::Triangulation::first: return golden::Diagonal::first;
        case datapath::Triangulation::second: return golden::Diagonal::second;
        case datapath::Triangulation::greatest_rank: return golden::Diagonal::greatest_rank;
        case datapath::Triangulation::shorter: break;
    }
    return golden::Diagonal::shorter;
}

golden::Filter golden_filter(datapath::MapFilter filter) {
    return filter == datapath::MapFilter::bilinear ? golden::Filter::bilinear : golden::Filter::nearest;
}

void set_heights(golden::Map& map, const std::vector<std::uint16_t>& fitted) {
    if (!fitted.empty())
        map.set_heights({fitted.begin(), fitted.end()});
}

namespace {

golden::Map golden_map(const MachineSetup& setup) {
    const datapath::MapGeometry& geometry = setup.map.geometry;
    golden::Map map(static_cast<int>(geometry.width), static_cast<int>(geometry.height),
                    golden_mode(geometry.address_u), golden_mode(geometry.address_v),
                    std::vector<double>(setup.map.codes.begin(), setup.map.codes.end()));
    const Dequantise dequantise(setup.registers.formats);
    std::vector<glm::dvec3> normals;
    normals.reserve(setup.map.codes.size());
    for (std::uint32_t y = 0; y < geometry.height; ++y)
        for (std::uint32_t x = 0; x < geometry.width; ++x)
            normals.push_back(dequantise.direction(
                map_normal(setup.map, x, y, setup.height_per_code, setup.texel_size, setup.registers.formats.normal)));
    map.set_normals(std::move(normals));
    set_heights(map, setup.fitted_heights);
    map.set_height_test(check_of(setup.registers.formats.height_test).of_machine(setup, map));
    return map;
}

}  // namespace

golden::Parameters golden_parameters(const datapath::Registers& registers) {
    const datapath::Formats& formats = registers.formats;
    const datapath::TestParameters& tests = registers.tests;
    const datapath::TransformParameters& transform = registers.transform;
    const auto real = [](auto value, int fraction) { return std::ldexp(static_cast<double>(value), -fraction); };
    const int position = formats.position.fraction;

    golden::Parameters result;
    result.scale = real(registers.displacement.scale, position + formats.displacement.bits);
    result.bias = real(registers.displacement.bias, position);

    result.normal_threshold = real(tests.normal_threshold, formats.normal.fraction);
    if (formats.distances) {
        const auto& eye = transform.eye;
        result.eye = glm::dvec3(eye[0], eye[1], eye[2]) * std::ldexp(1.0, -position);
        result.distance_step = std::ldexp(1.0, -formats.view_distance.fraction);
    }
    result.view_threshold = real(tests.view_threshold, formats.screen.fraction);
    result.generation_limit = static_cast<int>(tests.generation_limit);
    const int normal = formats.normal.fraction;
    const auto& half = tests.half_vector;
    result.half_vector = {real(half[0], normal), real(half[1], normal), real(half[2], normal)};
    result.highlight_cosine = real(tests.highlight_cosine, 2 * normal);
    result.highlight_normal_threshold = real(tests.highlight_normal_threshold, normal);
    result.enabled = {tests.normal_test,    tests.summed_height_test, tests.view_test,
                      tests.tex_coord_test, tests.generation_test,    tests.highlight_test};
    result.diagonal = golden_diagonal(registers.triangulation);
    result.filter = golden_filter(formats.filter);
    result.texel_parts = std::ldexp(1.0, formats.tex_coord_fraction);

    const int matrix = datapath::TransformParameters::matrix_fraction;
    const auto row = [&](const std::array<std::int64_t, 4>& r, int exponent) {
        return glm::dvec4(real(r[0], matrix - exponent), real(r[1], matrix - exponent), real(r[2], matrix - exponent),
                          real(r[3], matrix + position - exponent));
    };
    result.row_x = row(transform.row_x, transform.exponent);
    result.row_y = row(transform.row_y, transform.exponent);
    result.row_w = row(transform.row_w, 0);
    result.near_plane = real(transform.near_plane, matrix + position);
    return result;
}

GoldenInputs::GoldenInputs(const MachineSetup& setup)
    : map(golden_map(setup)), parameters(golden_parameters(setup.registers)) {}

std::vector<std::array<golden::Vertex, 3>> golden_base_triangles(const MachineSetup& setup) {
    const Dequantise dequantise(setup.registers.formats);
    std::vector<std::array<golden::Vertex, 3>> result;
    result.reserve(setup.base_triangles.size());
    for (const datapath::Triangle& triangle : setup.base_triangles) {
        const auto& v = triangle.vertices;
        result.push_back({dequantise.vertex(v[0]), dequantise.vertex(v[1]), dequantise.vertex(v[2])});
    }
    return result;
}

}  // namespace tessera
