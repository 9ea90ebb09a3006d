#include "testbench/setup/prepare_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "modules/datapath/registers.h"
#include "testbench/common/error.h"
#include "testbench/setup/base_triangles.h"
#include "testbench/setup/formats.h"
#include "testbench/setup/height_tests/height_test_host.h"
#include "testbench/setup/light.h"
#include "testbench/setup/map_displacement.h"
#include "testbench/setup/mesh/triangle_geometry.h"
#include "testbench/setup/model_scale.h"
#include "testbench/setup/table_layout.h"
#include "testbench/setup/tables/table_extent.h"
#include "testbench/setup/texel_spread.h"
#include "testbench/setup/thresholds.h"
#include "testbench/setup/view.h"

namespace tessera {

namespace {

/// The keys to change if a value does not fit its register.
const char* remedy(std::string_view register_name) {
    if (register_name == "map.width" || register_name == "map.height")
        return "use a smaller map or raise formats.texture_integer";
    if (register_name == "tests.generation_limit")
        return "lower tests.generation_limit or raise formats.generation_bits";
    return "change the value or the formats that determine it";
}

/// Checks that every value fits its register.
void check_registers(const datapath::Registers& registers) {
    datapath::visit_registers(registers, [](const datapath::Register& field, const auto& values) {
        for (const std::int64_t value : values)
            if (!datapath::holds(field, value))
                throw InputError(fmt::format("the register {} has {} bits and cannot hold {}: {}", field.name,
                                             field.bits, value, remedy(field.name)));
    });
}

/// Makes the height test's table, unless it is written from the map alone.
void make_height_table(const TestSettings& tests, PreparedScene& scene) {
    datapath::Registers& registers = scene.registers;
    std::vector<TextureTriangle> base;
    for (const datapath::Triangle& triangle : scene.base_triangles) {
        const auto& v = triangle.vertices;
        base.push_back({v[0].texture, v[1].texture, v[2].texture});
    }
    const datapath::MapGeometry covered = table_extent(registers.map, base, registers.formats);
    registers.covered = {covered.width, covered.height};
    host_of(registers.formats.height_test).make_table(tests, base, scene);
}

/// The default, if that is enough: the run's checks compare with positions that are not rounded.
double usual_or_more(double position_bits) {
    return std::max(position_bits, static_cast<double>(FormatSettings{}.position_bits));
}

/// A sentence if the surface's relief is mostly the rounding of its positions; else empty.
std::string relief_remark(const HeightMap& map, const DisplacementSettings& settings, double scale,
                          const datapath::Format& position) {
    constexpr double fewest_steps = 16;
    const auto [lowest, highest] = map.extremes();
    const MapDisplacement displacement = MapDisplacement::from(settings, map);
    const double low = displacement.of(lowest), high = displacement.of(highest);
    const double steps = std::ldexp(std::abs(high - low) * scale, position.fraction);
    if (steps == 0 || steps >= fewest_steps)
        return {};
    const double bits = position.bits + std::ceil(std::log2(fewest_steps / steps));
    return fmt::format(
        "the map's displacements, {:.6g} to {:.6g} model units, span {:.2g} steps of the positions' "
        "format, to which they are rounded: {}",
        std::min(low, high), std::max(low, high), steps,
        bits <= datapath::FormatLimits::position_bits.most
            ? fmt::format("set formats.position_bits = {}", usual_or_more(bits))
            : "raise displacement.scale, or bring displacement.bias nearer to 0");
}

/// A sentence if more than 1 % of the base triangles are thinner than a few steps of the positions' format; else empty.
std::string thin_base_remark(const BaseMesh& mesh, double scale, const datapath::Format& position) {
    constexpr double fewest_steps = 16, few = 0.01;
    std::size_t thin = 0;
    double thinnest = fewest_steps;
    for (const auto& t : mesh.triangles) {
        const glm::dvec3 &a = mesh.vertices[t[0]].position, &b = mesh.vertices[t[1]].position,
                         &c = mesh.vertices[t[2]].position;
        const double longest = std::max({safe_length(b - a), safe_length(c - b), safe_length(a - c)});
        const double steps = std::ldexp(2 * triangle_area(a, b, c) / longest * scale, position.fraction);
        thin += steps < fewest_steps ? 1 : 0;
        thinnest = std::min(thinnest, steps);
    }
    if (static_cast<double>(thin) <= few * static_cast<double>(mesh.triangles.size()))
        return {};
    const double bits = position.bits + std::ceil(std::log2(fewest_steps / thinnest));
    return fmt::format(
        "{} of {} base triangles are thinner than {} steps of the positions' format, the thinnest {:.2g}, so that rounding "
        "changes their shape: {}",
        thin, mesh.triangles.size(), fewest_steps, thinnest,
        bits <= datapath::FormatLimits::position_bits.most
            ? fmt::format("set formats.position_bits = {}", usual_or_more(bits))
            : "use thicker triangles, or a mesh whose parts are nearer to one another");
}

/// A sentence if no base vertex, at any height, is beyond the near plane; else empty.
std::string unseen_remark(const CameraSettings& camera, bool view_test, const BaseMesh& mesh,
                          const DisplacementRange& displacement) {
    const glm::dvec3 eye(camera.eye[0], camera.eye[1], camera.eye[2]), backward = view_axes(camera).backward;
    const double reach = std::max(std::abs(displacement.bias), std::abs(displacement.bias + displacement.range));
    double farthest = -std::numeric_limits<double>::infinity();
    for (const BaseVertex& vertex : mesh.vertices)
        farthest = std::max(farthest, glm::dot(eye - vertex.position, backward) + reach);
    if (farthest > camera.near_plane)
        return {};
    const char* const so =
        view_test ? "the camera sees nothing and the View Test allows no split" : "the camera sees nothing";
    return farthest > 0
               ? fmt::format(
                     "all of the mesh is nearer than camera.near_plane = {:.6g}, so that {}: set "
                     "camera.near_plane = \"auto\"",
                     camera.near_plane, so)
               : fmt::format("all of the mesh is behind the camera, so that {}: set camera.target = \"auto\"", so);
}

}  // namespace

PreparedScene prepare_model(const SceneSettings& settings, const BaseMesh& mesh, const HeightMap& map,
                            const std::string& map_name) {
    PreparedScene scene;
    datapath::Registers& registers = scene.registers;
    datapath::Formats& formats = registers.formats;
    std::uint64_t& saturated = scene.input_saturations.registers;
    formats = make_formats(settings.formats, settings.displacement_filter);
    scene.map = quantise_map(map, formats.displacement.bits, settings.address_u, settings.address_v);
    registers.map = scene.map.geometry;

    const DisplacementRange displacement = displacement_range(settings.displacement, map);
    const ModelScale model_scale = fit_model(mesh, settings.displacement, map, formats.position, map_name);
    scene.scale = model_scale.scale;
    scene.centre = {model_scale.centre.x, model_scale.centre.y, model_scale.centre.z};
    registers.displacement =
        make_displacement(displacement, model_scale, scene.map.highest_code(), formats.position, saturated);
    scene.height_per_code =
        std::ldexp(static_cast<double>(registers.displacement.scale), -formats.position.fraction - scene.map.bits);
    scene.texel_size = {mesh.texture_scale.mean_u / registers.map.width * scene.scale,
                        mesh.texture_scale.mean_v / registers.map.height * scene.scale};

    if (std::string remark = relief_remark(map, settings.displacement, scene.scale, formats.position); !remark.empty())
        scene.remarks.push_back(std::move(remark));
    scene.texel_spread = measure_texel_spread(mesh, scene);
    for (std::string& remark :
         std::vector{thin_base_remark(mesh, scene.scale, formats.position), texel_spread_remark(scene.texel_spread),
                     curved_base_remark(scene.texel_spread)})
        if (!remark.empty())
            scene.remarks.push_back(std::move(remark));

    round_base_triangles(mesh, model_scale, scene);
    scene.largest_rectangle_sum =
        bound_rectangle_sum(scene.base_triangles, registers.map, formats, scene.map.highest_code());
    formats.summed_height = datapath::Format::make_unsigned(
        summed_height_bits(settings.formats.summed_height_bits, scene.largest_rectangle_sum), 0);
    formats.height_test = settings.height_test;
    formats.distances = formats.height_test == datapath::HeightTest::rank && settings.tests.rank_view != RankView::none;
    registers.transform = make_transform(settings.camera, model_scale, formats, saturated);
    formats.view_distance = view_distance_format(registers.transform, formats.position);
    make_height_table(settings.tests, scene);
    lay_out_tables(registers);

    if (std::string remark = unseen_remark(settings.camera, settings.tests.view, mesh, displacement); !remark.empty())
        scene.remarks.push_back(std::move(remark));
    const ViewAxes view = view_axes(settings.camera);
    const double height_per_code = displacement.range * model_scale.scale / scene.map.highest_code();
    TestSettings tests = settings.tests;
    if (!formats.distances)  // the rounding of heights to codes is part of the bound
        tests.threshold("bound_threshold") =
            std::max(0.0, tests.threshold("bound_threshold") - scene.map.rounding / scene.map.highest_code());
    registers.tests = make_tests(tests, formats,
                                 {focal_length(settings.camera), corner_secant(settings.camera), distance_step(formats),
                                  std::abs(height_per_code), std::sqrt(scene.texel_size[0] * scene.texel_size[1])});
    if (formats.height_test == datapath::HeightTest::rank && !formats.distances) {
        std::int64_t& bound = registers.tests.height_thresholds[datapath::bound_number];
        bound = std::min(bound, std::int64_t{scene.rank_tables.highest_bound_threshold});
    }
    formats.highlight_tag = settings.tests.highlight;
    formats.families = settings.families;
    formats.final_edges = settings.final_edges && !formats.families;
    formats.codes = settings.one_texel_from_map && formats.height_test == datapath::HeightTest::summed_height;
    if (settings.tests.highlight && !set_highlight_test(settings.tests, towards_light(settings), view.backward, formats,
                                                        registers.tests, saturated))
        scene.remarks.emplace_back(
            "hardware.light points directly away from the viewer: there is no highlight, and the Highlight "
            "Test never requests a split");
    registers.light = make_light(settings, view, formats.normal, saturated);
    registers.triangulation = settings.triangulation;
    registers.back_face_culling = settings.culling == Culling::back;
    check_registers(registers);
    return scene;
}

}  // namespace tessera
