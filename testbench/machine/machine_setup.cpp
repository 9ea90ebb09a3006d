#include "testbench/machine/machine_setup.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "modules/datapath/all_intermediates.h"
#include "modules/datapath/map_entry.h"
#include "modules/datapath/registers.h"
#include "testbench/common/error.h"
#include "testbench/input/map/map_displacement.h"
#include "testbench/input/mesh/whole_periods.h"
#include "testbench/machine/resolve_job.h"
#include "testbench/machine/unit_vector.h"

namespace tessera {

namespace {

using datapath::Format;

constexpr double pi = 3.14159265358979323846;

std::int64_t to_fixed(double value, int fraction) {
    return static_cast<std::int64_t>(std::nearbyint(std::ldexp(value, fraction)));
}

/// Rounded to the format; what does not fit it saturates, counted.
std::int32_t to_format(double value, const Format& format, std::uint64_t& saturated) {
    const double scaled = std::nearbyint(std::ldexp(value, format.fraction));
    const auto lowest = static_cast<double>(format.lowest), highest = static_cast<double>(format.highest);
    saturated += scaled >= lowest && scaled <= highest ? 0 : 1;
    return static_cast<std::int32_t>(std::clamp(scaled, lowest, highest));
}

datapath::Direction to_direction(const glm::dvec3& v, const Format& format, std::uint64_t& saturated) {
    return {to_format(v.x, format, saturated), to_format(v.y, format, saturated),
            to_format(v.z, format, saturated)};
}

datapath::Formats make_formats(const Job::Formats& job) {
    const auto bits = [](std::int64_t value) { return static_cast<int>(value); };
    datapath::Formats formats;
    formats.position = Format::make_signed(bits(job.position_bits), bits(job.position_fraction));
    formats.view_distance = formats.position;
    formats.normal = Format::make_signed(bits(job.normal_bits), bits(job.normal_fraction));
    formats.texture = Format::make_unsigned(bits(job.texture_integer + job.texture_fraction) + 1,
                                            bits(job.texture_fraction));
    formats.displacement = Format::make_unsigned(bits(job.displacement_bits), bits(job.displacement_bits));
    formats.summed_height =
        Format::make_unsigned(bits(job.summed_height_bits == 0 ? 32 : job.summed_height_bits), 0);
    formats.screen = Format::make_signed(bits(job.screen_bits), bits(job.screen_fraction));
    formats.generation_bits = bits(job.generation_bits);
    return formats;
}

/// That the model's integers hold every intermediate: so in all formats within the ranges of their keys.
void check_intermediates(const datapath::Formats& formats) {
    datapath::visit_intermediates(formats, [](const char* function, const auto& widths) {
        if (const char* const name = datapath::first_too_wide(widths))
            throw InputError(
                fmt::format("[formats]: {} in {} (modules/datapath) is wider than the model's integers: "
                            "narrow the formats to the ranges of their keys",
                            name, function));
    });
}

/// Which keys to change where a value does not fit its register.
const char* remedy(std::string_view register_name) {
    if (register_name == "map.width" || register_name == "map.height")
        return "use a smaller map or raise formats.texture_integer";
    if (register_name == "tests.generation_limit")
        return "lower tests.generation_limit or raise formats.generation_bits";
    return "change the job's value or formats that it is made of";
}

/// That every value fits its register.
void check_registers(const datapath::Registers& registers) {
    datapath::visit_registers(registers, [](const datapath::Register& field, const auto& values) {
        for (const std::int64_t value : values) {
            if (!datapath::holds(field, value))
                throw InputError(fmt::format("the register {} has {} bits and cannot hold {}: {}", field.name,
                                             field.bits, value, remedy(field.name)));
        }
    });
}

datapath::AddressMode address_mode(Addressing mode) {
    return mode == Addressing::repeat ? datapath::AddressMode::repeat : datapath::AddressMode::clamp;
}

/// The displacement in model units that the machine's d = 0 and the full range of d stand for.
struct Heights {
    double bias;   // at code 0
    double range;  // from code 0 to the highest code
};

Heights model_heights(const Job& job, const HeightMap& map) {
    const MapDisplacement displacement = MapDisplacement::from(job.displacement, map);
    return {displacement.of(map.range_low), displacement.scale * (map.range_high - map.range_low)};
}

/// A map whose values are few of those that the scale spans makes a nearly flat surface: metres in 16 bits.
void note_unused_range(const MapRange& range, const HeightMap& map, MachineSetup& setup) {
    constexpr double least_part = 1.0 / 8;
    const auto [lowest, highest] = std::minmax_element(map.values.begin(), map.values.end());
    const double low = static_cast<double>(*lowest), high = static_cast<double>(*highest);
    const double part = (high - low) / (map.span_high - map.span_low);
    if (range.kind == MapRange::Kind::data || high == low || part >= least_part)
        return;
    setup.remarks.push_back(
        fmt::format("the map's values, {:.6g} to {:.6g}, are {:.2g} % of the {:.6g} to {:.6g} that "
                    "displacement.scale spans: "
                    "map.range = \"data\" lets it span what occurs",
                    low * map.source_units, high * map.source_units, 100 * part,
                    map.span_low * map.source_units, map.span_high * map.source_units));
}

/// Centre and scale that put the displaced model into half of the position's range: nothing saturates, and the eye
/// of a usual camera has room.
ModelScale fit(const Job& job, const BaseMesh& mesh, const Heights& heights, const Format& position) {
    glm::dvec3 low(mesh.vertices.front().position), high(low);
    for (const BaseVertex& vertex : mesh.vertices) {
        low = glm::min(low, vertex.position);
        high = glm::max(high, vertex.position);
    }
    ModelScale result;
    result.centre = (low + high) / 2.0;
    const glm::dvec3 half = (high - low) / 2.0;
    const double reach = std::max({half.x, half.y, half.z}) +
                         std::max(std::abs(heights.bias), std::abs(heights.bias + heights.range));
    // S and bias are registers of the same format; S is up to twice the range (bits = 1, see make_displacement)
    const double registers = std::max(2 * std::abs(heights.range), std::abs(heights.bias)) / 2;
    const double limit = std::ldexp(1.0, position.bits - position.fraction - 2);
    if (reach > 0)
        result.scale =
            std::ldexp(1.0, static_cast<int>(std::floor(std::log2(limit / std::max(reach, registers)))));
    // fewer steps than this across the whole mesh, and the surface is rounding
    constexpr double fewest_steps = 16;
    const double steps = std::ldexp(std::max({half.x, half.y, half.z}) * result.scale, position.fraction);
    if (steps < fewest_steps)
        throw InputError(fmt::format(
            "{}: the displacement, {:.3g} to {:.3g} model units, is so large against the mesh, half of which "
            "is {:.3g}, "
            "that the mesh spans {:.3g} steps of its position format (at least {} are needed): lower "
            "displacement.scale "
            "or displacement.bias, check the map's values, or raise formats.position_bits",
            job.map.source == MapSource::file ? job.map.file : "map", heights.bias,
            heights.bias + heights.range, std::max({half.x, half.y, half.z}), steps, fewest_steps));
    return result;
}

std::uint32_t to_texture(double coordinate, std::uint32_t size, datapath::AddressMode mode,
                         const Format& format, bool& clamped) {
    double texels = coordinate * size;
    if (mode == datapath::AddressMode::clamp && (texels < 0 || texels > size)) {
        clamped = true;
        texels = std::clamp(texels, 0.0, static_cast<double>(size));
    }
    const double fixed = std::nearbyint(std::ldexp(texels, format.fraction));
    // the border bit holds 2^integer itself and nothing beyond
    if (fixed < 0 || fixed > std::ldexp(1.0, format.bits - 1))
        throw InputError(fmt::format(
            "texture coordinate {} is {} texels of a map of {}, beyond the 0..{} that the texture "
            "coordinate's "
            "format holds: let each triangle repeat the map less often, or use a smaller map or a larger "
            "formats.texture_integer",
            coordinate, texels, size, 1 << (format.bits - 1 - format.fraction)));
    return static_cast<std::uint32_t>(fixed);
}

/// Texture coordinates as near to 0 as whole periods bring them, so that they fit their format.
BaseMesh with_low_texture(const BaseMesh& mesh, const datapath::MapGeometry& map, const Format& format) {
    const double texels = std::ldexp(1.0, format.bits - 1 - format.fraction);
    return bring_down_texture(
        mesh,
        {map.address_u == datapath::AddressMode::repeat, map.address_v == datapath::AddressMode::repeat},
        {texels / map.width, texels / map.height});
}

void make_base_triangles(const BaseMesh& original, MachineSetup& setup) {
    const datapath::Formats& formats = setup.registers.formats;
    const datapath::MapGeometry& map = setup.registers.map;
    const BaseMesh mesh = with_low_texture(original, map, formats.texture);
    bool clamped_u = false, clamped_v = false;
    std::vector<datapath::Vertex> vertices;
    vertices.reserve(mesh.vertices.size());
    for (const BaseVertex& base : mesh.vertices) {
        const glm::dvec3 world = setup.model_scale.to_world(base.position);
        datapath::Vertex vertex;
        InputSaturations& saturated = setup.input_saturations;
        vertex.position = {to_format(world.x, formats.position, saturated.position),
                           to_format(world.y, formats.position, saturated.position),
                           to_format(world.z, formats.position, saturated.position)};
        vertex.normal = to_direction(base.normal, formats.normal, saturated.normal);
        vertex.tangent = to_direction(base.tangent, formats.normal, saturated.normal);
        vertex.handedness = base.handedness < 0 ? std::int8_t{-1} : std::int8_t{1};
        bool beyond_u = false, beyond_v = false;
        vertex.texture = {to_texture(base.texture.x, map.width, map.address_u, formats.texture, beyond_u),
                          to_texture(base.texture.y, map.height, map.address_v, formats.texture, beyond_v)};
        setup.texture_clamped += beyond_u || beyond_v ? 1 : 0;
        clamped_u = clamped_u || beyond_u;
        clamped_v = clamped_v || beyond_v;
        vertices.push_back(vertex);
    }
    const auto same = [](const datapath::Vertex& a, const datapath::Vertex& b) {
        return a.position == b.position && a.texture == b.texture;
    };
    for (const auto& corners : mesh.triangles) {
        datapath::Triangle triangle;
        triangle.vertices = {vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]};
        const auto& v = triangle.vertices;
        if (same(v[0], v[1]) || same(v[1], v[2]) || same(v[2], v[0])) {
            ++setup.base_dropped;
            continue;
        }
        triangle.base = static_cast<std::uint32_t>(setup.base_triangles.size());
        setup.base_triangles.push_back(triangle);
    }
    if (setup.base_triangles.empty())
        throw InputError(
            "every base triangle collapses when rounded to the position's and texture coordinate's formats: "
            "use "
            "wider formats (formats.position_bits, formats.texture_fraction)");
    if (setup.base_dropped > 0)
        setup.remarks.push_back(
            fmt::format("{} base triangles collapsed when rounded to the hardware's formats and were dropped",
                        setup.base_dropped));
    if (setup.texture_clamped > 0)
        setup.remarks.push_back(fmt::format(
            "{} base vertices have texture coordinates outside 0..1, and were set to the map's border; if "
            "they tile, {}",
            setup.texture_clamped,
            !clamped_v   ? "set map.address_u = \"repeat\""
            : !clamped_u ? "set map.address_v = \"repeat\""
                         : "set map.address_u = \"repeat\" and map.address_v = \"repeat\""));
}

/// The largest sum any edge's rectangle can have. An inserted vertex's texture coordinate lies between those of its
/// edge's ends, so |du| and |dv| of no edge of a child exceed the largest of the parent's three, and the base
/// triangles bound all their descendants.
std::uint64_t bound_rectangle_sum(const MachineSetup& setup) {
    std::uint64_t largest = 0;
    for (const datapath::Triangle& triangle : setup.base_triangles) {
        std::uint64_t width = 1, height = 1;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto size =
                datapath::rectangle_size(triangle.vertices[k].texture, triangle.vertices[(k + 1) % 3].texture,
                                         setup.registers.map, setup.registers.formats);
            width = std::max<std::uint64_t>(width, size.width);
            height = std::max<std::uint64_t>(height, size.height);
        }
        largest = std::max(largest, width * height);
    }
    return largest * setup.map.highest_code();
}

