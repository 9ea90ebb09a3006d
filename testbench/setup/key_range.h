#pragma once
#include <limits>

namespace tessera {

/// Range of a number, or of each component of a vector or span: low .. high, both included.
struct KeyRange {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool or_zero = false;  ///< 0 is also allowed
    bool or_auto = false;  ///< "auto" is allowed in a job file: the member is `automatic`

    bool holds(double value) const { return (value >= low && value <= high) || (or_zero && value == 0); }
};

constexpr KeyRange between(double low, double high) {
    return {low, high};
}
constexpr KeyRange zero_or_between(double low, double high) {
    return {low, high, true};
}
constexpr KeyRange auto_or(KeyRange range) {
    range.or_auto = true;
    return range;
}

inline constexpr double any_length = 1e6;       // model units; keeps products of lengths far from overflow
inline constexpr double least_length = 1e-6;    // and quotients far from infinity
inline constexpr double any_coordinate = 1e12;  // of a camera: what maps of a country or of a cell may have

inline constexpr KeyRange length_range = between(least_length, any_length);
inline constexpr KeyRange coordinate_range = between(-any_coordinate, any_coordinate);
inline constexpr KeyRange distance_range = between(1 / any_coordinate, any_coordinate);

}  // namespace tessera
