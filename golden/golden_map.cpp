#include "golden/golden_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "golden/height_tests/summed_height_test.h"

namespace tessera::golden {
namespace {

std::int64_t address(std::int64_t texel, std::int64_t size, AddressMode mode) {
    if (mode == AddressMode::clamp)
        return std::clamp<std::int64_t>(texel, 0, size - 1);
    const std::int64_t remainder = texel % size;
    return remainder < 0 ? remainder + size : remainder;
}

std::int64_t integer_part(double texels) {
    return static_cast<std::int64_t>(std::floor(texels));
}

std::int64_t first_texel(double centre, std::int64_t length, std::int64_t size, AddressMode mode) {
    const std::int64_t first = integer_part(centre) - (length >> 1);
    return mode == AddressMode::clamp ? std::clamp<std::int64_t>(first, 0, size - length) : address(first, size, mode);
}

// The arguments are checked here, before the summed-area table is built from them.
std::vector<std::uint32_t> checked(int width, int height, const std::vector<double>& codes) {
    if (width < 1 || height < 1 || codes.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
        throw std::invalid_argument("golden map: the number of codes is not width times height");
    double sum = 0;
    for (const double code : codes) {
        if (!(code >= 0 && code < 0x1p32) || code != std::floor(code))
            throw std::invalid_argument("golden map: codes must be integers from 0 to 2^32 - 1");
        sum += code;
    }
    if (!(sum < 0x1p52))
        throw std::invalid_argument("golden map: the sum of all codes must stay below 2^52");
    return {codes.begin(), codes.end()};
}

}  // namespace

Map::Map(int width, int height, AddressMode address_u, AddressMode address_v, const std::vector<double>& codes)
    : width_(width),
      height_(height),
      address_u_(address_u),
      address_v_(address_v),
      codes_(checked(width, height, codes)),
      sums_(width, height, codes_),
      height_test_(std::make_shared<SummedHeightTest>()) {}

std::size_t Map::texel(const glm::dvec2& t) const {
    const auto [x, y] = entry(t, width_, height_);
    return static_cast<std::size_t>(y * width_ + x);
}

std::array<Map::Part, 4> Map::around(const glm::dvec2& t) const {
    const glm::dvec2 place = t - 0.5, first = glm::floor(place), past = place - first;
    const auto part = [&](int right, int up) {
        const std::int64_t x = address(integer_part(first.x) + right, width_, address_u_);
        const std::int64_t y = address(integer_part(first.y) + up, height_, address_v_);
        return Part{static_cast<std::size_t>(y * width_ + x),
                    (right == 1 ? past.x : 1 - past.x) * (up == 1 ? past.y : 1 - past.y)};
    };
    return {part(0, 0), part(1, 0), part(0, 1), part(1, 1)};
}

double Map::code(const glm::dvec2& t, Filter filter) const {
    if (filter == Filter::nearest)
        return code(texel(t));
    double sum = 0;
    for (const Part& part : around(t))
        sum += part.weight * code(part.texel);
    return sum;
}

glm::dvec3 Map::normal(const glm::dvec2& t, Filter filter) const {
    if (filter == Filter::nearest)
        return normal(texel(t));
    glm::dvec3 sum(0);
    for (const Part& part : around(t))
        sum += part.weight * normal(part.texel);
    return sum;
}

void Map::derive_normals(double scale_per_code, const glm::dvec2& texel_size) {
    scale_per_code_ = scale_per_code;
    texel_size_ = texel_size;
    normals_.clear();
}

glm::dvec2 Map::slope(std::size_t texel) const {
    const auto x = static_cast<std::int64_t>(texel) % width_, y = static_cast<std::int64_t>(texel) / width_;
    const auto code_at = [&](std::int64_t column, std::int64_t row) {
        return static_cast<double>(codes_[static_cast<std::size_t>(row * width_ + column)]);
    };
    // The two neighbours of `at` along an axis, and their distance in texels.
    const auto neighbours = [](std::int64_t at, std::int64_t size, AddressMode mode) {
        const std::int64_t low = address(at - 1, size, mode), high = address(at + 1, size, mode);
        const std::int64_t distance = mode == AddressMode::repeat ? 2 : std::max<std::int64_t>(high - low, 1);
        return std::array<std::int64_t, 3>{low, high, distance};
    };
    const auto [left, right, distance_u] = neighbours(x, width_, address_u_);
    const auto [below, above, distance_v] = neighbours(y, height_, address_v_);
    const glm::dvec2 difference(code_at(right, y) - code_at(left, y), code_at(x, above) - code_at(x, below));
    return scale_per_code_ * difference / (glm::dvec2(distance_u, distance_v) * texel_size_);
}

glm::dvec3 Map::normal(std::size_t texel) const {
    return normals_.empty() ? glm::normalize(glm::dvec3(-slope(texel), 1)) : normals_[texel];
}

void Map::set_normals(std::vector<glm::dvec3> normals) {
    if (normals.size() != codes_.size())
        throw std::invalid_argument("golden map: normal map and displacement map differ in size");
    normals_ = std::move(normals);
}

void Map::set_heights(std::vector<double> heights) {
    if (heights.size() != codes_.size())
        throw std::invalid_argument("golden map: heights and codes differ in number");
    heights_ = std::move(heights);
}

std::array<std::int64_t, 2> Map::entry(const glm::dvec2& t, std::int64_t columns, std::int64_t rows) const {
    return {address(integer_part(t.x), columns, address_u_), address(integer_part(t.y), rows, address_v_)};
}

Rectangle Map::rectangle_size(const glm::dvec2& t_i, const glm::dvec2& t_j) const {
    const auto whole = [](double texels, std::int64_t size) {
        return std::clamp<std::int64_t>(integer_part(texels), 1, size);
    };
    return {0, 0, whole(std::abs(t_i.x - t_j.x) / 2, width_), whole(std::abs(t_i.y - t_j.y) / 4, height_)};
}

Rectangle Map::rectangle_about(const glm::dvec2& t, const Rectangle& size) const {
    return {first_texel(t.x, size.width, width_, address_u_), first_texel(t.y, size.height, height_, address_v_),
            size.width, size.height};
}

std::uint64_t Map::brute_force_sum(const Rectangle& r) const {
    std::uint64_t sum = 0;
    for (std::int64_t y = r.y; y < r.y + r.height; ++y) {
        for (std::int64_t x = r.x; x < r.x + r.width; ++x) {
            const std::int64_t row = address(y, height_, AddressMode::repeat);
            const std::int64_t column = address(x, width_, AddressMode::repeat);
            sum += static_cast<std::uint64_t>(codes_[static_cast<std::size_t>(row * width_ + column)]);
        }
    }
    return sum;
}

}  // namespace tessera::golden