void choose_summed_height_bits(const Job& job, MachineSetup& setup) {
    setup.largest_rectangle_sum = bound_rectangle_sum(setup);
    const auto holds = [&](int bits) { return setup.largest_rectangle_sum >> bits == 0; };
    int bits = static_cast<int>(job.formats.summed_height_bits);
    if (bits == 0) {
        setup.summed_height_bits_chosen = true;
        bits = holds(32) ? 32 : (holds(40) ? 40 : 48);
    }
    if (!holds(bits))
        throw InputError(fmt::format(
            "formats.summed_height_bits = {}: this mesh's largest rectangle sums up to {}, which needs {} "
            "bits; use "
            "that, or 0 to choose automatically",
            bits, setup.largest_rectangle_sum, 64 - datapath::leading_zeros(setup.largest_rectangle_sum)));
    setup.registers.formats.summed_height = Format::make_unsigned(bits, 0);
}

void lay_out_tables(MachineSetup& setup) {
    constexpr std::uint64_t page = 4096;
    datapath::Registers& registers = setup.registers;
    const auto entry = [](int bits) { return datapath::entry_bytes(bits); };
    const auto after = [](const datapath::TableLayout& table) {
        return (table.base + table.bytes() + page - 1) / page * page;
    };
    registers.displacement_map = {page, registers.map.width, registers.map.height,
                                  entry(registers.formats.displacement.bits)};
    registers.normal_map = {after(registers.displacement_map), registers.map.width, registers.map.height,
                            entry(3 * registers.formats.normal.bits)};
    registers.summed_height_table = {after(registers.normal_map), registers.map.width + 1,
                                     registers.map.height + 1, entry(registers.formats.summed_height.bits)};
}

