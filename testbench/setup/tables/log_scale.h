#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tessera {

/// Table entries on a logarithmic scale: unsigned fixed-point numbers log2(value) + offset, with `integer_bits` in
/// front of the binary point. A factor of the values is a summand of the entries.
struct LogScale {
    int bits = 0;
    int integer_bits = 0;
    int offset = 0;

    std::uint32_t highest() const { return (std::uint32_t{1} << bits) - 1; }
    double steps() const { return std::ldexp(1.0, bits - integer_bits); }  ///< entries per octave

    /// The largest value that an entry represents.
    double value(std::uint32_t entry) const { return std::exp2(entry / steps() - offset); }
    /// The least entry that represents at least a value; the highest if there is none.
    std::uint32_t entry_above(double value) const { return inside(std::ceil(place(value))); }
    /// The highest entry that represents at most a value; 0 if there is none.
    std::uint32_t entry_below(double value) const { return inside(std::floor(place(value))); }

  private:
    double place(double value) const { return value > 0 ? (std::log2(value) + offset) * steps() : 0; }
    std::uint32_t inside(double entry) const {
        return static_cast<std::uint32_t>(std::clamp(entry, 0.0, static_cast<double>(highest())));
    }
};

}  // namespace tessera
