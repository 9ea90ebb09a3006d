#include "testbench/setup/formats.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>

#include "modules/datapath/all_intermediates.h"
#include "testbench/common/error.h"

namespace tessera {

using datapath::Format;

namespace {

/// Checks that the model's integers hold every intermediate; true for all formats within the ranges of their keys.
void check_intermediates(const datapath::Formats& formats) {
    datapath::visit_intermediates(formats, [](const char* function, const auto& widths) {
        if (const char* const name = datapath::first_too_wide(widths))
            throw InputError(
                fmt::format("[formats]: {} in {} (modules/datapath) is wider than the model's integers: "
                            "narrow the formats to the ranges of their keys",
                            name, function));
    });
}

/// Interpolated heights change everywhere: from texel borders, midpoints reach the centres only in half texels.
std::int64_t tex_coord_fraction(const FormatSettings& settings, datapath::MapFilter filter) {
    if (settings.tex_coord_fraction >= 0)
        return settings.tex_coord_fraction;
    return filter == datapath::MapFilter::bilinear ? std::min<std::int64_t>(1, settings.texture_fraction) : 0;
}

}  // namespace

datapath::Formats make_formats(const FormatSettings& settings, datapath::MapFilter filter) {
    const auto bits = [](std::int64_t value) { return static_cast<int>(value); };
    datapath::Formats formats;
    formats.position = Format::make_signed(bits(settings.position_bits), bits(settings.position_fraction));
    formats.view_distance = formats.position;
    formats.normal = Format::make_signed(bits(settings.normal_bits), bits(settings.normal_fraction));
    formats.texture = Format::make_unsigned(bits(settings.texture_integer + settings.texture_fraction) + 1,
                                            bits(settings.texture_fraction));
    formats.tex_coord_fraction = bits(tex_coord_fraction(settings, filter));
    formats.filter = filter;
    formats.displacement = Format::make_unsigned(bits(settings.displacement_bits), bits(settings.displacement_bits));
    formats.summed_height =
        Format::make_unsigned(bits(settings.summed_height_bits == 0 ? 32 : settings.summed_height_bits), 0);
    formats.screen = Format::make_signed(bits(settings.screen_bits), bits(settings.screen_fraction));
    formats.generation_bits = bits(settings.generation_bits);
    formats.rank_bits = bits(settings.rank_bits);
    formats.bound_bits = bits(settings.bound_bits);
    check_intermediates(formats);
    return formats;
}

}  // namespace tessera
