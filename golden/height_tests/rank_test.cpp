#include "golden/height_tests/rank_test.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tessera::golden {
namespace {

struct Rank {
    int rank = 0, bound = 0, radius = 0;
};

// At the texel that contains t; 0 for parts that the table lacks.
Rank rank_at(const glm::dvec2& t, const RankTable& table, const Map& map) {
    const auto [x, y] = map.entry(t, table.columns, table.rows);
    const auto index = static_cast<std::size_t>(y * table.columns + x);
    return {table.ranks.empty() ? 0 : table.ranks[index], table.bounds.empty() ? 0 : table.bounds[index],
            table.radii.empty() ? 0 : table.radii[index]};
}

// Section 4.7: both differences of the ends' coordinates are even numbers of texels, and not both zero.
bool has_lattice_midpoint(const Vertex& i, const Vertex& j) {
    const glm::dvec2 texels = glm::abs(i.texture - j.texture);
    return std::fmod(texels.x, 2) == 0 && std::fmod(texels.y, 2) == 0 && texels != glm::dvec2(0);
}

// Section 4.7. A rank and a bound, of r and s bits, have 6 and 5 bits in front of the point.
bool asks_by_rank(const Rank& rank, const Vertex& i, const Vertex& j, const Parameters& parameters) {
    if (parameters.rank_view == RankView::none)
        return rank.rank > parameters.rank_threshold || rank.bound > parameters.bound_threshold;
    const double distance = (i.distance + j.distance) / 2, half_step = parameters.distance_step / 2;
    const double octaves = parameters.rank_view == RankView::per_pixel ? 1 : 0.5;
    const double seen_from = level(std::max(distance, half_step));
    const bool ranked = rank.rank > 0 && std::ldexp(rank.rank, 16 - parameters.rank_bits) >
                                             parameters.rank_threshold + std::floor(octaves * seen_from);
    const double radius = std::ldexp(8 + rank.radius % 8, rank.radius / 8) * half_step;
    if (ranked || rank.bound == 0 || (i.w + j.w) / 2 + radius < 0)
        return ranked;
    const double nearest = distance - radius;
    return nearest <= 0 || std::ldexp(rank.bound, 16 - parameters.bound_bits) >
                               parameters.bound_threshold + std::floor(level(nearest) / 2);
}

}  // namespace

HeightTest::Verdict RankTest::decide(const Vertex& i, const Vertex& j, const Vertex& m, const Map& map,
                                     const Parameters& parameters) const {
    const Rank rank = has_lattice_midpoint(i, j) ? rank_at(m.texture, table_, map) : Rank{};
    return {asks_by_rank(rank, i, j, parameters), 0, 0, table_.ranks.empty() ? rank.bound : rank.rank};
}

const RankTable& rank_table(const Map& map) {
    static const RankTable none;
    const auto* const test = height_test_of<RankTest>(map);
    return test == nullptr ? none : test->table();
}

}  // namespace tessera::golden