/// View space: x right, y up, z towards the viewer. Pixels: x right, y up, (0, 0) the viewport's lower left corner.
struct View {
    glm::dvec3 right, up, backward;
};

View make_view(const Job::Camera& camera) {
    const auto vector = [](const std::array<double, 3>& a) { return glm::dvec3(a[0], a[1], a[2]); };
    View view;
    view.backward = unit_vector(vector(camera.eye) - vector(camera.target));
    view.right = unit_vector(glm::cross(brought_near_one(vector(camera.up)), view.backward));
    view.up = glm::cross(view.backward, view.right);
    return view;
}

datapath::TransformParameters make_transform(const Job& job, MachineSetup& setup) {
    const Job::Camera& camera = job.camera;
    const View view = make_view(camera);
    const glm::dvec3 eye =
        setup.model_scale.to_world(glm::dvec3(camera.eye[0], camera.eye[1], camera.eye[2]));
    const double width = static_cast<double>(camera.viewport_width);
    const double height = static_cast<double>(camera.viewport_height);
    const double focal = height / 2 / std::tan(camera.field_of_view * pi / 360);  // pixels
    const glm::dvec3 forward = -view.backward;
    const glm::dvec3 x = focal * view.right + width / 2 * forward;
    const glm::dvec3 y = focal * view.up + height / 2 * forward;
    const auto largest = [](const glm::dvec3& v) {
        return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    };

    datapath::TransformParameters result;
    constexpr int fraction = datapath::TransformParameters::matrix_fraction;
    result.exponent = std::max(0, static_cast<int>(std::ceil(std::log2(std::max(largest(x), largest(y))))));
    const int position_fraction = setup.registers.formats.position.fraction;
    const auto row = [&](const glm::dvec3& direction, double scale) {
        const double offset = std::ldexp(-glm::dot(direction, eye) * scale, fraction + position_fraction);
        if (std::abs(offset) > std::ldexp(1.0, 61))
            throw InputError(fmt::format(
                "camera.eye is {:.3g} model units from the mesh's centre ({:.4g}, {:.4g}, {:.4g}); "
                "Transform's sums hold eyes up to about {:.3g} away: set camera.eye and camera.target "
                "nearer to the mesh, or lower formats.position_fraction",
                glm::length(eye) / setup.model_scale.scale, setup.model_scale.centre.x,
                setup.model_scale.centre.y, setup.model_scale.centre.z,
                std::ldexp(1.0, 61 - fraction - position_fraction) / setup.model_scale.scale));
        return std::array<std::int64_t, 4>{
            to_fixed(direction.x * scale, fraction), to_fixed(direction.y * scale, fraction),
            to_fixed(direction.z * scale, fraction), static_cast<std::int64_t>(std::nearbyint(offset))};
    };
    result.row_x = row(x, std::ldexp(1.0, -result.exponent));
    result.row_y = row(y, std::ldexp(1.0, -result.exponent));
    result.row_w = row(forward, 1);
    // No w reaches 2^62: a near plane there has everything behind it, as one further away would.
    result.near_plane = static_cast<std::int64_t>(
        std::min(std::ldexp(camera.near_plane * setup.model_scale.scale, fraction + position_fraction),
                 std::ldexp(1.0, 62)));
    const Format& normal = setup.registers.formats.normal;
    const auto rotation = [&](const glm::dvec3& axis) {
        const datapath::Direction d = to_direction(axis, normal, setup.input_saturations.registers);
        return std::array<std::int32_t, 3>{d.x, d.y, d.z};
    };
    result.normal_rows = {rotation(view.right), rotation(view.up), rotation(view.backward)};
    return result;
}

