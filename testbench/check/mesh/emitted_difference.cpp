#include "testbench/check/mesh/emitted_difference.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <tuple>

#include "testbench/check/mesh/corner_text.h"
#include "testbench/common/error.h"

namespace tessera {

namespace {

std::uint64_t hash_of(const EmittedTriangle& triangle) {
    std::uint64_t hash = 0;
    for (const auto& corner : triangle.corners)
        hash = mix_hash(hash, hash_of(corner));
    return hash;
}

/// The three (P, t), in an order independent of the triangle's.
auto place_of(const EmittedTriangle& triangle) {
    const auto key = [&](std::size_t k) {
        const auto& c = triangle.corners[k];
        return std::make_tuple(c.position.x, c.position.y, c.position.z, c.texture.u, c.texture.v);
    };
    std::array place{key(0), key(1), key(2)};
    std::sort(place.begin(), place.end());
    return place;
}

std::string triangle_text(const EmittedTriangle& triangle, const datapath::Formats& formats) {
    const auto& c = triangle.corners;
    return fmt::format("{}; {}; {}; split by {}, stopped by {}, {}", corner_text(c[0], formats),
                       corner_text(c[1], formats), corner_text(c[2], formats), int{triangle.split_by},
                       int{triangle.stopped_by}, triangle.culled ? "culled" : "lit");
}

}  // namespace

EmittedDifference::EmittedDifference(const EmittedMesh& mesh, std::size_t base_triangles,
                                     const datapath::Formats& formats)
    : mesh_(mesh), formats_(formats), offsets_(base_triangles + 2, 0) {
    if (mesh.triangles.size() >= UINT32_MAX)
        throw ResourceError(
            fmt::format("check.invariants: cannot check more than {} triangles; set it to false for a run of this size",
                        UINT32_MAX - 1));
    for (const EmittedTriangle& triangle : mesh.triangles)
        if (triangle.base < base_triangles)
            ++offsets_[triangle.base + 2];
        else if (++extra_ == 1)
            note("a triangle from a base triangle that does not exist", triangle);
    for (std::size_t b = 2; b < offsets_.size(); ++b)
        offsets_[b] += offsets_[b - 1];
    order_.resize(offsets_.back());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (mesh.triangles[i].base < base_triangles)
            order_[offsets_[mesh.triangles[i].base + 1]++] = static_cast<std::uint32_t>(i);
}

EmittedDifference::Entry& EmittedDifference::entry_of(const EmittedTriangle& triangle, const Entry& added) {
    const std::uint32_t number = table_.number_of(
        hash_of(triangle), [&](std::uint32_t known) { return triangle_of(entries_[known]) == triangle; },
        [&](std::uint32_t known) { return hash_of(triangle_of(entries_[known])); });
    if (number == entries_.size())
        entries_.push_back(added);
    return entries_[number];
}

void EmittedDifference::begin(std::uint32_t base) {
    entries_.clear();
    expected_alone_.clear();
    table_.clear(offsets_[base + 1] - offsets_[base]);
    for (std::uint32_t i = offsets_[base]; i < offsets_[base + 1]; ++i)
        ++entry_of(mesh_.triangles[order_[i]], {order_[i], true, 0}).surplus;
}

void EmittedDifference::expect(const EmittedTriangle& triangle) {
    const std::size_t known = entries_.size();
    Entry& entry = entry_of(triangle, {static_cast<std::uint32_t>(expected_alone_.size()), false, 0});
    if (entries_.size() > known)
        expected_alone_.push_back(triangle);
    --entry.surplus;
}

void EmittedDifference::end() {
    std::vector<EmittedTriangle> missing, extra;
    for (const Entry& entry : entries_) {
        if (entry.surplus == 0)
            continue;
        auto& list = entry.surplus > 0 ? extra : missing;
        list.insert(list.end(), static_cast<std::size_t>(std::abs(entry.surplus)), triangle_of(entry));
    }
    for (auto* const list : {&missing, &extra})
        std::stable_sort(list->begin(), list->end(),
                         [](const EmittedTriangle& a, const EmittedTriangle& b) { return place_of(a) < place_of(b); });
    auto wanted = missing.begin();
    auto there = extra.begin();
    while (wanted != missing.end() || there != extra.end()) {
        const bool no_more = there == extra.end();
        if (no_more || (wanted != missing.end() && place_of(*wanted) < place_of(*there))) {
            ++missing_;
            note("a triangle is missing", *wanted++);
        } else if (wanted == missing.end() || place_of(*there) < place_of(*wanted)) {
            ++extra_;
            note("an extra triangle", *there++);
        } else {
            if (first_.empty())
                first_ = fmt::format("base triangle {}: a triangle differs: {}; expected {}", there->base,
                                     triangle_text(*there, formats_), triangle_text(*wanted, formats_));
            ++differing_;
            ++wanted;
            ++there;
        }
    }
}

void EmittedDifference::note(const char* what, const EmittedTriangle& triangle) {
    if (first_.empty())
        first_ = fmt::format("base triangle {}: {}: {}", triangle.base, what, triangle_text(triangle, formats_));
}

}  // namespace tessera
