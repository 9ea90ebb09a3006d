#include "testbench/setup/tables/rank_table.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <set>
#include <tuple>
#include <utility>

#include "modules/datapath/rank.h"
#include "modules/datapath/rank_view.h"
#include "testbench/setup/tables/log_scale.h"
#include "testbench/setup/tables/split_hierarchy.h"
#include "testbench/setup/tables/table_extent.h"

namespace tessera {

namespace {

using datapath::FormatLimits;
using datapath::TexCoord;

// log2 of codes^2 from -16, so that ranks have room to grow along dependencies where the map is flat, to 48: a triangle
// of 2^23 texels, each with an error of 2^12 codes, has 47.
LogScale rank_scale(int bits) {
    return {bits, 6, 16};
}

// log2 of codes from -8 to 24; 16 is needed, the rest is room to grow.
LogScale bound_scale(int bits) {
    return {bits, 5, 8};
}

/// Falls of squared error per triangle, pooled among splits so that none is worth more than one it needs: a split of
/// little value that leads to others of much value forms a block with them. Optimal if each split needed only the
/// youngest of its makers; a vertex of the forest these form is merged with its best successor as long as that is
/// better.
class PooledFalls {
  public:
    explicit PooledFalls(const SplitHierarchy& hierarchy) {
        const std::size_t count = hierarchy.splits.size();
        std::vector<std::uint32_t> maker(count, nothing);
        for (const SplitDependency& dependency : hierarchy.dependencies) {
            std::uint32_t& youngest = maker[dependency.split];
            youngest = youngest == nothing ? dependency.maker : std::max(youngest, dependency.maker);
        }
        blocks_.resize(count);
        for (std::size_t k = count; k-- > 0;) {
            blocks_[k].fall = hierarchy.splits[k].squared_fall;
            blocks_[k].triangles = hierarchy.splits[k].triangles;
            blocks_[k].joined = static_cast<std::uint32_t>(k);
            merge_better_successors(static_cast<std::uint32_t>(k));
            if (maker[k] != nothing)
                blocks_[maker[k]].successors.push({blocks_[k].per_triangle(), static_cast<std::uint32_t>(k)});
        }
        for (Block& block : blocks_)  // a block joins an older one, whose own is already known
            block.joined = blocks_[block.joined].joined;
    }

    double per_triangle(std::size_t split) const { return blocks_[blocks_[split].joined].per_triangle(); }

  private:
    static constexpr std::uint32_t nothing = 0xffffffff;
    using Successor = std::pair<double, std::uint32_t>;  // fall per triangle, block
    struct Block {
        double fall = 0, triangles = 0;
        std::uint32_t joined = 0;  // the block that it is part of
        std::priority_queue<Successor> successors;
        double per_triangle() const { return fall / triangles; }
    };

    void merge_better_successors(std::uint32_t number) {
        Block& block = blocks_[number];
        while (!block.successors.empty() && block.successors.top().first > block.per_triangle()) {
            Block& other = blocks_[block.successors.top().second];
            block.successors.pop();
            block.fall += other.fall;
            block.triangles += other.triangles;
            other.joined = number;
            if (block.successors.size() < other.successors.size())
                std::swap(block.successors, other.successors);
            for (; !other.successors.empty(); other.successors.pop())
                block.successors.push(other.successors.top());
        }
    }

    std::vector<Block> blocks_;
};

/// Entries of one table: the wanted ones, raised so that each split's entry exceeds those of the splits that need it.
class EntryTable {
  public:
    EntryTable(const SplitHierarchy& hierarchy, std::uint32_t columns, std::uint32_t rows)
        : hierarchy_(hierarchy), columns_(columns), entries_(std::size_t{columns} * rows, 0) {}

    /// wanted: one entry per split. Returns the highest threshold below which every split has the entry it wants.
    std::uint32_t fill(const std::vector<std::uint32_t>& wanted, std::uint32_t highest) {
        for (std::size_t k = 0; k < wanted.size(); ++k) {
            std::uint32_t& entry = entries_[texel(k)];
            entry = std::max(entry, wanted[k]);
        }
        // One round suffices without clashes; with clashes, makers may depend on one another.
        for (int round = 0; round < most_rounds && raise_makers(); ++round) {
        }
        return lower_to(highest, wanted);
    }

    std::vector<std::uint16_t> entries() const { return {entries_.begin(), entries_.end()}; }

  private:
    static constexpr int most_rounds = 8;

    std::size_t texel(std::size_t split) const {
        return std::size_t{hierarchy_.splits[split].row} * columns_ + hierarchy_.splits[split].column;
    }

    bool raise_makers() {
        bool raised = false;
        for (std::size_t k = hierarchy_.dependencies.size(); k-- > 0;) {
            const SplitDependency& dependency = hierarchy_.dependencies[k];
            const std::size_t to = texel(dependency.maker), from = texel(dependency.split);
            if (to != from && entries_[to] <= entries_[from]) {
                entries_[to] = entries_[from] + 1;
                raised = true;
            }
        }
        return raised;
    }

