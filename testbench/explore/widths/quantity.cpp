#include "testbench/explore/widths/quantity.h"

#include <fmt/format.h>

#include <algorithm>

namespace tessera {

namespace {

using Formats = Job::Formats;

/// Sets bits and fraction; keeps the integer part as far as the bits suffice.
std::string keep_integer(std::int64_t& bits, std::int64_t& fraction, std::int64_t wanted) {
    fraction = std::max<std::int64_t>(0, wanted - (bits - fraction));
    bits = wanted;
    return {};
}

std::vector<Quantity> declare() {
    return {
        {"position", "P, P', scale, bias; the host scales the model to the range, so all bits are precision",
         "formats.position_bits, formats.position_fraction", 8, 32, [](const Formats& f) { return f.position_bits; },
         [](const Formats& f) { return f.position_fraction; },
         [](Formats& f, std::int64_t bits) { return keep_integer(f.position_bits, f.position_fraction, bits); }},
        {"normal", "N, T, N', N's, normal map; integer bits kept", "formats.normal_bits, formats.normal_fraction", 6,
         18, [](const Formats& f) { return f.normal_bits; }, [](const Formats& f) { return f.normal_fraction; },
         [](Formats& f, std::int64_t bits) { return keep_integer(f.normal_bits, f.normal_fraction, bits); }},
        {"texture", "t in texels; integer bits kept", "formats.texture_fraction", 1, 24,
         [](const Formats& f) { return f.texture_integer + f.texture_fraction; },
         [](const Formats& f) { return f.texture_fraction; },
         [](Formats& f, std::int64_t bits) {
             f.texture_fraction = bits - f.texture_integer;
             return std::string(f.texture_fraction >= 0 && f.texture_fraction <= 12 ? "" : by_the_job);
         }},
        {"displacement", "d, the map's codes", "formats.displacement_bits", 1, 16,
         [](const Formats& f) { return f.displacement_bits; }, [](const Formats& f) { return f.displacement_bits; },
         [](Formats& f, std::int64_t bits) {
             f.displacement_bits = bits;
             return std::string{};
         }},
        {"summed_height",
         "entry of the Summed Height Table, modulo 2^bits; a width that cannot hold a rectangle's sum is refused",
         "formats.summed_height_bits", 8, 48, [](const Formats& f) { return f.summed_height_bits; },
         [](const Formats&) { return std::int64_t{0}; },
         [](Formats& f, std::int64_t bits) {
             f.summed_height_bits = bits;
             return std::string{};
         }},
        {"screen", "P's in pixels: precision, integer bits kept", "formats.screen_bits, formats.screen_fraction", 8, 31,
         [](const Formats& f) { return f.screen_bits; }, [](const Formats& f) { return f.screen_fraction; },
         [](Formats& f, std::int64_t bits) {
             const Formats job = f;
             keep_integer(f.screen_bits, f.screen_fraction, bits);
             if (bits >= job.screen_bits - job.screen_fraction)
                 return std::string{};
             return fmt::format(
                 "formats.screen_bits = {} with formats.screen_fraction = {} has {} integer bits, which this "
                 "quantity keeps; sweep screen_range, which keeps the fraction, or narrow "
                 "formats.screen_bits",
                 job.screen_bits, job.screen_fraction, job.screen_bits - job.screen_fraction);
         }},
        {"screen_range", "P's in pixels: range, fraction bits kept", "formats.screen_bits", 8, 31,
         [](const Formats& f) { return f.screen_bits; }, [](const Formats& f) { return f.screen_fraction; },
         [](Formats& f, std::int64_t bits) {
             f.screen_bits = bits;
             return std::string(bits > f.screen_fraction ? "" : by_the_job);
         }},
        {"generation", "generation of a vertex", "formats.generation_bits", 1, 4,
         [](const Formats& f) { return f.generation_bits; }, [](const Formats&) { return std::int64_t{0}; },
         [](Formats& f, std::int64_t bits) {
             f.generation_bits = bits;
             return std::string{};
         }},
    };
}

}  // namespace

const std::vector<Quantity>& quantities() {
    static const std::vector<Quantity> all = declare();
    return all;
}

const Quantity* find_quantity(std::string_view name) {
    const auto found = std::find_if(quantities().begin(), quantities().end(),
                                    [&](const Quantity& quantity) { return quantity.name == name; });
    return found == quantities().end() ? nullptr : &*found;
}

std::vector<std::int64_t> usual_widths(const Quantity& quantity, const Job::Formats& job) {
    std::vector<std::int64_t> possible;
    for (std::int64_t bits = quantity.most; bits >= quantity.least; --bits) {
        Job::Formats formats = job;
        if (quantity.set(formats, bits).empty())
            possible.push_back(bits);
    }
    const std::size_t step = possible.size() > 32 ? 4 : (possible.size() > 16 ? 2 : 1);
    std::vector<std::int64_t> widths;
    for (std::size_t k = 0; k < possible.size(); ++k)
        if (k % step == 0 || possible[k] == quantity.bits(job))
            widths.push_back(possible[k]);
    return widths;
}

}  // namespace tessera
