#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace tessera {

/// v times the power of two that brings its largest component to 1/2 .. 1: exact, so that results keep the same digits,
/// and no product over- or underflows. v is not zero.
inline glm::dvec3 brought_near_one(const glm::dvec3& v) {
    int exponent = 0;
    std::frexp(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}), &exponent);
    return {std::ldexp(v.x, -exponent), std::ldexp(v.y, -exponent), std::ldexp(v.z, -exponent)};
}

/// v / |v|, for any length but 0.
inline glm::dvec3 unit_vector(const glm::dvec3& v) {
    return glm::normalize(brought_near_one(v));
}

}  // namespace tessera