/// As wide as a position; the point moved up until the distance of the farthest corner of the position's range fits.
Format view_distance_format(const datapath::TransformParameters& transform, const Format& position) {
    const auto size = [](std::int64_t entry) { return std::abs(static_cast<double>(entry)); };
    const auto& row = transform.row_w;
    const double half_range = -static_cast<double>(position.lowest);
    const double farthest =
        std::ldexp((size(row[0]) + size(row[1]) + size(row[2])) * half_range + size(row[3]),
                   -datapath::TransformParameters::matrix_fraction);
    int shift = 0;
    while (std::ldexp(farthest, -shift) > static_cast<double>(position.highest))
        ++shift;
    return Format::make_signed(position.bits, position.fraction - shift);
}

/// Unit length, world space.
glm::dvec3 towards_light(const Job::Hardware& hardware) {
    return unit_vector(glm::dvec3(hardware.light[0], hardware.light[1], hardware.light[2]));
}

/// A threshold on its way into a register.
struct Threshold {
    const char* key;
    double value;
    bool used;     // by a test that is on
    double scale;  // register's value per unit of the threshold
    double limit;  // the register's highest value
    const char* format_key;
};

/// Rounded down. Refused is what does not fit, and what would be 0 without being meant to: a test against 0
/// asks another question, and rounding answers it.
std::uint64_t to_register(const Threshold& threshold) {
    const double fixed = std::floor(threshold.value * threshold.scale);
    if (fixed > threshold.limit)
        throw InputError(fmt::format("{} = {} does not fit its register; the largest is {}", threshold.key,
                                     threshold.value, threshold.limit / threshold.scale));
    if (threshold.used && threshold.value > 0 && fixed < 1)
        throw InputError(fmt::format(
            "{} = {} is less than one step of its register, {}, and would be 0 there: set it to 0, or at "
            "least to that step, or raise {}",
            threshold.key, threshold.value, 1 / threshold.scale, threshold.format_key));
    return static_cast<std::uint64_t>(fixed);
}

