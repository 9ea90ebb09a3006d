#include "testbench/prove/fuzz/datapath_case.h"

#include <algorithm>

#include "testbench/job/validate_job.h"
#include "testbench/prove/fuzz/byte_source.h"
#include "testbench/setup/formats.h"

namespace tessera::fuzz {

namespace {

using namespace datapath;

constexpr std::uint32_t largest_side = 24;    // texels: the tables are rebuilt for every case
constexpr std::int64_t most_generations = 4;  // each may multiply the triangles by four
constexpr std::int64_t most_squares = 2;      // of the patch, along each axis

/// Arbitrary valid formats of a job.
Job::Formats any_formats(ByteSource& source) {
    using Limits = FormatLimits;
    const auto any = [&](const Limits::Range& range) { return source.integer(range.least, range.most); };
    const auto below = [&](const Limits::Range& range, std::int64_t bits) {
        return source.integer(range.least, std::min<std::int64_t>(range.most, bits - 1));
    };
    Job::Formats formats;
    formats.position_bits = any(Limits::position_bits);
    formats.position_fraction = below(Limits::position_fraction, formats.position_bits);
    formats.normal_bits = any(Limits::normal_bits);
    formats.normal_fraction = below(Limits::normal_fraction, formats.normal_bits - 1);
    formats.texture_integer = any(Limits::texture_integer);
    formats.texture_fraction = any(Limits::texture_fraction);
    formats.displacement_bits = any(Limits::displacement_bits);
    formats.summed_height_bits = any(Limits::summed_height_bits);
    formats.screen_bits = any(Limits::screen_bits);
    formats.screen_fraction = below(Limits::screen_fraction, formats.screen_bits);
    formats.generation_bits = any(Limits::generation_bits);
    return formats;
}

/// Checks that a job with these formats is valid; the viewport is small enough for the narrowest screen format.
void promise_legal(const Job::Formats& formats, std::int64_t generation_limit) {
    Job job;
    job.formats = formats;
    job.map.width = job.map.height = 1;
    job.camera.viewport_width = job.camera.viewport_height = 1;
    job.tests.generation_limit = generation_limit;
    validate(job);
}

/// A direction of unit length within the format's rounding.
Direction any_unit(ByteSource& source, const Formats& formats) {
    constexpr std::int64_t most = 127;
    Saturations unused;
    const std::int64_t x = source.integer(-most, most), y = source.integer(-most, most),
                       z = source.integer(-most, most);
    const bool none = x == 0 && y == 0 && z == 0;
    return normalise(x, y, none ? 1 : z, formats, unused);
}

MapGeometry any_map(ByteSource& source, const Job::Formats& formats) {
    const std::int64_t most = std::min<std::int64_t>(largest_side, std::int64_t{1} << formats.texture_integer);
    MapGeometry map;
    map.width = source.natural(1, most);
    map.height = source.natural(1, most);
    map.address_u = source.flag() ? AddressMode::repeat : AddressMode::clamp;
    map.address_v = source.flag() ? AddressMode::repeat : AddressMode::clamp;
    return map;
}

TestParameters any_tests(ByteSource& source, const Formats& formats, std::int64_t generation_limit) {
    TestParameters tests;
    const std::uint8_t off = source.byte();
    tests.normal_test = (off & 1) == 0;
    tests.summed_height_test = (off & 2) == 0;
    tests.view_test = (off & 4) == 0;
    tests.tex_coord_test = (off & 8) == 0;
    tests.highlight_test = (off & 16) != 0;
    tests.summed_height_unit = (off & 32) != 0 ? datapath::SummedHeightUnit::area : datapath::SummedHeightUnit::sum;
    const bool area = tests.summed_height_unit == datapath::SummedHeightUnit::area;
    tests.normal_threshold = source.natural(0, 2 * formats.normal.highest + 1);
    tests.height_thresholds[0] = source.integer(0, std::int64_t{1} << (area ? 18 : 50)) >> (source.byte() % 40);
    tests.view_threshold = static_cast<std::uint32_t>(source.integer(0, std::int64_t{1} << formats.screen.bits));
    tests.generation_limit = static_cast<std::uint32_t>(generation_limit);
    const Direction half = any_unit(source, formats);
    tests.half_vector = {half.x, half.y, half.z};
    tests.highlight_cosine = source.integer(0, std::int64_t{1} << (2 * formats.normal.fraction));
    tests.highlight_normal_threshold = source.natural(0, 2 * formats.normal.highest + 1);
    return tests;
}

TransformParameters any_transform(ByteSource& source, const Formats& formats) {
    constexpr std::int64_t one = std::int64_t{1} << TransformParameters::matrix_fraction;
    constexpr std::int64_t farthest = std::int64_t{1} << 61;
    TransformParameters transform;
    for (auto* const row : {&transform.row_x, &transform.row_y, &transform.row_w}) {
        for (std::size_t k = 0; k < 3; ++k)
            (*row)[k] = source.integer(-one, one);
        (*row)[3] = source.integer(-farthest, farthest) >> (source.byte() % 62);
    }
    transform.exponent = source.integer32(0, 24);
    transform.near_plane = source.integer(0, farthest) >> (source.byte() % 62);
    for (auto& row : transform.normal_rows) {
        const Direction axis = any_unit(source, formats);
        row = {axis.x, axis.y, axis.z};
    }
    return transform;
}

Registers any_registers(ByteSource& source) {
    const Job::Formats formats = any_formats(source);
    const std::int64_t generation_limit =
        source.integer(0, std::min(most_generations, (std::int64_t{1} << formats.generation_bits) - 1));
    promise_legal(formats, generation_limit);
    Registers registers;
    registers.formats = make_formats(formats, MapFilter::nearest);
    registers.formats.view_distance.fraction -= source.integer32(0, 30);
    registers.map = any_map(source, formats);
    registers.tests = any_tests(source, registers.formats, generation_limit);
    registers.formats.highlight_tag = registers.tests.highlight_test;
    const Format& position = registers.formats.position;
    registers.displacement = {source.integer32(position.lowest, position.highest),
                              source.integer32(position.lowest, position.highest)};
    registers.transform = any_transform(source, registers.formats);
    registers.triangulation = static_cast<datapath::Triangulation>(source.byte() % 3);
    return registers;
}

std::vector<std::uint32_t> any_codes(ByteSource& source, const Registers& registers) {
    const bool constant = source.byte() % 8 == 0;
    const std::int64_t highest = registers.formats.displacement.highest;
    std::vector<std::uint32_t> codes(std::size_t{registers.map.width} * registers.map.height,
                                     source.natural(0, highest));
    if (!constant)
        for (std::uint32_t& code : codes)
            code = source.natural(0, highest);
    return codes;
}

Vertex any_corner(ByteSource& source, const Registers& registers) {
    const Formats& formats = registers.formats;
    const auto position = [&] { return source.integer32(formats.position.lowest, formats.position.highest); };
    // On a repeated axis the host accepts all coordinates that fit the format, beyond the first period, too.
    const auto coordinate = [&](std::uint32_t size, AddressMode mode) {
        const std::int64_t border = std::int64_t{1} << (formats.texture.bits - 1);
        return source.natural(0, mode == AddressMode::repeat ? border : std::int64_t{size} << formats.texture.fraction);
    };
    Vertex vertex;
    vertex.position = {position(), position(), position()};
    vertex.texture = {coordinate(registers.map.width, registers.map.address_u),
                      coordinate(registers.map.height, registers.map.address_v)};
    vertex.normal = any_unit(source, formats);
    vertex.tangent = any_unit(source, formats);
    vertex.handedness = source.flag() ? std::int8_t{-1} : std::int8_t{1};
    return vertex;
}

/// A grid of squares, each split along either diagonal.
void add_patch(ByteSource& source, DatapathCase& made) {
    const std::uint32_t columns = source.natural(1, most_squares), rows = source.natural(1, most_squares);
    for (std::uint32_t k = 0; k < (columns + 1) * (rows + 1); ++k)
        made.corners.push_back(any_corner(source, made.registers));
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        Triangle triangle;
        triangle.vertices = {made.corners[a], made.corners[b], made.corners[c]};
        triangle.base = static_cast<std::uint32_t>(made.base.size());
        made.base.push_back(triangle);
    };
    for (std::uint32_t y = 0; y < rows; ++y) {
        for (std::uint32_t x = 0; x < columns; ++x) {
            const std::uint32_t a = y * (columns + 1) + x, b = a + 1, d = a + columns + 1, c = d + 1;
            if (source.flag()) {
                add(a, b, d);
                add(b, c, d);
            } else {
                add(a, b, c);
                add(a, c, d);
            }
        }
    }
}

/// Widens the Summed Height Table to the mesh's largest rectangle, since the host refuses a narrower one.
void widen_summed_height(Registers& registers, const std::vector<Triangle>& base) {
    std::uint64_t largest = 0;
    for (const Triangle& triangle : base) {
        std::uint64_t width = 1, height = 1;
        for (std::size_t k = 0; k < 3; ++k) {
            const RectangleSize size = rectangle_size(
                triangle.vertices[k].texture, triangle.vertices[(k + 1) % 3].texture, registers.map, registers.formats);
            width = std::max<std::uint64_t>(width, size.width);
            height = std::max<std::uint64_t>(height, size.height);
        }
        largest = std::max(largest, width * height);
    }
    largest *= static_cast<std::uint64_t>(registers.formats.displacement.highest);
    int bits = registers.formats.summed_height.bits;
    while (largest >> bits != 0)
        ++bits;
    registers.formats.summed_height = Format::make_unsigned(bits, 0);
}

}  // namespace

DatapathCase make_datapath_case(std::string_view bytes) {
    ByteSource source(bytes);
    DatapathCase made;
    made.registers = any_registers(source);
    add_patch(source, made);
    widen_summed_height(made.registers, made.base);
    constexpr std::int64_t widest = (std::int64_t{1} << 31) - 1;
    for (std::int64_t& component : made.vector)
        component = source.integer(-widest, widest) >> (source.byte() % 32);
    made.codes = any_codes(source, made.registers);
    std::vector<Direction> normals;
    for (std::size_t k = 0; k < made.codes.size(); ++k)
        normals.push_back(any_unit(source, made.registers.formats));
    made.tables = testing::make_tables(made.registers, made.codes, normals);
    return made;
}

}  // namespace tessera::fuzz
