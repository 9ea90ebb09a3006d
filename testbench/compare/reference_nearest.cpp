#include "testbench/compare/reference_nearest.h"

#include <algorithm>
#include <cmath>

#include "testbench/geometry/nearest_triangle.h"

namespace tessera {
namespace {

constexpr std::size_t most_kept = 512;
constexpr std::array<std::size_t, 4> cells_of_level{2, 4, 8, 16};
constexpr std::array<std::size_t, 3> first_box{0, 64, 64 + 16};

constexpr std::size_t box_number(std::size_t level, std::size_t x, std::size_t y) {
    return first_box[level] + y * (ReferenceLattice::tile_cells / cells_of_level[level]) + x;
}

}  // namespace

ReferenceNearest::ReferenceNearest(const ReferenceLattice& lattice, Sampling sampling, const std::vector<Box>& boxes)
    : lattice_(lattice),
      sampling_(sampling),
      boxes_(boxes),
      hierarchy_(boxes.size(), Box::about(boxes), [&](std::size_t tile) { return boxes[tile]; }),
      kept_(std::min(most_kept, boxes.size())) {}

const ReferenceNearest::Kept& ReferenceNearest::fetch(std::size_t tile) {
    Kept& kept = kept_[tile % kept_.size()];
    if (kept.tile == tile)
        return kept;
    kept.tile = tile;
    lattice_.evaluate(lattice_.tiles()[tile], sampling_, kept.points);
    kept.boxes.fill({});
    for (std::size_t b = 0; b < ReferenceLattice::Points::side; ++b)
        for (std::size_t a = 0; kept.points.has(a, b); ++a) {
            // a point on the border of two boxes belongs to both
            for (const std::size_t x : {a / 2, a > 0 ? (a - 1) / 2 : 0})
                for (const std::size_t y : {b / 2, b > 0 ? (b - 1) / 2 : 0})
                    for (std::size_t below = 0; x < 8 && y < 8 && below < 4; ++below)
                        if (kept.points.has(a, b, below))
                            kept.boxes[box_number(0, x, y)].add(
                                kept.points.point[ReferenceLattice::Points::number(a, b, below)]);
        }
    for (std::size_t level = 1; level < 3; ++level) {
        const std::size_t side = ReferenceLattice::tile_cells / cells_of_level[level];
        for (std::size_t y = 0; y < side; ++y)
            for (std::size_t x = 0; x < side; ++x)
                for (std::size_t k = 0; k < 4; ++k)
                    kept.boxes[box_number(level, x, y)].add(
                        kept.boxes[box_number(level - 1, 2 * x + k % 2, 2 * y + k / 2)]);
    }
    return kept;
}

void ReferenceNearest::look_at(const std::array<glm::dvec3, 3>& facet) {
    const double squared = tessera::squared_distance(facet, point_);
    if (squared < nearest_squared_) {
        nearest_squared_ = squared;
        nearest_facet_ = facet;
    }
}

void ReferenceNearest::look_at_cell(const Kept& kept, std::size_t a, std::size_t b) {
    const ReferenceLattice::Cell cell = kept.points.cell(a, b);
    for (std::size_t k = 0; k < cell.facets; ++k)
        look_at({kept.points.point[cell.corners[k][0]], kept.points.point[cell.corners[k][1]],
                 kept.points.point[cell.corners[k][2]]});
    kept.points.for_each_wall(cell, [&](const std::array<glm::dvec3, 3>& part) { look_at(part); });
}

void ReferenceNearest::look_at_boxes(const Kept& kept, std::size_t level, std::size_t x, std::size_t y) {
    if (level == 0) {
        for (const std::size_t b : {2 * y, 2 * y + 1})
            for (const std::size_t a : {2 * x, 2 * x + 1})
                look_at_cell(kept, a, b);
        return;
    }
    struct Child {
        double squared;
        std::size_t x, y;
    };
    std::array<Child, 4> children;
    for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t child_x = 2 * x + k % 2, child_y = 2 * y + k / 2;
        children[k] = {kept.boxes[box_number(level - 1, child_x, child_y)].squared_distance(point_), child_x, child_y};
    }
    std::sort(children.begin(), children.end(), [](const Child& l, const Child& r) { return l.squared < r.squared; });
    for (const Child& child : children)
        if (child.squared <= nearest_squared_ * rounding_slack)
            look_at_boxes(kept, level - 1, child.x, child.y);
}

void ReferenceNearest::look_at_tile(std::size_t tile) {
    if (boxes_[tile].squared_distance(point_) <= nearest_squared_ * rounding_slack)
        look_at_boxes(fetch(tile), 3, 0, 0);
}

double ReferenceNearest::squared_distance(const glm::dvec3& p) {
    point_ = p;
    nearest_squared_ = std::numeric_limits<double>::infinity();
    if (any_facet_) {
        nearest_squared_ = tessera::squared_distance(nearest_facet_, p);
    } else if (!boxes_.empty()) {
        look_at_tile(0);
        any_facet_ = true;
    }
    if (boxes_.empty())
        return nearest_squared_;
    hierarchy_.visit_near(p, std::sqrt(nearest_squared_), [&](std::size_t tile) {
        look_at_tile(tile);
        return std::sqrt(nearest_squared_);
    });
    return nearest_squared_;
}

}  // namespace tessera