double largest_normal_threshold(const datapath::Formats& formats) {
    return static_cast<double>(2 * formats.normal.highest + 1);
}

/// The Highlight Test's registers, if the design has one.
void set_highlight_test(const Job& job, MachineSetup& setup) {
    const auto& tests = job.tests;
    if (!tests.highlight)
        return;
    datapath::Formats& formats = setup.registers.formats;
    datapath::TestParameters& result = setup.registers.tests;
    formats.highlight_tag = true;
    result.highlight_test = true;
    const glm::dvec3 sum = towards_light(job.hardware) + make_view(job.camera).backward;
    // Shorter, and its direction would be that of rounding errors.
    constexpr double shortest = 1e-9;
    if (glm::length(sum) > shortest) {
        const datapath::Direction half =
            to_direction(glm::normalize(sum), formats.normal, setup.input_saturations.registers);
        result.half_vector = {half.x, half.y, half.z};
    } else {
        setup.remarks.emplace_back(
            "hardware.light shines straight towards the viewer: there is no highlight, and the Highlight "
            "Test "
            "never asks for a split");
    }
    // To nearest, so that the cosines of 0, 60 and 90 degrees are what they should be.
    result.highlight_cosine =
        to_fixed(std::cos(tests.highlight_angle * pi / 180), 2 * formats.normal.fraction);
    result.highlight_normal_threshold = static_cast<std::uint32_t>(
        to_register({"tests.highlight_normal_threshold", tests.highlight_normal_threshold, true,
                     std::ldexp(1.0, formats.normal.fraction), largest_normal_threshold(formats),
                     "formats.normal_fraction"}));
}