    /// Below the highest entry, each split leaves room for the longest chain of splits that it needs, so that entries
    /// which do not fit stay in order.
    std::uint32_t lower_to(std::uint32_t highest, const std::vector<std::uint32_t>& wanted) {
        std::vector<std::uint32_t> room(wanted.size(), highest);
        for (const SplitDependency& dependency : hierarchy_.dependencies) {
            const std::uint32_t above = room[dependency.maker];
            room[dependency.split] = std::min(room[dependency.split], above == 0 ? 0 : above - 1);
        }
        std::vector<std::uint32_t> most(entries_.size(), 0);
        for (std::size_t k = 0; k < wanted.size(); ++k)
            most[texel(k)] = std::max(most[texel(k)], room[k]);
        std::uint32_t threshold = highest;
        for (std::size_t k = 0; k < wanted.size(); ++k) {
            std::uint32_t& entry = entries_[texel(k)];
            entry = std::min(entry, most[texel(k)]);
            if (entry < wanted[k])
                threshold = std::min(threshold, entry == 0 ? 0 : entry - 1);
        }
        return threshold;
    }

    const SplitHierarchy& hierarchy_;
    std::uint32_t columns_;
    std::vector<std::uint32_t> entries_;
};

std::vector<std::uint32_t> wanted_ranks(const SplitHierarchy& hierarchy, const LogScale& scale) {
    const PooledFalls falls(hierarchy);
    std::vector<std::uint32_t> wanted(hierarchy.splits.size());
    for (std::size_t k = 0; k < wanted.size(); ++k)
        wanted[k] = scale.entry_above(falls.per_triangle(k));
    return wanted;
}

std::vector<std::uint32_t> wanted_bounds(const SplitHierarchy& hierarchy, const LogScale& scale) {
    constexpr double above_rounding = 1 + 0x1p-40;
    std::vector<std::uint32_t> wanted(hierarchy.splits.size());
    for (std::size_t k = 0; k < wanted.size(); ++k)
        wanted[k] = scale.entry_above(hierarchy.splits[k].largest * above_rounding);
    return wanted;
}

/// The least code whose radius is at least `radius`; the greatest if there is none.
std::uint8_t radius_above(double radius) {
    constexpr std::uint32_t greatest = (1u << datapath::radius_bits) - 1;
    const auto least = static_cast<std::uint64_t>(std::ceil(std::min(radius, 0x1p62)));
    std::uint32_t code = 0;
    while (code < greatest && datapath::midpoint_radius(code) < least)
        ++code;
    return static_cast<std::uint8_t>(code);
}

/// Each split's radius covers its own triangles, and those of the splits that need it, from the ends of its own edge.
std::vector<std::uint8_t> nested_radii(const SplitHierarchy& hierarchy, double rounding, std::uint32_t columns,
                                       std::uint32_t rows) {
    std::vector<double> radii(hierarchy.splits.size());
    for (std::size_t k = 0; k < radii.size(); ++k)
        radii[k] = hierarchy.splits[k].reach + rounding;
    const auto as_stored = [&](std::size_t split) {
        return static_cast<double>(datapath::midpoint_radius(radius_above(radii[split])));
    };
    for (std::size_t k = hierarchy.dependencies.size(); k-- > 0;) {
        const SplitDependency& dependency = hierarchy.dependencies[k];
        double& maker = radii[dependency.maker];
        maker = std::max(maker, as_stored(dependency.split) + dependency.apart + rounding);
    }
    std::vector<std::uint8_t> table(std::size_t{columns} * rows, 0);
    for (std::size_t k = 0; k < radii.size(); ++k) {
        const EdgeSplit& split = hierarchy.splits[k];
        std::uint8_t& entry = table[std::size_t{split.row} * columns + split.column];
        entry = std::max(entry, radius_above(radii[k]));
    }
    return table;
}

/// A threshold in octaves as fixed point with `fraction` bits, rounded down and clamped to a register's range.
std::int32_t seen_threshold(double octaves, int fraction, int bits) {
    const double most = std::ldexp(1.0, bits - 1), fixed = std::floor(std::ldexp(octaves, fraction));
    return static_cast<std::int32_t>(fixed > -most ? std::min(fixed, most - 1) : -most);  // no number: nothing to see
}

std::vector<std::uint8_t> highest_generations(const SplitHierarchy& hierarchy, const RankTables& tables,
                                              std::uint32_t highest) {
    std::vector<std::uint8_t> generations(highest, 0);
    for (const EdgeSplit& split : hierarchy.splits) {
        if (const std::uint32_t entry = tables.bound[std::size_t{split.row} * tables.columns + split.column];
            entry > 0) {
            std::uint8_t& here = generations[entry - 1];
            here = std::max(here, static_cast<std::uint8_t>(std::min(split.generation, 255)));
        }
    }
    for (std::size_t k = highest; k-- > 1;)
        generations[k - 1] = std::max(generations[k - 1], generations[k]);
    return generations;
}

std::uint64_t count_clashes(const SplitHierarchy& hierarchy) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> texels;
    for (const EdgeSplit& split : hierarchy.splits)
        texels.emplace_back(split.column, split.row);
    std::sort(texels.begin(), texels.end());
    const auto distinct = std::unique(texels.begin(), texels.end());
    return static_cast<std::uint64_t>(texels.end() - distinct);
}

bool longer_than_period(const datapath::MapGeometry& map, const std::vector<TextureTriangle>& base,
                        const datapath::Formats& formats) {
    TexCoord low{UINT32_MAX, UINT32_MAX}, high{0, 0};
    for (const TextureTriangle& triangle : base)
        for (const TexCoord& t : triangle) {
            low = {std::min(low.u, t.u), std::min(low.v, t.v)};
            high = {std::max(high.u, t.u), std::max(high.v, t.v)};
        }
    const auto longer = [&](std::uint32_t from, std::uint32_t to, std::uint32_t size, datapath::AddressMode mode) {
        return mode == datapath::AddressMode::repeat && to > from &&
               std::uint64_t{to - from} > std::uint64_t{size} << formats.texture.fraction;
    };
    return longer(low.u, high.u, map.width, map.address_u) || longer(low.v, high.v, map.height, map.address_v);
}

}  // namespace

