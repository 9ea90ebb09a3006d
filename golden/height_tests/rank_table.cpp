#include "golden/height_tests/rank_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace tessera::golden {
namespace {

constexpr std::uint32_t nothing = std::numeric_limits<std::uint32_t>::max();

// An end of an edge: a point of the map and the code under it.
struct End {
    glm::dvec2 at{0};
    double code = 0;
};

struct Piece {
    std::array<End, 3> corners;
    std::uint32_t maker = nothing;  // the bisection that made it
    std::array<End, 2> made_of;     // the edge it bisected
};

struct Fit {
    double largest = 0, squared = 0;  // errors of the piece's plane, codes
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
};

// One bisection of an edge, of all pieces that share it.
struct Bisection {
    double largest = 0, reach = 0;
    double fall = 0, size = 0;  // of the squared error; of the terms it is a difference of
    double pieces = 0;
    std::array<double, 4> edge{};                          // the same for edges whole periods apart
    std::vector<std::pair<std::uint32_t, double>> makers;  // with the distance of their edges
};

// log2(value) + offset in steps, rounded up; values from low to high.
EntryRange entry_range(double low, double high, double offset, int integer_bits, int bits) {
    const double most = std::ldexp(1.0, bits) - 1;
    const auto place = [&](double value, double aside) {
        const double at = value > 0 ? std::ldexp(std::log2(value) + offset, bits - integer_bits) : 0;
        return std::clamp(std::ceil(at + aside), 0.0, most);
    };
    return {place(low, -1e-9), high > 0 ? place(high, 1e-9) : 0};
}

class Derivation {
  public:
    Derivation(const Map& map, const RankSource& source)
        : map_(map),
          source_(source),
          number_at_(static_cast<std::size_t>(source.columns * source.rows), nothing),
          bisections_(source.midpoints.size()) {
        for (std::size_t k = 0; k < source.midpoints.size(); ++k)
            number_at_[source.entry(source.midpoints[k])] = static_cast<std::uint32_t>(k);
    }

    DerivedRanks run() {
        bisect_all();
        DerivedRanks result;
        result.shared = shared_;
        if (shared_)
            return result;
        for (std::size_t k = 0; k < bisections_.size() && fault_.empty(); ++k)
            if (bisections_[k].pieces == 0)
                fault_ = "bisection " + std::to_string(k) + " has no edge";
        result.fault = fault_;
        if (!fault_.empty())
            return result;
        result.ranks = on_table(ranks());
        std::vector<EntryRange> bounds = wanted_bounds();
        if (source_.bound_bits > 0) {
            const std::vector<EntryRange> wanted = bounds;
            put_in_order(bounds, source_.bound_bits);
            result.highest_bound_threshold = highest_threshold(bounds, wanted);
        }
        result.bounds = on_table(bounds);
        result.radii = on_table(radii());
        return result;
    }

  private:
    std::int64_t period(int axis) const {
        const bool repeats = (axis == 0 ? map_.address_u() : map_.address_v()) == AddressMode::repeat;
        return repeats ? (axis == 0 ? map_.width() : map_.height()) : 0;
    }
    glm::dvec2 in_first_period(glm::dvec2 t) const {
        for (int axis = 0; axis < 2; ++axis)
            if (const auto size = static_cast<double>(period(axis)); size > 0)
                t[axis] -= std::floor(t[axis] / size) * size;
        return t;
    }

    // Equal for triangles with the same corners, also if they are whole periods apart.
    std::array<double, 6> name_of(const std::array<glm::dvec2, 3>& t) const {
        std::array<std::array<double, 6>, 6> names{};
        for (std::size_t k = 0; k < 6; ++k) {
            const glm::dvec2 a = t[k % 3], b = t[(k + (k < 3 ? 1 : 2)) % 3] - a, c = t[(k + (k < 3 ? 2 : 1)) % 3] - a;
            const glm::dvec2 from = in_first_period(a);
            names[k] = {from.x, from.y, b.x, b.y, c.x, c.y};
        }
        return *std::min_element(names.begin(), names.end());
    }

    std::array<double, 4> name_of(const End& i, const End& j) const {
        const auto from = [&](const glm::dvec2& a, const glm::dvec2& b) {
            const glm::dvec2 start = in_first_period(a);
            return std::array{start.x, start.y, b.x - a.x, b.y - a.y};
        };
        return std::min(from(i.at, j.at), from(j.at, i.at));
    }