datapath::LightParameters make_light(const Job& job, MachineSetup& setup) {
    const View view = make_view(job.camera);
    const glm::dvec3 world = towards_light(job.hardware);
    const glm::dvec3 seen(glm::dot(view.right, world), glm::dot(view.up, world),
                          glm::dot(view.backward, world));
    const datapath::Direction d =
        to_direction(seen, setup.registers.formats.normal, setup.input_saturations.registers);
    datapath::LightParameters result;
    result.direction = {d.x, d.y, d.z};
    result.ambient = static_cast<std::int32_t>(std::lround(job.hardware.ambient * 256));
    return result;
}

datapath::DisplacementParameters make_displacement(const Heights& heights, MachineSetup& setup) {
    // d = code / 2^bits reaches 1 - 2^-bits only; S makes up for it
    const double codes = static_cast<double>(setup.map.highest_code());
    const double full = heights.range * (codes + 1) / codes * setup.model_scale.scale;
    const Format& position = setup.registers.formats.position;
    std::uint64_t& saturated = setup.input_saturations.registers;
    return {to_format(full, position, saturated),
            to_format(heights.bias * setup.model_scale.scale, position, saturated)};
}

Design make_design(const Job& job) {
    Design design;
    design.transport = job.mode == Mode::timed ? Transport::non_blocking : Transport::blocking;
    design.timing = job.timing;
    design.queue.order =
        job.hardware.queue_order == QueueOrder::lifo ? TriangleOrder::lifo : TriangleOrder::fifo;
    design.queue.watermark = static_cast<std::size_t>(job.hardware.queue_watermark);
    design.queue.capacity = static_cast<std::size_t>(job.hardware.queue_capacity);
    design.queue.off_chip_triangles = static_cast<std::uint64_t>(job.hardware.off_chip_triangles);
    design.queue.overflow = job.hardware.queue_overflow == Overflow::spill   ? QueueOverflow::spill
                            : job.hardware.queue_overflow == Overflow::stall ? QueueOverflow::stall
                                                                             : QueueOverflow::error;
    design.tests_units = static_cast<unsigned>(job.hardware.tests_units);
    design.transform_pipelines = static_cast<unsigned>(job.hardware.transform_pipelines);
    design.direct_memory = job.hardware.direct_memory;
    return design;
}

}  // namespace

