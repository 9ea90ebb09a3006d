#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "modules/datapath/all_intermediates.h"
#include "testbench/tests/modules/datapath/datapath_reference.h"

using namespace tessera::datapath;
using namespace tessera::testing;

namespace {

/// The range of values that an intermediate takes.
struct Reach {
    Wide low = 0, high = 0;
    void see(Wide value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    /// Number of bits that hold them; unsigned if none is negative.
    int bits() const {
        for (int bits = 1;; ++bits) {
            const Wide beyond = Wide{1} << (low < 0 ? bits - 1 : bits);
            if (high < beyond && low >= (low < 0 ? -beyond : 0))
                return bits;
        }
    }
};

/// The narrowest and widest formats that a job may have, with few and many fraction bits.
std::vector<Formats> formats_to_try() {
    std::vector<Formats> all{Formats{}};
    const auto vary = [&](const auto& change, const auto&... choices) {
        const std::vector<Formats> before = all;
        for (const Formats& formats : before)
            (
                [&] {
                    Formats changed = formats;
                    change(changed, choices);
                    all.push_back(changed);
                }(),
                ...);
    };
    const auto position = [](Formats& f, const Format& format) { f.position = f.view_distance = format; };
    vary(position, Format::make_signed(8, 0), Format::make_signed(8, 7), Format::make_signed(32, 0),
         Format::make_signed(32, 31));
    vary([](Formats& f, const Format& format) { f.normal = format; }, Format::make_signed(6, 0),
         Format::make_signed(6, 4), Format::make_signed(18, 0), Format::make_signed(18, 16));
    vary([](Formats& f, const Format& format) { f.texture = format; }, Format::make_unsigned(2, 0),
         Format::make_unsigned(13, 0), Format::make_unsigned(14, 12));
    vary([](Formats& f, const Format& format) { f.displacement = format; }, Format::make_unsigned(1, 1));
    vary([](Formats& f, const Format& format) { f.summed_height = format; }, Format::make_unsigned(8, 0),
         Format::make_unsigned(48, 0));
    vary([](Formats& f, const Format& format) { f.screen = format; }, Format::make_signed(8, 7),
         Format::make_signed(31, 0));
    vary([](Formats& f, MapFilter filter) { f.filter = filter; }, MapFilter::bilinear);
    return all;
}

/// No width of a function, in the order of all(), may be too small; in the default formats none may exceed the need by
/// more than one bit.
template <class Widths>
void check(const char* function, const Widths& widths, const std::vector<Reach>& reaches, bool tight) {
    const auto all = widths.all();
    REQUIRE(all.size() == reaches.size());
    for (std::size_t k = 0; k < all.size(); ++k) {
        const int needed = reaches[k].bits();
        INFO(function << ": " << all[k].name << " has " << all[k].bits << " bits, " << needed << " are needed");
        CHECK(needed <= all[k].bits);
        CHECK(all[k].bits <= all[k].most);
        if (tight)
            CHECK(all[k].bits <= needed + 1);
    }
}

Wide one(const Formats& f) {
    return Wide{1} << f.normal.fraction;
}
Wide half(int shift) {
    return shift == 0 ? 0 : Wide{1} << (shift - 1);
}

void check_displace(const Formats& f, bool tight) {
    const DisplaceWidths widths{f};
    Reach product, height, along, step, sum;
    for (const Wide p : {f.position.lowest, f.position.highest})
        for (const Wide scale : {f.position.lowest, f.position.highest})
            for (const Wide bias : {f.position.lowest, f.position.highest})
                for (const Wide n : {f.normal.lowest, f.normal.highest}) {
                    const int fraction = f.displacement.bits + code_fraction(f);
                    const Wide scaled = scale * (Wide{f.displacement.highest} << code_fraction(f));
                    const Wide h = nearest(scaled, fraction) + bias;
                    product.see(scaled + half(fraction));
                    height.see(h);
                    along.see(h * n + half(f.normal.fraction));
                    step.see(nearest(h * n, f.normal.fraction));
                    sum.see(p + nearest(h * n, f.normal.fraction));
                }
    check("displace", widths, {product, height, along, step, sum}, tight);
}

/// The corners of the operands' range of codes and normals' components; all other values lie between them.
void check_bilinear(const Formats& f, bool tight) {
    const BilinearWidths widths{f};
    const Wide one = Wide{1} << weight_bits(f);
    Reach place, columns, row, rows, product, sum;
    for (const std::uint32_t t : {std::uint32_t{0}, 1u << (f.texture.bits - 1)})
        place.see(place_between_centres(t, f));
    const std::array<std::array<Wide, 2>, 2> ranges{{{0, f.displacement.highest}, {f.normal.lowest, f.normal.highest}}};
    for (const auto& range : ranges)
        for (const Wide a : range)
            for (const Wide b : range) {
                columns.see(b - a);
                product.see((b - a) * (one - 1));
                row.see(a * one + (b - a) * (one - 1));
                rows.see((b - a) * one);
                product.see((b - a) * one * (one - 1));
                sum.see(a * one * one + (b - a) * one * (one - 1) + one * one / 2);
            }
    check("interpolate", widths, {place, columns, row, rows, product, sum}, tight);
}

void check_bump(const Formats& f, bool tight) {
    const BumpWidths widths{f};
    Reach cross, bitangent, product, sum, combined;
    for (const int sign : {-1, 1}) {
        const Wide largest = 2 * sign * one(f) * one(f) + half(f.normal.fraction);
        const Wide b = nearest(2 * sign * one(f) * one(f), f.normal.fraction);
        const Wide all = one(f) * b + 2 * sign * one(f) * one(f);
        cross.see(largest);
        bitangent.see(b);
        product.see(one(f) * b);
        sum.see(all + half(bump_shift(f)));
        combined.see(nearest(all, bump_shift(f)));
    }
    check("bump", widths, {cross, bitangent, product, sum, combined}, tight);

    const NormaliseWidths normalise_widths(f, widths.combined.bits);
    Reach square, root, scaled;
    const Wide component = Wide{1} << (widths.combined.bits - 1);
    square.see(3 * component * component);
    root.see(reciprocal_root(1u << 30));
    scaled.see(component * reciprocal_root(1u << 30));
    scaled.see(-component * reciprocal_root(1u << 30));
    check("normalise", normalise_widths, {square, root, scaled}, tight);
}

void check_transform(const Formats& f, bool tight) {
    const TransformWidths widths{f};
    Reach product, sum, w, numerator, quotient;
    for (const int sign : {-1, 1}) {
        const Wide largest = sign * (Wide{1} << TransformParameters::matrix_fraction) * f.position.lowest;
        const Wide all = 3 * largest + -sign * (Wide{1} << 61);
        product.see(largest);
        sum.see(all + half(view_distance_down(f)));
        w.see(nearest(all, view_distance_down(f)));
    }
    for (const Wide kept : {-(Wide{1} << numerator_bits), (Wide{1} << numerator_bits) - 1}) {
        numerator.see(kept);
        quotient.see(kept * reciprocal(1u << 31) + half(62));
    }
    Reach inverse, mantissa;
    mantissa.see(0xffffffff);
    inverse.see(reciprocal(1u << 31));
    check("transform", widths, {product, sum, w, mantissa, inverse, numerator, quotient}, tight);
}

/// A map of the greatest size, repeated.
MapGeometry largest_map(const Formats& f) {
    const std::uint32_t size = 1u << (f.texture.bits - 1) >> f.texture.fraction;
    return {size, size, AddressMode::repeat, AddressMode::repeat};
}
RectangleSize largest_rectangle(const Formats& f) {
    const std::uint32_t border = 1u << (f.texture.bits - 1);
    return rectangle_size({}, {border, border}, largest_map(f), f);
}

void check_rectangle(const Formats& f, bool tight) {
    const RectangleWidths widths{f};
    const MapGeometry map = largest_map(f);
    const std::uint32_t border = 1u << (f.texture.bits - 1), size = map.width;
    const TexCoord last{border - 1, border - 1};
    const RectangleSize largest = largest_rectangle(f);
    Reach difference, width, height, first, end, sum;
    difference.see(border);
    width.see(largest.width);
    height.see(largest.height);
    first.see(-Wide{largest.width / 2});
    first.see(size);
    end.see(centred_rectangle(last, largest, map, f).last_column);
    end.see(centred_rectangle(last, {1, 1}, map, f).last_column);
    end.see(Wide{size} - 1 + largest.width);
    sum.see(f.summed_height.highest);
    check("rectangle_size", widths, {difference, width, height, first, end, sum}, tight);
}

void check_edge_tests(const Formats& f, bool tight) {
    const EdgeTestWidths widths{f};
    Reach normal, sums, area, limit, screen, length, index, product, cosine;
    const RectangleSize largest = largest_rectangle(f);
    area.see(Wide{largest.width} * largest.height);
    limit.see(Wide{1} << 50);
    TestParameters by_area;
    by_area.summed_height_unit = SummedHeightUnit::area;
    by_area.height_thresholds[0] = 1u << 18;
    limit.see(summed_height_limit(largest, by_area));
    normal.see(absolute_difference(f.normal.lowest, f.normal.highest));
    sums.see(2 * Wide{f.summed_height.highest});
    screen.see(absolute_difference(f.screen.lowest, f.screen.highest));
    length.see(2 * Wide{f.screen.highest - f.screen.lowest});
    index.see(integer_part(1u << (f.texture.bits - 1), f));
    const Wide most = Wide{f.normal.lowest} * f.normal.lowest, least = Wide{f.normal.lowest} * f.normal.highest;
    for (const Wide term : {least, most}) {
        product.see(term);
        cosine.see(3 * term);
    }
    check("edge tests", widths, {normal, sums, area, limit, screen, length, index, product, cosine}, tight);

    const TransformNormalWidths rotation{f};
    Reach sum;
    for (const Wide term : {least, most})
        sum.see(3 * term + half(f.normal.fraction));
    check("transform_normal", rotation, {product, sum}, tight);

    const LightWidths light_widths{f};
    Reach lit, scaled, intensity;
    lit.see((3 * most) >> f.normal.fraction);
    scaled.see(256 * lit.high);
    intensity.see(scaled.high >> f.normal.fraction);
    intensity.see(256 + ((256 - 256) * lit.high >> f.normal.fraction));
    check("light", light_widths, {product, cosine, lit, scaled, intensity}, tight);
}

void check_the_rest(const Formats& f, bool tight) {
    const MidpointWidths middle{f};
    const DiagonalWidths diagonal{f};
    const CullWidths cull{f};
    Reach position, direction, texture, side, length, compared, difference, product;
    for (const int k : {0, 1}) {
        position.see(2 * Wide{k == 0 ? f.position.lowest : f.position.highest});
        direction.see(2 * Wide{k == 0 ? f.normal.lowest : f.normal.highest});
    }
    texture.see(2 * (Wide{1} << (f.texture.bits - 1)));
    check("midpoint", middle, {position, direction, texture}, tight);

    side.see(absolute_difference(f.position.lowest, f.position.highest));
    length.see(3 * side.high);
    compared.see(64 * length.high);
    check("choose_second_diagonal", diagonal, {side, length, compared}, tight);

    const Wide across = Wide{f.screen.highest} - f.screen.lowest;
    for (const Wide sign : {-1, 1}) {
        difference.see(sign * across);
        product.see(sign * across * across);
    }
    check("faces_away", cull, {difference, product}, tight);
}

void check_filtered_tests(const Formats& f, bool tight) {
    const CurvatureWidths widths{f};
    Reach difference, eighths, step, product, bend, deviation, measure, codes;
    const std::uint32_t longest = 1u << (f.texture.bits - 1);
    const int level = curvature_level({0, 0}, {longest, 0}, f);
    difference.see(longest);
    eighths.see(Wide{8} * longest);
    step.see(8);
    product.see(Wide{8} * 8);
    bend.see(-3 * Wide{128} * 64);
    bend.see(3 * Wide{127} * 64);
    const CurvatureEntry largest{largest_curvature_exponent, -128, -128, -128, 255};
    measure.see(static_cast<Wide>(curvature_measure(largest, {0, 0}, {longest, longest}, level, f)));
    deviation.see(measure.high >> (largest_curvature_exponent + level));
    const auto code = static_cast<std::uint32_t>(f.displacement.highest);
    codes.see(static_cast<Wide>(curvature_measure_of_codes(0, 0, code)));
    check("curvature_measure", widths, {difference, eighths, step, product, bend, deviation, measure, codes}, tight);

    Reach heights;
    heights.see(2 * Wide{code});
    check("mipmap_test", MipmapWidths{f}, {difference, heights}, tight);
}

/// The Rank Test's view part, with the eye in a corner of its range and the position in the opposite one.
void check_rank_view(const Formats& f, bool tight) {
    const RankViewWidths widths{f};
    Reach away, pair, three, times_11, times_9, ends, radius, deepest, level, rank, limit;
    const Wide farthest = (Wide{1} << (eye_bits - 1)) + f.position.highest;
    away.see(farthest);
    pair.see(2 * farthest);
    three.see(3 * farthest);
    times_11.see(11 * 2 * farthest);
    times_9.see(9 * 3 * farthest);
    const std::uint64_t longest = 2 * ((std::uint64_t{1} << f.view_distance.bits) - 1);
    ends.see(static_cast<Wide>(longest));
    radius.see(static_cast<Wide>(midpoint_radius((1u << radius_bits) - 1)));
    deepest.see(2 * Wide{f.view_distance.lowest});
    deepest.see(2 * Wide{f.view_distance.highest} + radius.high);
    level.see(distance_level(longest));
    rank.see((Wide{1} << FormatLimits::rank_bits.most) - 1);
    limit.see(-(Wide{1} << (rank_limit_bits - 1)));
    limit.see((Wide{1} << (rank_limit_bits - 1)) - 1 + level.high);
    check("rank_test_in_view", widths,
          {away, pair, three, times_11, times_9, ends, radius, deepest, level, rank, limit}, tight);
}

}  // namespace

TEST_CASE("intermediates: operands at their limits need no more bits than declared, and not far fewer") {
    bool tight = true;  // the first are the default formats
    for (const Formats& formats : formats_to_try()) {
        check_bilinear(formats, tight);
        check_displace(formats, tight);
        check_bump(formats, tight);
        check_transform(formats, tight);
        check_rectangle(formats, tight);
        check_edge_tests(formats, tight);
        check_the_rest(formats, tight);
        check_filtered_tests(formats, tight);
        check_rank_view(formats, tight);
        tight = false;
    }
}

TEST_CASE("intermediates: Newton steps over the range of their operands") {
    Reach root_m, y, square, root_product, root_step, m, r, product, correction, step;
    for (std::uint64_t at = 0; at < (std::uint64_t{1} << 32); at += at < 0x40000000 ? 0x40000000 : 10007) {
        const auto value = static_cast<std::uint32_t>(at);
        if (value >= 1u << 30) {
            root_m.see(value);
            Wide root = reciprocal_root_seeds[value >> 24];
            for (int k = 0; k < 2; ++k) {
                y.see(root);
                square.see(root * root);
                root_product.see(value * (root * root >> 32));
                const Wide factor = (Wide{3} << 30) - (value * (root * root >> 32) >> 30);
                root_step.see(root * factor);
                root = root * factor >> 31;
            }
            y.see(root);
            REQUIRE(static_cast<std::uint64_t>(root) == reciprocal_root(value));
        }
        if (value >= 1u << 31) {
            m.see(value);
            Wide inverse = Wide{reciprocal_seeds[value >> 24 & 127]} << 16;
            for (int k = 0; k < 2; ++k) {
                r.see(inverse);
                product.see(value * inverse);
                const Wide factor = (Wide{1} << 32) - (value * inverse >> 32);
                correction.see(factor);
                step.see(inverse * factor);
                inverse = inverse * factor >> 31;
            }
            r.see(inverse);
            REQUIRE(static_cast<std::uint64_t>(inverse) == reciprocal(value));
        }
    }
    const ReciprocalRootWidths root{Formats{}};
    check("reciprocal_root", root, {root_m, y, square, root_product, root_step}, true);
    const ReciprocalWidths inverse{Formats{}};
    check("reciprocal", inverse, {m, r, product, correction, step}, true);
}

TEST_CASE("intermediates: every legal format fits the model's integers, and the first misfit of a wider one is named") {
    using Limits = FormatLimits;
    const auto misfit = [](const Formats& formats) {
        std::string found;
        visit_intermediates(formats, [&](const char* function, const auto& widths) {
            if (const char* const name = first_too_wide(widths); name != nullptr && found.empty())
                found = std::string(function) + ": " + name;
        });
        return found;
    };
    for (int bits = Limits::position_bits.least; bits <= Limits::position_bits.most; ++bits) {
        for (int normal = Limits::normal_bits.least; normal <= Limits::normal_bits.most; ++normal) {
            for (int fraction = 0; fraction <= std::min(normal - 2, Limits::normal_fraction.most); ++fraction) {
                Formats formats;
                formats.position = formats.view_distance = Format::make_signed(bits, bits - 1);
                formats.normal = Format::make_signed(normal, fraction);
                REQUIRE(misfit(formats) == "");
            }
        }
    }
    Formats formats;
    formats.normal = Format::make_signed(40, 26);
    CHECK(misfit(formats) == "interpolate: difference times a weight");
    formats = Formats{};
    formats.position = Format::make_signed(38, 16);
    CHECK(misfit(formats) == "transform: row . (P', 1)");
}