    void bisect_all() {
        std::set<std::array<double, 6>> known;
        for (const auto& corners : source_.base) {
            const glm::dvec2 a = corners[1] - corners[0], b = corners[2] - corners[0];
            if (a.x * b.y == a.y * b.x || !known.insert(name_of(corners)).second)
                continue;
            Piece piece;
            for (std::size_t k = 0; k < 3; ++k)
                piece.corners[k] = {corners[k], code_at(corners[k])};
            bisect(piece);
        }
    }

    double code_at(const glm::dvec2& t) const { return map_.given_code(map_.texel(t)); }

    std::uint32_t number_of(const End& i, const End& j) const {
        const glm::dvec2 texels = glm::abs(i.at - j.at);
        if (std::fmod(texels.x, 2) != 0 || std::fmod(texels.y, 2) != 0 || texels == glm::dvec2(0))
            return nothing;
        const glm::dvec2 middle = in_first_period((i.at + j.at) / 2.0);
        if (middle.x < 0 || middle.y < 0 || middle.x >= static_cast<double>(source_.columns) ||
            middle.y >= static_cast<double>(source_.rows))
            return nothing;
        // The texel may also hold the midpoint of an edge without an error, which is not bisected.
        const std::uint32_t number = number_at_[source_.entry(middle)];
        return number != nothing && source_.midpoints[number] == middle ? number : nothing;
    }

    void bisect(const Piece& first) {
        std::vector<std::pair<Piece, Fit>> waiting{{first, fit(first)}};
        while (!waiting.empty()) {
            const auto [piece, before] = waiting.back();
            waiting.pop_back();
            std::size_t k = 0;
            std::array<std::uint32_t, 3> numbers{};
            for (std::size_t e = 0; e < 3; ++e) {
                numbers[e] = number_of(piece.corners[e], piece.corners[(e + 1) % 3]);
                if (numbers[e] < numbers[k])
                    k = e;
            }
            const std::uint32_t number = numbers[k];
            if (number == nothing) {
                check_rest(piece, before);
                continue;
            }
            const std::array<double, 4> edge = name_of(piece.corners[k], piece.corners[(k + 1) % 3]);
            std::array<double, 4>& its = bisections_[number].edge;
            shared_ = shared_ || (its != edge && its != std::array<double, 4>{});
            its = edge;
            if (piece.maker != nothing && number <= piece.maker) {
                fault_ = "bisection " + std::to_string(number) + " needs a later one";
                continue;
            }
            const std::size_t k1 = (k + 1) % 3;
            Piece one = piece, other = piece;
            const glm::dvec2 middle = (piece.corners[k].at + piece.corners[k1].at) / 2.0;
            one.corners[k1] = other.corners[k] = {middle, code_at(middle)};
            one.maker = other.maker = number;
            one.made_of = other.made_of = {piece.corners[k], piece.corners[k1]};
            const Fit fit_one = fit(one), fit_other = fit(other);
            record(bisections_[number], piece, one.made_of, before, fit_one.squared + fit_other.squared);
            waiting.emplace_back(one, fit_one);
            waiting.emplace_back(other, fit_other);
        }
    }

    void record(Bisection& bisection, const Piece& piece, const std::array<End, 2>& ends, const Fit& before,
                double squared_after) {
        bisection.largest = std::max(bisection.largest, before.largest);
        bisection.fall += before.squared - squared_after;
        bisection.size += before.squared + squared_after;
        ++bisection.pieces;
        for (const End& corner : piece.corners)
            for (const double code : {before.lowest, before.highest})
                bisection.reach = std::max(bisection.reach,
                                           distance(ends[0], {corner.at, code}) + distance(ends[1], {corner.at, code}));
        if (piece.maker != nothing) {
            const auto& m = piece.made_of;
            bisection.makers.emplace_back(piece.maker, std::min(distance(ends[0], m[0]) + distance(ends[1], m[1]),
                                                                distance(ends[0], m[1]) + distance(ends[1], m[0])));
        }
    }

    // An edge that can be bisected is, unless the piece has no error.
    void check_rest(const Piece& piece, const Fit& fit) {
        if (fit.squared < 1e-6)
            return;
        for (std::size_t e = 0; e < 3; ++e) {
            const glm::dvec2 texels = glm::abs(piece.corners[e].at - piece.corners[(e + 1) % 3].at);
            if (std::fmod(texels.x, 2) == 0 && std::fmod(texels.y, 2) == 0 && texels != glm::dvec2(0))
                fault_ = "an edge with an error of " + std::to_string(fit.largest) + " codes is never bisected";
        }
    }