RankTables make_rank_tables(const QuantisedMap& map, const std::vector<TextureTriangle>& base,
                            const datapath::Formats& formats, int rank_bits, int bound_bits,
                            const std::optional<RadiusScale>& radii) {
    RankTables tables;
    const datapath::MapGeometry extent = table_extent(map.geometry, base, formats);
    tables.columns = extent.width;
    tables.rows = extent.height;
    const SplitHierarchy hierarchy = make_split_hierarchy(map, base, formats, radii ? radii->steps : SurfaceSteps{});
    tables.least_error = hierarchy.least_error;
    tables.clashes = count_clashes(hierarchy);
    tables.beyond_period = longer_than_period(map.geometry, base, formats);
    tables.midpoints.reserve(hierarchy.splits.size());
    for (const EdgeSplit& split : hierarchy.splits)
        tables.midpoints.push_back(split.midpoint);
    if (rank_bits != 0) {
        const LogScale scale = rank_scale(rank_bits);
        EntryTable table(hierarchy, tables.columns, tables.rows);
        table.fill(wanted_ranks(hierarchy, scale), scale.highest());
        tables.rank = table.entries();
    }
    if (bound_bits != 0) {
        const LogScale scale = bound_scale(bound_bits);
        EntryTable table(hierarchy, tables.columns, tables.rows);
        tables.highest_bound_threshold = table.fill(wanted_bounds(hierarchy, scale), scale.highest());
        tables.bound = table.entries();
        tables.generations = highest_generations(hierarchy, tables, scale.highest());
        if (radii)
            tables.radius = nested_radii(hierarchy, radii->rounding, tables.columns, tables.rows);
    }
    return tables;
}

std::uint64_t count_whole_base_edges(const std::vector<TextureTriangle>& base, const datapath::Formats& formats) {
    std::set<std::array<std::uint32_t, 4>> whole;
    for (const TextureTriangle& triangle : base) {
        for (std::size_t k = 0; k < 3; ++k) {
            TexCoord a = triangle[k], b = triangle[(k + 1) % 3];
            if (datapath::has_lattice_midpoint(a, b, formats))
                continue;
            if (std::tie(b.u, b.v) < std::tie(a.u, a.v))
                std::swap(a, b);
            whole.insert({a.u, a.v, b.u, b.v});
        }
    }
    return whole.size();
}

std::uint32_t rank_threshold(double error_per_triangle, int bits) {
    return rank_scale(bits).entry_below(error_per_triangle * error_per_triangle);
}

double rank_error(std::uint32_t threshold, int bits) {
    return std::sqrt(rank_scale(bits).value(threshold));
}

std::uint32_t bound_threshold(double largest_error, int bits) {
    return bound_scale(bits).entry_below(largest_error);
}

double bound_error(std::uint32_t threshold, int bits) {
    return bound_scale(bits).value(threshold);
}

// An error of e codes at distance d is e * code * focal / d pixels high, and a texel there texel * focal / d wide. The sum of
// two ends' distances is 2 d / step.
std::int32_t seen_rank_threshold(double error, bool per_pixel, const ViewedScale& view) {
    const LogScale scale = rank_scale(FormatLimits::rank_bits.most);
    const double per_code = view.code * view.focal * 2 / view.step;
    const double per_texel = per_pixel ? view.texel * view.focal * 2 / view.step : 1;
    return seen_threshold(scale.offset + 2 * std::log2(error / (per_code * per_texel)), scale.bits - scale.integer_bits,
                          datapath::rank_limit_bits);
}

// A point of the surface at distance d or more in the picture is d / secant deep or more. The mesh e above it is as deep
// but for e, and e * focal * secant / its depth pixels away.
std::int32_t seen_bound_threshold(double pixels, const ViewedScale& view) {
    const LogScale scale = bound_scale(FormatLimits::bound_bits.most);
    const double secant = view.corner_secant;
    const double per_code = view.code * (view.focal * secant * secant + pixels * secant) * 2 / view.step;
    return seen_threshold(scale.offset + std::log2(pixels / per_code), scale.bits - scale.integer_bits,
                          datapath::bound_limit_bits);
}

}  // namespace tessera
