#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

#include "modules/datapath/edge_tests.h"
#include "modules/datapath/height_tests.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/transform.h"

namespace tessera::datapath {

enum class RegisterKind : std::uint8_t {
    choice,           ///< a switch or selection; all choices share one word
    unsigned_number,  ///< a word of its own, two if wider than 32 bits
    signed_number,    ///< likewise, two's complement
};

struct Register {
    std::string name;
    RegisterKind kind;
    int bits;
    const char* meaning;
};

/// The table of registers: calls visit(Register, its value...) for each, once for a group of similar ones. The values
/// are references to the members of `r`, which may be assigned unless it is constant. Formats and the size of table
/// entries are fixed in a design; a table's columns and rows follow from the map's size.
template <class AnyRegisters, class Visit>
void describe_registers(AnyRegisters& r, Visit&& visit) {
    const Formats f = r.formats;
    const HeightTestFunctions& height_test = functions_of(f.height_test);
    const auto field = [&](std::string name, RegisterKind kind, int bits, const char* meaning, auto&... values) {
        visit(Register{std::move(name), kind, bits, meaning}, values...);
    };
    constexpr RegisterKind choice = RegisterKind::choice;
    constexpr RegisterKind number = RegisterKind::unsigned_number, with_sign = RegisterKind::signed_number;
    const auto direction = [&](const char* name, const char* meaning, auto& d) {
        field(name, with_sign, f.normal.bits, meaning, d[0], d[1], d[2]);
    };
    const auto row = [&](const char* name, const char* offset_name, const char* meaning, auto& values) {
        field(name, with_sign, matrix_entry_bits, meaning, values[0], values[1], values[2]);
        field(offset_name, with_sign, matrix_offset_bits, "fourth entry of the row", values[3]);
    };
    const auto height_thresholds = [&] {
        const auto thresholds = height_test.thresholds(f);
        for (std::size_t k = 0; k < thresholds.size(); ++k)
            if (const auto& t = thresholds[k]; t.bits > 0)
                field(std::string("tests.") + t.name, t.is_signed ? with_sign : number, t.bits, t.meaning,
                      r.tests.height_thresholds[k]);
    };
    const int map_side_bits = f.texture.bits - f.texture.fraction;

    field("map.address_u", choice, 1, "clamp, repeat", r.map.address_u);
    field("map.address_v", choice, 1, "clamp, repeat", r.map.address_v);
    field("tests.normal_test", choice, 1, "on", r.tests.normal_test);
    field("tests.summed_height_test", choice, 1, "on", r.tests.summed_height_test);
    field("tests.summed_height_unit", choice, 1, "sum, area", r.tests.summed_height_unit);
    field("tests.view_test", choice, 1, "on", r.tests.view_test);
    field("tests.tex_coord_test", choice, 1, "on", r.tests.tex_coord_test);
    field("tests.generation_test", choice, 1, "on", r.tests.generation_test);
    field("triangulation", choice, 2, "shorter, first, second diagonal, greatest rank", r.triangulation);
    field("back_face_culling", choice, 1, "on", r.back_face_culling);

    field("map.width", number, map_side_bits, "texels", r.map.width);
    field("map.height", number, map_side_bits, "texels", r.map.height);
    field("displacement_map.base", number, 64, "byte address", r.displacement_map.base);
    field("normal_map.base", number, 64, "byte address", r.normal_map.base);
    field("summed_height_table.base", number, 64, "byte address", r.height_table.base);

    field("tests.normal_threshold", number, f.normal.bits, "normal's format", r.tests.normal_threshold);
    if (f.height_test == HeightTest::summed_height)
        height_thresholds();
    field("tests.view_threshold", number, f.screen.bits + 1, "screen's format", r.tests.view_threshold);
    field("tests.generation_limit", number, f.generation_bits, "generations", r.tests.generation_limit);
    if (f.highlight_tag) {  // a design with a Highlight Test
        field("tests.highlight_test", choice, 1, "on", r.tests.highlight_test);
        direction("tests.half_vector", "H, normal's format", r.tests.half_vector);
        field("tests.highlight_cosine", with_sign, signed_bits(2 * f.normal.fraction),
              "cosine at the highlight's border, twice the normal's fraction bits", r.tests.highlight_cosine);
        field("tests.highlight_normal_threshold", number, f.normal.bits, "normal's format",
              r.tests.highlight_normal_threshold);
    }

    field("displacement.scale", with_sign, f.position.bits, "S, position's format", r.displacement.scale);
    field("displacement.bias", with_sign, f.position.bits, "position's format", r.displacement.bias);

    row("transform.row_x", "transform.row_x.offset", "screen x, 24 fraction bits", r.transform.row_x);
    row("transform.row_y", "transform.row_y.offset", "screen y, 24 fraction bits", r.transform.row_y);
    row("transform.row_w", "transform.row_w.offset", "w, 24 fraction bits", r.transform.row_w);
    field("transform.exponent", number, 5, "shift: x and y are multiplied by two to this power", r.transform.exponent);
    int shift = f.position.fraction - f.view_distance.fraction;
    field("transform.view_distance_shift", number, 5, "shift: fraction bits of the position minus those of w", shift);
    if constexpr (!std::is_const_v<AnyRegisters>)
        r.formats.view_distance.fraction = f.position.fraction - shift;
    field("transform.near_plane", number, 63, "w before rounding, in the format of row_w's result",
          r.transform.near_plane);
    auto& n = r.transform.normal_rows;
    field("transform.normal_rows", with_sign, f.normal.bits, "world to view, normal's format", n[0][0], n[0][1],
          n[0][2], n[1][0], n[1][1], n[1][2], n[2][0], n[2][1], n[2][2]);

    direction("light.direction", "in view space, normal's format", r.light.direction);
    field("light.ambient", number, 9, "ambient light, in 256ths", r.light.ambient);

    // A further test's registers are last, so that those of other designs keep their addresses.
    if (height_test.covers_more) {
        const std::string table = std::string(height_test.name) + "_table";
        field(table + ".columns", number, map_side_bits, "columns that the height test's table covers, texels",
              r.covered.columns);
        field(table + ".rows", number, map_side_bits, "rows that the height test's table covers, texels",
              r.covered.rows);
    }
    if (f.height_test != HeightTest::summed_height)
        height_thresholds();
    if (f.height_test == HeightTest::rank && f.distances) {
        field("tests.rank_per_pixel", choice, 1, "error weighted per point, per pixel", r.tests.rank_per_pixel);
        auto& eye = r.transform.eye;
        field("transform.eye", with_sign, eye_bits, "position's format", eye[0], eye[1], eye[2]);
    }
}

/// Does the same, with the values of a group as a std::array of std::int64_t.
template <class Visit>
void visit_registers(const Registers& registers, Visit&& visit) {
    describe_registers(registers, [&](const Register& field, const auto&... values) {
        visit(field, std::array{static_cast<std::int64_t>(values)...});
    });
}

/// Whether the value fits the register.
inline bool holds(const Register& field, std::int64_t value) {
    const int magnitude_bits = field.kind == RegisterKind::signed_number ? field.bits - 1 : field.bits;
    if (magnitude_bits >= 63)
        return true;
    const std::int64_t beyond = std::int64_t{1} << magnitude_bits;
    return value < beyond && value >= (field.kind == RegisterKind::signed_number ? -beyond : 0);
}

}  // namespace tessera::datapath