    double distance(const End& a, const End& b) const {
        return glm::length(glm::dvec3(a.at - b.at, a.code - b.code) * source_.steps);
    }

    // Texel centres in the piece, its border included; on a clamped axis only those of the map. All products are exact.
    Fit fit(const Piece& piece) const {
        Fit result;
        const auto& c = piece.corners;
        for (const End& corner : c) {
            result.lowest = std::min(result.lowest, corner.code);
            result.highest = std::max(result.highest, corner.code);
        }
        const auto side = [](const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
            return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
        };
        const double whole = side(c[0].at, c[1].at, c[2].at);
        const auto [left, right] = std::minmax({c[0].at.x, c[1].at.x, c[2].at.x});
        const auto [bottom, top] = std::minmax({c[0].at.y, c[1].at.y, c[2].at.y});
        double last_row = std::floor(top - 0.5), last_column = std::floor(right - 0.5);
        if (period(0) == 0)
            last_column = std::min(last_column, map_.width() - 1.0);
        if (period(1) == 0)
            last_row = std::min(last_row, map_.height() - 1.0);
        for (double y = std::ceil(bottom - 0.5); y <= last_row; ++y) {
            // Where the row enters and leaves the piece, with a texel to spare; the exact test follows.
            double from = right, to = left;
            for (std::size_t k = 0; k < 3; ++k) {
                const glm::dvec2 a = c[k].at, b = c[(k + 1) % 3].at;
                const double at = y + 0.5;
                if (std::min(a.y, b.y) > at || std::max(a.y, b.y) < at)
                    continue;
                const double x = a.y == b.y ? a.x : a.x + (b.x - a.x) * (at - a.y) / (b.y - a.y);
                from = std::min({from, x, a.y == b.y ? b.x : x});
                to = std::max({to, x, a.y == b.y ? b.x : x});
            }
            for (double x = std::max(std::ceil(left - 0.5), std::floor(from) - 1);
                 x <= std::min(last_column, std::ceil(to)); ++x) {
                const glm::dvec2 p(x + 0.5, y + 0.5);
                const double s2 = side(c[0].at, c[1].at, p) / whole, s0 = side(c[1].at, c[2].at, p) / whole,
                             s1 = side(c[2].at, c[0].at, p) / whole;
                if (s0 < 0 || s1 < 0 || s2 < 0)
                    continue;
                const double code = code_at(p);
                const double error = code - (s0 * c[0].code + s1 * c[1].code + s2 * c[2].code);
                result.lowest = std::min(result.lowest, code);
                result.highest = std::max(result.highest, code);
                result.largest = std::max(result.largest, std::abs(error));
                result.squared += (s0 == 0 || s1 == 0 || s2 == 0 ? 0.5 : 1) * error * error;
            }
        }
        return result;
    }

    // Blocks of bisections, each the best on average that a bisection starts with those that need it.
    std::vector<EntryRange> ranks() const {
        if (source_.rank_bits == 0)
            return {};
        struct Block {
            double fall, size, pieces;
            std::multimap<double, std::uint32_t> next;  // by fall per piece
        };
        const std::size_t count = bisections_.size();
        std::vector<Block> blocks;
        std::vector<std::uint32_t> part_of(count);
        for (std::size_t k = 0; k < count; ++k) {
            blocks.push_back({bisections_[k].fall, bisections_[k].size, bisections_[k].pieces, {}});
            part_of[k] = static_cast<std::uint32_t>(k);
        }
        for (std::size_t k = count; k-- > 0;) {
            Block& block = blocks[k];
            while (!block.next.empty() && block.next.rbegin()->first > block.fall / block.pieces) {
                const auto best = std::prev(block.next.end());
                Block& joined = blocks[best->second];
                part_of[best->second] = static_cast<std::uint32_t>(k);
                block.next.erase(best);
                block.fall += joined.fall;
                block.size += joined.size;
                block.pieces += joined.pieces;
                if (block.next.size() < joined.next.size())
                    block.next.swap(joined.next);
                block.next.insert(joined.next.begin(), joined.next.end());
                joined.next.clear();
            }
            std::uint32_t youngest = nothing;
            for (const auto& [maker, apart] : bisections_[k].makers)
                youngest = youngest == nothing ? maker : std::max(youngest, maker);
            if (youngest != nothing)
                blocks[youngest].next.emplace(block.fall / block.pieces, static_cast<std::uint32_t>(k));
        }
        std::vector<EntryRange> result(count);
        for (std::size_t k = 0; k < count; ++k) {
            part_of[k] = part_of[part_of[k]];  // joined an earlier one, which is known
            const Block& block = blocks[part_of[k]];
            const double value = block.fall / block.pieces, off = 1e-11 * block.size / block.pieces;
            result[k] = entry_range(value - off, value + off, 16, 6, source_.rank_bits);
        }
        put_in_order(result, source_.rank_bits);
        return result;
    }

