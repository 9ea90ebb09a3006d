#include "testbench/prove/random_edges/random_machine.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace tessera {

namespace {

using datapath::Format, datapath::Formats, datapath::Direction;

Formats any_formats(Random& random, FormatWidths widths) {
    using Limits = datapath::FormatLimits;
    Formats formats;
    if (widths == FormatWidths::usual)
        return formats;
    const auto bits = [&](const Limits::Range& range) {
        const int low = range.least, high = range.most, third = (high - low) / 3;
        return widths == FormatWidths::narrow ? random.integer32(low, low + third)
               : widths == FormatWidths::wide ? random.integer32(high - third, high)
                                              : random.integer32(low, high);
    };
    const int position = bits(Limits::position_bits), screen = bits(Limits::screen_bits);
    const int normal = bits(Limits::normal_bits);
    formats.position = Format::make_signed(position, random.integer32(0, position - 1));
    const int shift = random.integer32(0, random.chance(80) ? 3 : Limits::view_distance_shift.most);
    formats.view_distance = Format::make_signed(position, formats.position.fraction - shift);
    formats.normal = Format::make_signed(normal, random.chance(70) ? normal - 2 : random.integer32(0, normal - 2));
    const int fraction = bits(Limits::texture_fraction);
    const Limits::Range integer{random.chance(80) ? 6 : Limits::texture_integer.least, Limits::texture_integer.most};
    formats.texture = Format::make_unsigned(bits(integer) + fraction + 1, fraction);
    const int displacement = bits(Limits::displacement_bits);
    formats.displacement = Format::make_unsigned(displacement, displacement);
    formats.screen = Format::make_signed(screen, random.integer32(0, screen - 1));
    if (random.coin())
        formats.filter = datapath::MapFilter::bilinear;
    formats.tex_coord_fraction = std::min(fraction, random.integer32(0, Limits::tex_coord_fraction.most));
    return formats;
}

/// Mostly the Summed Height Test, which is also compared with its definition.
void choose_height_test(Random& random, Formats& formats) {
    using Limits = datapath::FormatLimits;
    if (random.chance(70))
        return;
    const auto last = static_cast<std::int64_t>(datapath::height_tests().size()) - 1;
    formats.height_test = static_cast<datapath::HeightTest>(random.integer(0, last));
    if (formats.height_test != datapath::HeightTest::rank)
        return;
    formats.rank_bits = random.integer32(Limits::rank_bits.least, Limits::rank_bits.most);
    formats.bound_bits = random.coin() ? 0 : random.integer32(Limits::bound_bits.least, Limits::bound_bits.most);
    formats.distances = random.coin();
}

Direction any_unit(Random& random, const Formats& formats) {
    datapath::Saturations unused;
    const auto component = [&] { return random.integer32(-999, 999); };
    const Direction any{component(), component(), component()};
    return normalise(any, formats, unused);
}

std::vector<std::uint32_t> any_codes(Random& random, std::size_t texels, std::uint32_t highest) {
    std::vector<std::uint32_t> codes;
    const auto kind = random.integer(0, 3);
    std::uint32_t step = 0;
    for (std::size_t k = 0; k < texels; ++k)
        if (kind == 0)
            codes.push_back(random.coin() ? highest : 0);
        else if (kind == 1)
            codes.push_back(step = random.chance(5) ? random.natural(0, highest) : step);
        else
            codes.push_back(random.natural(0, highest));
    return codes;
}

datapath::TestParameters any_tests(Random& random, const Formats& formats) {
    datapath::TestParameters tests;
    const auto on = [&] { return random.chance(95); };
    tests.normal_test = on();
    tests.summed_height_test = on();
    tests.view_test = on();
    tests.tex_coord_test = on();
    tests.generation_test = on();
    tests.highlight_test = random.coin();
    tests.summed_height_unit = random.coin() ? datapath::SummedHeightUnit::sum : datapath::SummedHeightUnit::area;
    tests.rank_per_pixel = random.coin();
    tests.generation_limit = random.natural(0, 15);
    const Direction half = any_unit(random, formats);
    tests.half_vector = {half.x, half.y, half.z};
    return tests;
}

datapath::TransformParameters any_transform(Random& random, const Formats& formats) {
    datapath::TransformParameters transform;
    constexpr std::int64_t one = std::int64_t{1} << datapath::TransformParameters::matrix_fraction;
    // The extent of the mesh, which gives the products' scale.
    const std::int64_t reach = one << std::min(formats.position.bits - 1, 31);
    const auto row = [&](std::int64_t offset) {
        return std::array<std::int64_t, 4>{random.integer(-one, one), random.integer(-one, one),
                                           random.integer(-one, one), offset};
    };
    transform.row_x = row(random.any_size(reach));
    transform.row_y = row(random.any_size(reach));
    transform.row_w = row(random.integer(-reach / 2, 4 * reach));
    transform.exponent = random.integer32(0, 14);
    transform.near_plane = std::max<std::int64_t>(1, random.integer(0, reach / 64));
    for (std::int64_t& coordinate : transform.eye)
        coordinate = random.any_size((std::int64_t{1} << (datapath::eye_bits - 1)) - 1);
    return transform;
}

}  // namespace

