#include "testbench/compare/reference_to_mesh.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

using Points = ReferenceLattice::Points;

constexpr std::size_t most_candidates = 32;
constexpr std::size_t smallest_block = 3;  // in smaller blocks every sample is looked up by itself

}  // namespace

ReferenceToMesh::ReferenceToMesh(const ReferenceLattice& lattice, Sampling sampling, const TriangleSoup& soup,
                                 const NearestTriangle* nearest)
    : lattice_(lattice), sampling_(sampling), soup_(soup), nearest_(nearest) {}

BoxHierarchy::Box ReferenceToMesh::start(std::size_t tile) {
    const ReferenceLattice::Tile& which = lattice_.tiles()[tile];
    lattice_.evaluate(which, sampling_, points_);
    corners_ = lattice_.surface().corners(which.triangle);
    const auto& p = corners_.position;
    const double n = lattice_.subdivision(which.triangle);
    facet_area_ = glm::length(glm::cross(p[1] - p[0], p[2] - p[0])) / 2 / (n * n);
    BoxHierarchy::Box box;
    facets_.fill(0);
    for (std::size_t b = 0; b < Points::side; ++b)
        for (std::size_t a = 0; points_.has(a, b); ++a) {
            for (std::size_t below = 0; below < 4; ++below)
                if (points_.has(a, b, below))
                    box.add(points_.point[Points::number(a, b, below)]);
            const ReferenceLattice::Cell cell = points_.cell(a, b);
            for (std::size_t k = 0; k < cell.facets; ++k)
                for (const std::size_t corner : cell.corners[k])
                    ++facets_[corner];
        }
    return box;
}

void ReferenceToMesh::measure_block(std::size_t first_a, std::size_t first_b, std::size_t size) {
    const std::size_t end_a = std::min(first_a + size, Points::side), end_b = std::min(first_b + size, Points::side);
    BoxHierarchy::Box box;
    std::size_t count = 0;
    const auto for_each = [&](const auto& take) {
        for_each_corner(first_a, first_b, end_a, end_b, [&](std::size_t, std::size_t, std::size_t at) { take(at); });
    };
    for_each([&](std::size_t at) {
        box.add(points_.point[at]);
        ++count;
    });
    if (count == 0)
        return;
    if (size <= smallest_block) {
        for_each([&](std::size_t at) { found_[at] = nearest_->nearest(points_.point[at], guess_); });
        return;
    }
    const glm::dvec3 centre = (box.low + box.high) / 2.0;
    const double radius = glm::length(box.high - box.low) / 2;
    const double from_mesh = std::sqrt(nearest_->nearest(centre, guess_).squared);
    if (!nearest_->within(centre, (from_mesh + 2 * radius) * rounding_slack, most_candidates, within_)) {
        ++blocks_cut_;
        const std::size_t half = (size + 1) / 2;
        for (const std::size_t b : {first_b, first_b + half})
            for (const std::size_t a : {first_a, first_a + half})
                measure_block(a, b, half);
        return;
    }
    ++blocks_whole_;
    candidates_.clear();
    for (const NearestTriangle::Found& found : within_) {
        Candidate candidate{found.triangle, std::sqrt(found.squared), {}};
        for (const glm::dvec3& corner : soup_[found.triangle])
            candidate.box.add(corner);
        candidates_.push_back(candidate);
    }
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& l, const Candidate& r) {
        return l.from_centre < r.from_centre || (l.from_centre == r.from_centre && l.triangle < r.triangle);
    });
    for_each([&](std::size_t at) {
        const glm::dvec3& p = points_.point[at];
        found_[at] = nearest_candidate(p, glm::length(p - centre));
    });
}

void ReferenceToMesh::measure_blocks() {
    blocks_cut_ = blocks_whole_ = 0;
    for (std::size_t b = 0; b < Points::side; b += block_)
        for (std::size_t a = 0; a < Points::side; a += block_)
            measure_block(a, b, block_);
    // The next tile is probably similar. Distances do not depend on the blocks.
    if (blocks_cut_ > blocks_whole_ && block_ > smallest_block)
        block_ = (block_ + 1) / 2;
    else if (blocks_cut_ == 0 && block_ < Points::side && ++tiles_ % 16 == 0)
        block_ = std::min(2 * block_, Points::side);
}

NearestTriangle::Found ReferenceToMesh::nearest_candidate(const glm::dvec3& p, double from_centre) const {
    NearestTriangle::Found best;
    double beyond =
        std::numeric_limits<double>::infinity();  // a triangle this far from the centre cannot be the nearest
    for (const Candidate& candidate : candidates_) {
        if (candidate.from_centre > beyond)
            break;
        if (candidate.box.squared_distance(p) > best.squared * rounding_slack)
            continue;
        const double squared = squared_distance(soup_[candidate.triangle], p);
        if (best.is_beaten_by(squared, candidate.triangle)) {
            best = {candidate.triangle, squared};
            beyond = (std::sqrt(squared) + from_centre) * rounding_slack;
        }
    }
    return best;
}

ReferenceToMesh::Sample ReferenceToMesh::sample(std::size_t tile, std::size_t a, std::size_t b,
                                                std::size_t place) const {
    const glm::dvec3 where = lattice_.barycentric(lattice_.tiles()[tile], a, b);
    Sample sample;
    sample.position = points_.point[place];
    sample.texture = lattice_.surface().texture(DisplacedSurface::texel(corners_, where));
    sample.squared = found_[place].squared;
    sample.triangle = found_[place].triangle;
    sample.weight = facet_area_ / 3 * static_cast<double>(facets_[place]);
    return sample;
}

}  // namespace tessera