    std::vector<EntryRange> wanted_bounds() const {
        std::vector<EntryRange> result;
        if (source_.bound_bits > 0)
            for (const Bisection& it : bisections_)
                result.push_back(
                    entry_range(it.largest * (1 - 1e-11), it.largest * (1 + 1e-11), 8, 5, source_.bound_bits));
        return result;
    }

    // Each exceeds those that need it, and leaves room for as many as it needs itself.
    void put_in_order(std::vector<EntryRange>& entries, int bits) const {
        for (std::size_t k = entries.size(); k-- > 0;) {
            for (const auto& [maker, apart] : bisections_[k].makers) {
                entries[maker].low = std::max(entries[maker].low, entries[k].low + 1);
                entries[maker].high = std::max(entries[maker].high, entries[k].high + 1);
            }
        }
        std::vector<double> room(entries.size(), std::ldexp(1.0, bits) - 1);
        for (std::size_t k = 0; k < entries.size(); ++k) {
            for (const auto& [maker, apart] : bisections_[k].makers)
                room[k] = std::min(room[k], std::max(0.0, room[maker] - 1));
            entries[k].low = std::min(entries[k].low, room[k]);
            entries[k].high = std::min(entries[k].high, room[k]);
        }
    }

    EntryRange highest_threshold(const std::vector<EntryRange>& entries, const std::vector<EntryRange>& wanted) const {
        const double most = std::ldexp(1.0, source_.bound_bits) - 1;
        EntryRange highest{most, most};
        for (std::size_t k = 0; k < entries.size(); ++k) {
            if (entries[k].low < wanted[k].high)
                highest.low = std::min(highest.low, std::max(0.0, entries[k].low - 1));
            if (entries[k].high < wanted[k].low)
                highest.high = std::min(highest.high, std::max(0.0, entries[k].high - 1));
        }
        return highest;
    }

    // The least code c whose radius (8 + c mod 8) 2^(c / 8) is no less.
    static double radius_code(double radius) {
        int code = 0;
        while (code < 255 && std::ldexp(8 + code % 8, code / 8) < radius)
            ++code;
        return code;
    }

    std::vector<EntryRange> radii() const {
        if (!source_.radii)
            return {};
        std::vector<EntryRange> codes(bisections_.size());
        std::vector<EntryRange> reach;
        for (const Bisection& it : bisections_)
            reach.push_back({it.reach + source_.rounding, it.reach + source_.rounding});
        for (std::size_t k = bisections_.size(); k-- > 0;) {
            codes[k] = {radius_code(std::ceil(reach[k].low * (1 - 1e-12))),
                        radius_code(std::ceil(reach[k].high * (1 + 1e-12)))};
            const auto stored = [](double code) {
                const int c = static_cast<int>(code);
                return std::ldexp(8 + c % 8, c / 8);
            };
            for (const auto& [maker, apart] : bisections_[k].makers) {
                reach[maker].low = std::max(reach[maker].low, stored(codes[k].low) + apart + source_.rounding);
                reach[maker].high = std::max(reach[maker].high, stored(codes[k].high) + apart + source_.rounding);
            }
        }
        return codes;
    }

    std::vector<EntryRange> on_table(const std::vector<EntryRange>& entries) const {
        std::vector<EntryRange> table;
        if (!entries.empty() || bisections_.empty())
            table.resize(number_at_.size());
        for (std::size_t k = 0; k < entries.size(); ++k)
            table[source_.entry(source_.midpoints[k])] = entries[k];
        return table;
    }

    const Map& map_;
    const RankSource& source_;
    std::vector<std::uint32_t> number_at_;
    std::vector<Bisection> bisections_;
    bool shared_ = false;
    std::string fault_;
};

}  // namespace

DerivedRanks derive_ranks(const Map& map, const RankSource& source) {
    return Derivation(map, source).run();
}

}  // namespace tessera::golden
