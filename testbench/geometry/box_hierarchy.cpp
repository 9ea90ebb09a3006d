#include "testbench/geometry/box_hierarchy.h"

#include <algorithm>
#include <cmath>

#include "testbench/common/error.h"

namespace tessera {
namespace {

float rounded_down(double value) {
    const auto result = static_cast<float>(value);
    return static_cast<double>(result) <= value ? result
                                                : std::nextafter(result, -std::numeric_limits<float>::infinity());
}
float rounded_up(double value) {
    return -rounded_down(-value);
}

/// The lowest 21 bits of x, each followed by two zeros.
std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x001f00000000ffffu;
    x = (x | x << 16) & 0x001f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    return (x | x << 2) & 0x1249249249249249u;
}

glm::dvec3 centre_of(const BoxHierarchy::Box& box) {
    return box.low / 2.0 + box.high / 2.0;
}

}  // namespace

BoxHierarchy::Node::Node() {
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = Lanes{} + std::numeric_limits<float>::infinity();
        high[axis] = -low[axis];
    }
}

void BoxHierarchy::Node::set(std::uint32_t lane, const Box& box) {
    for (int axis = 0; axis < 3; ++axis) {
        low[axis][lane] = rounded_down(box.low[axis]);
        high[axis][lane] = rounded_up(box.high[axis]);
    }
}

BoxHierarchy::Box BoxHierarchy::Node::box() const {
    Box all;
    for (std::uint32_t lane = 0; lane < lanes; ++lane)
        all.add(Box{{low[0][lane], low[1][lane], low[2][lane]}, {high[0][lane], high[1][lane], high[2][lane]}});
    return all;
}

BoxHierarchy::BoxHierarchy(std::size_t count, const Box& all, const std::function<Box(std::size_t)>& box) {
    if (count > std::numeric_limits<std::uint32_t>::max())
        throw ResourceError("more than 2^32 triangles cannot be sorted; measure a smaller mesh");
    if (count == 0)
        return;

    // The Morton code of the centre, as long as there is room for, above the box's index.
    int index_bits = 0;
    while ((count - 1) >> index_bits != 0)
        ++index_bits;
    const int axis_bits = std::min(21, (64 - index_bits) / 3);
    const double size = std::ldexp(1.0, axis_bits);
    const glm::dvec3 extent = glm::max(all.high - all.low, std::numeric_limits<double>::min());
    {
        std::vector<std::uint64_t> keys;  // freed before the levels are made
        keys.reserve(count);
        for (std::size_t k = 0; k < count; ++k)
            if (const Box b = box(k); !b.is_empty()) {
                const glm::dvec3 cell = glm::clamp((centre_of(b) - all.low) / extent * size, 0.0, size - 1);
                std::uint64_t code = 0;
                for (int axis = 0; axis < 3; ++axis)
                    code |= spread(static_cast<std::uint64_t>(cell[axis])) << axis;
                keys.push_back(code << index_bits | k);
            }
        std::sort(keys.begin(), keys.end());
        const std::uint64_t index_mask = (std::uint64_t{1} << index_bits) - 1;
        order_.reserve(keys.size());
        for (const std::uint64_t key : keys)
            order_.push_back(static_cast<std::uint32_t>(key & index_mask));
    }

    if (order_.empty())
        return;

    // The boxes are requested in the caller's order, which is faster than in Morton order.
    std::vector<std::uint32_t> place(count);
    for (std::size_t k = 0; k < order_.size(); ++k)
        place[order_[k]] = static_cast<std::uint32_t>(k);
    const auto level_of = [](std::size_t children) { return std::vector<Node>((children + lanes - 1) / lanes); };
    const auto set = [](std::vector<Node>& level, std::size_t child, const Box& b) {
        level[child / lanes].set(static_cast<std::uint32_t>(child % lanes), b);
    };
    levels_.push_back(level_of(order_.size()));
    for (std::size_t k = 0; k < count; ++k)
        if (const Box b = box(k); !b.is_empty())
            set(levels_.back(), place[k], b);
    while (levels_.back().size() > 1) {
        std::vector<Node> level = level_of(levels_.back().size());
        for (std::size_t k = 0; k < levels_.back().size(); ++k)
            set(level, k, levels_.back()[k].box());
        levels_.push_back(std::move(level));
    }
}

float BoxHierarchy::squared_limit(double radius) {
    const double larger = radius * (1 + 0x1p-18);
    return std::min(rounded_up(larger * larger), std::numeric_limits<float>::max());
}

}  // namespace tessera
