#pragma once
#include <cstdint>
#include <string>

#include "modules/datapath/parameters.h"
#include "modules/datapath/registers.h"

namespace tessera::datapath {

/// What the machine's arithmetic presumes of a base vertex: every value fits its format, and no direction component
/// exceeds 1.0.
constexpr bool fits_formats(const Vertex& v, const Formats& f) {
    const std::int64_t one = std::int64_t{1} << f.normal.fraction;
    const std::uint64_t most_texels = std::uint64_t{1} << (f.texture.bits - 1);
    for (const std::int64_t p : {v.position.x, v.position.y, v.position.z})
        if (p < f.position.lowest || p > f.position.highest)
            return false;
    for (const std::int64_t n : {v.normal.x, v.normal.y, v.normal.z, v.tangent.x, v.tangent.y, v.tangent.z})
        if (n < -one || n > one)
            return false;
    return v.texture.u <= most_texels && v.texture.v <= most_texels && (v.handedness == 1 || v.handedness == -1);
}

/// A register with a value that it can hold, but that the arithmetic excludes: by name; empty if there is none.
inline std::string excluded_register(const Registers& r) {
    // The largest threshold of the Summed Height Test, for each unit of measure (edge_tests.h).
    constexpr std::uint64_t most_sum = std::uint64_t{1} << (summed_height_threshold_bits - 1);
    constexpr std::uint64_t most_height = std::uint64_t{1} << 18;
    constexpr std::int32_t most_ambient = 256;
    const bool ranks = r.formats.height_test == HeightTest::rank;
    if (r.triangulation > (ranks ? Triangulation::greatest_rank : Triangulation::second))
        return "triangulation";
    if (r.formats.height_test == HeightTest::summed_height &&
        r.tests.height_threshold() > (r.tests.summed_height_unit == SummedHeightUnit::sum ? most_sum : most_height))
        return "tests.summed_height_threshold";
    if (r.light.ambient > most_ambient)
        return "light.ambient";
    return {};
}

/// The same, or one with a value that it cannot hold.
inline std::string impossible_register(const Registers& r) {
    std::string impossible = excluded_register(r);
    visit_registers(r, [&](const Register& field, const auto& values) {
        for (const std::int64_t value : values)
            if (!holds(field, value))
                impossible = field.name;
    });
    return impossible;
}

}  // namespace tessera::datapath