RandomMachine make_random_machine(Random& random, FormatWidths widths) {
    datapath::Registers registers;
    registers.formats = any_formats(random, widths);
    choose_height_test(random, registers.formats);
    Formats& formats = registers.formats;
    const auto mode = [&] { return random.coin() ? datapath::AddressMode::repeat : datapath::AddressMode::clamp; };
    const std::uint32_t most = 1U << std::min(6, formats.texture.bits - 1 - formats.texture.fraction);
    registers.map.width = random.chance(12) ? 1 : random.natural(1, most);
    registers.map.height = random.chance(12) ? 1 : random.natural(1, most);
    registers.map.address_u = mode();
    registers.map.address_v = mode();
    const auto covered = [&](std::uint32_t side, datapath::AddressMode on) {
        return side + (on == datapath::AddressMode::clamp ? random.natural(0, 3) : 0);
    };
    registers.covered.columns = covered(registers.map.width, registers.map.address_u);
    registers.covered.rows = covered(registers.map.height, registers.map.address_v);
    const std::size_t texels = std::size_t{registers.map.width} * registers.map.height;
    // The narrowest table that fits the sum of the whole map, or a wider one.
    int bits = 8;
    while (static_cast<std::uint64_t>(formats.displacement.highest) * texels >> bits != 0)
        ++bits;
    formats.summed_height = Format::make_unsigned(random.coin() ? bits : random.integer32(bits, 48), 0);

    std::vector<std::uint32_t> codes =
        any_codes(random, texels, static_cast<std::uint32_t>(formats.displacement.highest));
    std::vector<Direction> normals;
    for (std::size_t k = 0; k < texels; ++k)
        normals.push_back(any_unit(random, formats));
    Tables tables = make_tables(registers, codes, normals);
    if (formats.height_test != datapath::HeightTest::summed_height)
        for (std::uint64_t& entry : tables.heights)
            entry = random.bits() >> (64 - height_entry_bits(formats));
    registers.tests = any_tests(random, formats);
    registers.displacement = {static_cast<std::int32_t>(random.any_size(formats.position.highest)),
                              static_cast<std::int32_t>(random.any_size(formats.position.highest))};
    registers.transform = any_transform(random, formats);
    return {EdgeMachine(registers, std::move(tables)), DirectMap(registers.map, std::move(codes), std::move(normals))};
}

datapath::Vertex make_random_vertex(Random& random, EdgeMachine& machine, const datapath::Vertex* near) {
    const datapath::MapGeometry& map = machine.registers.map;
    const Formats& formats = machine.registers.formats;
    const int fraction = formats.texture.fraction;
    const std::uint32_t most = 1U << (formats.texture.bits - 1 - fraction);  // largest texel of the format
    const auto coordinate = [&](std::uint32_t size, datapath::AddressMode mode, std::uint32_t other) {
        const std::uint32_t periods =
            mode == datapath::AddressMode::repeat ? std::max(1U, std::min(3U, most / size)) : 1U;
        const std::uint32_t border = periods * size << fraction;
        const auto choice = random.integer(0, 15);
        if (choice == 0)
            return border;
        if (choice == 1)
            return std::uint32_t{0};
        if (near == nullptr || choice == 2)
            return random.natural(0, border);
        return static_cast<std::uint32_t>(
            std::clamp<std::int64_t>(std::int64_t{other} + random.any_size(std::int64_t{6} << fraction), 0, border));
    };
    datapath::Vertex v;
    const bool on_lattice = formats.height_test == datapath::HeightTest::rank && random.chance(90);
    v.texture.u = coordinate(map.width, map.address_u, near != nullptr ? near->texture.u : 0);
    v.texture.v = coordinate(map.height, map.address_v, near != nullptr ? near->texture.v : 0);
    for (std::uint32_t* const c : {&v.texture.u, &v.texture.v})
        *c = on_lattice ? *c >> fraction << fraction : *c;
    const auto position = [&](std::int32_t other) {
        const std::int64_t reach = formats.position.highest / 2;
        const std::int64_t value =
            near != nullptr && random.chance(70) ? other + random.any_size(reach / 16 + 1) : random.any_size(reach);
        return static_cast<std::int32_t>(std::clamp(value, formats.position.lowest, formats.position.highest));
    };
    const datapath::Position other = near != nullptr ? near->position : datapath::Position{};
    v.position.x = position(other.x);
    v.position.y = position(other.y);
    v.position.z = position(other.z);
    // Sometimes the opposite of the other end's: the mean is zero, or rounding error only.
    const bool against = near != nullptr && random.chance(3);
    v.normal = against ? Direction{-near->normal.x, -near->normal.y, -near->normal.z} : any_unit(random, formats);
    v.tangent = any_unit(random, formats);
    v.handedness = random.chance(80) ? std::int8_t{1} : std::int8_t{-1};
    v.generation = static_cast<std::uint8_t>(random.integer(0, 10));
    machine.complete(v);
    return v;
}

}  // namespace tessera