datapath::TestParameters make_tests(const Job& job, const datapath::Formats& formats) {
    const auto& tests = job.tests;
    datapath::TestParameters result;
    result.normal_test = tests.normal;
    result.summed_height_test = tests.summed_height;
    result.view_test = tests.view;
    result.tex_coord_test = tests.tex_coord;
    result.generation_test = tests.generation;
    result.normal_threshold = static_cast<std::uint32_t>(
        to_register({"tests.normal_threshold", tests.normal_threshold, tests.normal,
                     std::ldexp(1.0, formats.normal.fraction), largest_normal_threshold(formats),
                     "formats.normal_fraction"}));
    const bool area = tests.summed_height_unit == SummedHeightUnit::area;
    const double highest_code = static_cast<double>(formats.displacement.highest);
    result.summed_height_unit = area ? datapath::SummedHeightUnit::area : datapath::SummedHeightUnit::sum;
    // sum: compared with |2 S_ij - S_i - S_j|, four times the paper's difference
    result.summed_height_threshold =
        to_register({"tests.summed_height_threshold", tests.summed_height_threshold, tests.summed_height,
                     highest_code * (area ? 1 : 4), area ? std::ldexp(1.0, 18) : std::ldexp(1.0, 50),
                     "formats.displacement_bits"});
    result.view_threshold = static_cast<std::uint32_t>(to_register(
        {"tests.view_threshold", tests.view_threshold, tests.view, std::ldexp(1.0, formats.screen.fraction),
         std::ldexp(1.0, formats.screen.bits), "formats.screen_fraction"}));
    result.generation_limit = static_cast<std::uint32_t>(tests.generation_limit);
    return result;
}

MachineSetup make_setup(const Job& job, const BaseMesh& mesh, const HeightMap& map) {
    require_resolved(job, "make_setup");
    MachineSetup setup;
    datapath::Registers& registers = setup.registers;
    registers.formats = make_formats(job.formats);
    check_intermediates(registers.formats);
    setup.map = quantise_map(map, registers.formats.displacement.bits, address_mode(job.map.address_u),
                             address_mode(job.map.address_v));
    registers.map = setup.map.geometry;

    const Heights heights = model_heights(job, map);
    note_unused_range(job.map.range, map, setup);
    setup.model_scale = fit(job, mesh, heights, registers.formats.position);
    registers.displacement = make_displacement(heights, setup);
    setup.height_per_code = std::ldexp(static_cast<double>(registers.displacement.scale),
                                       -registers.formats.position.fraction - setup.map.bits);
    setup.texel_size = glm::dvec2(mesh.texture_scale.mean_u / registers.map.width,
                                  mesh.texture_scale.mean_v / registers.map.height) *
                       setup.model_scale.scale;

    make_base_triangles(mesh, setup);
    choose_summed_height_bits(job, setup);
    lay_out_tables(setup);
    registers.tests = make_tests(job, registers.formats);
    set_highlight_test(job, setup);
    registers.transform = make_transform(job, setup);
    registers.formats.view_distance = view_distance_format(registers.transform, registers.formats.position);
    registers.light = make_light(job, setup);
    registers.triangulation =
        job.hardware.triangulation == Triangulation::first    ? datapath::Triangulation::first
        : job.hardware.triangulation == Triangulation::second ? datapath::Triangulation::second
                                                              : datapath::Triangulation::shorter;
    registers.back_face_culling = job.hardware.culling == Culling::back;

    check_registers(registers);

    setup.design = make_design(job);
    return setup;
}

}  // namespace tessera
