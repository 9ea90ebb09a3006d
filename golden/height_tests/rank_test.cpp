#include "golden/height_tests/rank_test.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "golden/golden_setup.h"

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
bool asks_by_rank(const Rank& rank, const Vertex& i, const Vertex& j, const RankSettings& settings,
                  const Parameters& parameters) {
    const double rank_threshold = std::floor(settings.rank_threshold);
    const double bound_threshold = std::floor(settings.bound_threshold);
    if (settings.view == RankView::none)
        return rank.rank > rank_threshold || rank.bound > bound_threshold;
    const double distance = (i.distance + j.distance) / 2, half_step = parameters.distance_step / 2;
    const double octaves = settings.view == RankView::per_pixel ? 1 : 0.5;
    const double seen_from = level(std::max(distance, half_step));
    const bool ranked = rank.rank > 0 && std::ldexp(rank.rank, 16 - settings.rank_bits) >
                                             rank_threshold + std::floor(octaves * seen_from);
    const double radius = std::ldexp(8 + rank.radius % 8, rank.radius / 8) * half_step;
    if (ranked || rank.bound == 0 || (i.w + j.w) / 2 + radius < 0)
        return ranked;
    const double nearest = distance - radius;
    return nearest <= 0 ||
           std::ldexp(rank.bound, 16 - settings.bound_bits) > bound_threshold + std::floor(level(nearest) / 2);
}

// log2(value) + offset in `bits` bits, `integer_bits` of them in front of the point, clamped to their range.
double on_log_scale(double value, double offset, int integer_bits, int bits) {
    if (bits == 0 || value <= 0)
        return 0;
    return std::clamp(std::ldexp(std::log2(value) + offset, bits - integer_bits), 0.0, std::ldexp(1.0, bits) - 1);
}

// In units of a 16 bit entry; 0 without entries. The distance term may bring it back into their range, but not from
// beyond 2^20.
double seen_threshold(double octaves, int integer_bits, int bits) {
    const double threshold = std::isnan(octaves) ? -HUGE_VAL : std::ldexp(octaves, 16 - integer_bits);
    return bits == 0 ? 0 : std::clamp(threshold, -0x1p20, 0x1p20);
}

}  // namespace

RankSettings on_scales(RankSettings of_job, const Scene& scene, double code_rounding) {
    double &rank = of_job.rank_threshold, &bound = of_job.bound_threshold;
    if (of_job.view == RankView::none) {
        const double error = rank * scene.highest_code;
        rank = on_log_scale(error * error, 16, 6, of_job.rank_bits);
        bound = on_log_scale(bound * scene.highest_code - code_rounding, 8, 5, of_job.bound_bits);
        return of_job;
    }
    const double world_per_code = std::abs(scene.placement.scale * (scene.highest - scene.lowest) / scene.highest_code);
    const double focal = focal_length(scene.camera),
                 secant = std::hypot(1, glm::length(scene.camera.viewport) / 2 / focal);
    const double side = of_job.view == RankView::per_pixel ? std::sqrt(scene.texel_area) * focal : 1;
    const double codes = rank / (world_per_code * focal * side);
    rank = seen_threshold(16 + std::log2(codes * codes), 6, of_job.rank_bits);
    const double pixels = world_per_code * secant * (focal * secant + bound);
    bound = seen_threshold(8 + std::log2(bound / pixels), 5, of_job.bound_bits);
    return of_job;
}

HeightTest::Verdict RankTest::decide(const Vertex& i, const Vertex& j, const Vertex& m, const Map& map,
                                     const Parameters& parameters) const {
    const Rank rank = has_lattice_midpoint(i, j) ? rank_at(m.texture, table_, map) : Rank{};
    return {asks_by_rank(rank, i, j, settings_, parameters), 0, 0, table_.ranks.empty() ? rank.bound : rank.rank};
}

}  // namespace tessera::golden
