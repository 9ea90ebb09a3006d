#include "testbench/check/mesh/base_edge_check.h"

#include <fmt/core.h>

#include <algorithm>
#include <tuple>

#include "testbench/check/mesh/corner_table.h"

namespace tessera {
namespace {

using datapath::Vertex;

/// Something of a base triangle, under the hash of what it is grouped by: equal ones lie side by side once
/// sorted, and few full comparisons are needed for that.
struct Entry {
    std::uint64_t hash;
    std::uint32_t index;  // 3 * base triangle + (edge or vertex)
};

auto position_key(const Vertex& v) {
    return std::make_tuple(v.position.x, v.position.y, v.position.z);
}

/// All that P' and N' depend on but P and t: equal frames, P and t give equal results.
auto frame_key(const Vertex& v) {
    return std::make_tuple(v.normal.x, v.normal.y, v.normal.z, v.tangent.x, v.tangent.y, v.tangent.z,
                           v.handedness);
}

class BaseEdgeCheck {
  public:
    BaseEdgeCheck(const EmittedMesh& mesh, const std::vector<datapath::Triangle>& base_triangles,
                  const datapath::Registers& registers, const BaseEdgeChains& chains, InvariantResult& result,
                  FirstViolation& first)
        : mesh_(mesh),
          base_(base_triangles),
          registers_(registers),
          chains_(chains),
          result_(result),
          first_(first) {
        const auto period = [&](std::uint32_t size, datapath::AddressMode mode) {
            return mode == datapath::AddressMode::repeat
                       ? std::int64_t{size} << registers.formats.texture.fraction
                       : 0;
        };
        period_u_ = period(registers.map.width, registers.map.address_u);
        period_v_ = period(registers.map.height, registers.map.address_v);
    }

    void check_edges();
    void check_vertices();

  private:
    const Vertex& vertex(std::uint32_t index) const { return base_[index / 3].vertices[index % 3]; }
    static std::uint32_t following(std::uint32_t index) { return next_corner(index); }

    /// An edge by its two ends, the lower P first.
    bool is_forward(std::uint32_t edge) const {
        return position_key(vertex(edge)) < position_key(vertex(following(edge)));
    }
    const Vertex& low_end(std::uint32_t edge) const {
        return vertex(is_forward(edge) ? edge : following(edge));
    }
    const Vertex& high_end(std::uint32_t edge) const {
        return vertex(is_forward(edge) ? following(edge) : edge);
    }
    auto place_key(std::uint32_t edge) const {
        return std::make_tuple(position_key(low_end(edge)), position_key(high_end(edge)));
    }

    /// t but for whole periods: that of the first end, and the way from there to the other.
    auto texture_key(std::uint32_t edge) const {
        const datapath::TexCoord &a = low_end(edge).texture, &b = high_end(edge).texture;
        return std::make_tuple(within_period(a.u, period_u_), within_period(a.v, period_v_),
                               std::int64_t{b.u} - std::int64_t{a.u}, std::int64_t{b.v} - std::int64_t{a.v});
    }
    auto side_key(std::uint32_t edge) const {
        return std::make_tuple(texture_key(edge), frame_key(low_end(edge)), frame_key(high_end(edge)));
    }
    auto vertex_key(std::uint32_t index) const {
        const Vertex& v = vertex(index);
        return std::make_tuple(position_key(v), within_period(v.texture.u, period_u_),
                               within_period(v.texture.v, period_v_), frame_key(v));
    }
    static std::int64_t within_period(std::uint32_t value, std::int64_t period) {
        return period == 0 ? std::int64_t{value} : std::int64_t{value} % period;
    }

    static std::uint64_t hash_position(std::uint64_t hash, const Vertex& v) {
        return hash_word(hash_pair(hash, v.position.x, v.position.y),
                         static_cast<std::uint32_t>(v.position.z));
    }

    /// Calls take(begin, end) for the entries of each key, by lowest index: neighbours in the base mesh mostly lie
    /// close in memory, which is what this costs.
    template <class Key, class Take>
    void for_each_group(std::vector<Entry>& entries, Key&& key, Take&& take) const {
        std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
            return a.hash != b.hash ? a.hash < b.hash : a.index < b.index;
        });
        struct Run {
            std::uint32_t lowest, begin;
        };
        std::vector<Run> runs;
        for (std::size_t i = 0; i < entries.size(); ++i)
            if (i == 0 || entries[i].hash != entries[i - 1].hash)
                runs.push_back({entries[i].index, static_cast<std::uint32_t>(i)});
        std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.lowest < b.lowest; });
        for (const Run& run : runs) {
            Entry* begin = entries.data() + run.begin;
            Entry* stop = begin + 1;
            while (stop != entries.data() + entries.size() && stop->hash == begin->hash)
                ++stop;
            const auto first_key = key(begin->index);
            if (std::any_of(begin + 1, stop, [&](const Entry& e) { return key(e.index) != first_key; }))
                std::sort(begin, stop, [&](const Entry& a, const Entry& b) {  // different keys, one hash
                    const auto key_a = key(a.index), key_b = key(b.index);
                    return key_a != key_b ? key_a < key_b : a.index < b.index;
                });
            while (begin != stop) {
                Entry* end = begin + 1;
                while (end != stop && key(end->index) == key(begin->index))
                    ++end;
                take(begin, end);
                begin = end;
            }
        }
    }

    enum class Sides { joined, texture_seam, crease };

    /// A piece as seen from the edge's low end.
    struct Piece {
        std::uint32_t begin, end;
        CornerRef low, high;
        bool ambiguous;
    };
    Piece piece(std::uint32_t edge, std::size_t index) const;

    void check_group(Entry* begin, Entry* end);
    void compare(std::uint32_t a, std::uint32_t b, Sides sides);
    void compare_stretch(std::uint32_t a, std::size_t a_begin, std::size_t a_end, std::uint32_t b,
                         std::size_t b_begin, std::size_t b_end, Sides sides);
    CornerRef corner_at(std::uint32_t index) const;

    const EmittedMesh& mesh_;
    const std::vector<datapath::Triangle>& base_;
    const datapath::Registers& registers_;
    const BaseEdgeChains& chains_;
    InvariantResult& result_;
    FirstViolation& first_;
    std::int64_t period_u_ = 0, period_v_ = 0;  // 0: the axis does not repeat
};

void BaseEdgeCheck::check_edges() {
    std::vector<Entry> entries;
    entries.reserve(3 * base_.size());
    for (std::uint32_t edge = 0; edge < 3 * base_.size(); ++edge)
        if (!(vertex(edge).position == vertex(following(edge)).position))
            entries.push_back({hash_position(hash_position(0, low_end(edge)), high_end(edge)), edge});
    for_each_group(
        entries, [&](std::uint32_t edge) { return place_key(edge); },
        [&](Entry* begin, Entry* end) { check_group(begin, end); });
}

void BaseEdgeCheck::check_group(Entry* begin, Entry* end) {
    ++result_.base_edges;
    if (end - begin == 1) {
        ++result_.border_base_edges;
        return;
    }
    if (end - begin > 2)
        ++result_.non_manifold_base_edges;
    std::sort(begin, end, [&](const Entry& a, const Entry& b) {
        const auto key_a = side_key(a.index), key_b = side_key(b.index);
        return key_a != key_b ? key_a < key_b : a.index < b.index;
    });
    const Entry* lone = nullptr;  // the first of the last odd group of joined sides
    bool seam = false, crease = false;
    for (Entry* first = begin; first != end;) {
        Entry* last = first + 1;
        for (; last != end && side_key(last->index) == side_key(first->index); ++last)
            compare(first->index, last->index, Sides::joined);
        if ((last - first) % 2 != 0) {
            if (lone != nullptr) {
                const bool same_texture = texture_key(lone->index) == texture_key(first->index);
                (same_texture ? crease : seam) = true;
                compare(lone->index, first->index, same_texture ? Sides::crease : Sides::texture_seam);
            }
            lone = first;
        }
        first = last;
    }
    result_.texture_seams += seam ? 1 : 0;
    result_.creases += !seam && crease ? 1 : 0;
}

BaseEdgeCheck::Piece BaseEdgeCheck::piece(std::uint32_t edge, std::size_t index) const {
    const std::size_t size = chains_.size(edge);
    const bool forward = is_forward(edge);
    const std::size_t at = forward ? index : size - 1 - index;
    const ChainPiece& p = chains_.piece(edge, at);
    const std::uint32_t end = at + 1 == size ? ChainPiece::whole : chains_.piece(edge, at + 1).begin;
    const bool ambiguous = p.ambiguous || p.first_coincides || p.last_coincides;
    if (forward)
        return {p.begin, end, p.first, p.last, ambiguous};
    return {ChainPiece::whole - end, ChainPiece::whole - p.begin, p.last, p.first, ambiguous};
}

void BaseEdgeCheck::compare(std::uint32_t a, std::uint32_t b, Sides sides) {
    // both are cut by halving, so between two places that both have, one of them has a single piece
    std::size_t i = 0, j = 0;
    while (i < chains_.size(a)) {
        std::size_t i_end = i + 1, j_end = j + 1;
        std::uint32_t a_at = piece(a, i).end, b_at = piece(b, j).end;
        while (a_at < b_at)
            a_at = piece(a, i_end++).end;
        while (b_at < a_at)
            b_at = piece(b, j_end++).end;
        compare_stretch(a, i, i_end, b, j, j_end, sides);
        i = i_end;
        j = j_end;
    }
}

void BaseEdgeCheck::compare_stretch(std::uint32_t a, std::size_t a_begin, std::size_t a_end, std::uint32_t b,
                                    std::size_t b_begin, std::size_t b_end, Sides sides) {
    bool missing = false, ambiguous = false;
    const auto look = [&](const Piece& p) {
        missing = missing || p.low == no_corner;
        ambiguous = ambiguous || p.ambiguous;
    };
    for (std::size_t i = a_begin; i < a_end; ++i)
        look(piece(a, i));
    for (std::size_t j = b_begin; j < b_end; ++j)
        look(piece(b, j));
    if (missing)
        return;  // and counted as such
    const auto corner = [&](CornerRef ref) -> const EmittedTriangle::Corner& {
        return corner_of(mesh_, ref);
    };
    const Piece a_first = piece(a, a_begin), b_first = piece(b, b_begin);
    const CornerRef a_low = a_first.low, b_low = b_first.low;
    const CornerRef a_high = piece(a, a_end - 1).high, b_high = piece(b, b_end - 1).high;
    const std::size_t pieces = std::max(a_end - a_begin, b_end - b_begin);
    const bool meet = corner(a_low).displaced == corner(b_low).displaced &&
                      corner(a_high).displaced == corner(b_high).displaced;
    if (sides != Sides::joined) {
        if (!meet || pieces > 1)
            (sides == Sides::crease ? result_.open_crease_edges : result_.open_texture_seam_edges) += pieces;
        return;
    }
    if (ambiguous) {
        result_.coincident_edges += !meet || pieces > 1 ? pieces : 0;
        return;
    }
    const auto report = [&](const char* what) {
        first_.offer(std::min(a, b) / 3, [&] {
            return fmt::format("base triangles {} and {}: {}: {}; {} on one side, {}; {} on the other", a / 3,
                               b / 3, what, describe_corner(mesh_, a_low, registers_.formats),
                               describe_corner(mesh_, a_high, registers_.formats),
                               describe_corner(mesh_, b_low, registers_.formats),
                               describe_corner(mesh_, b_high, registers_.formats));
        });
    };
    if (pieces > 1) {
        result_.t_vertices += pieces - 1;
        report("T-vertex: a piece of their common edge is whole on one side and split on the other");
    }
    if (!meet) {
        ++result_.cracks;
        report("a piece of their common edge lies at different P'");
    }
    if (a_first.begin != 0) {
        const auto &p = corner(a_low), &q = corner(b_low);
        if (!(p.displaced == q.displaced && p.displaced_normal == q.displaced_normal &&
              p.generation == q.generation)) {
            ++result_.inconsistent_vertices;
            report("a vertex of their common edge has different P', N' or generation");
        }
    }
}

/// What was emitted of a base vertex: it begins its triangle's edge of the same number, and ends the one
/// before. no_corner: nothing, or what it is cannot be said.
CornerRef BaseEdgeCheck::corner_at(std::uint32_t index) const {
    const ChainPiece& begins = chains_.piece(index, 0);
    if (begins.first != no_corner)
        return begins.first_coincides ? no_corner : begins.first;
    const std::uint32_t before = index % 3 == 0 ? index + 2 : index - 1;
    const ChainPiece& ends = chains_.piece(before, chains_.size(before) - 1);
    return ends.last_coincides ? no_corner : ends.last;
}

void BaseEdgeCheck::check_vertices() {
    std::vector<Entry> entries;
    entries.reserve(3 * base_.size());
    for (std::uint32_t index = 0; index < 3 * base_.size(); ++index) {
        const Vertex& v = vertex(index);
        std::uint64_t hash = hash_position(0, v);
        hash = hash_word(hash, static_cast<std::uint64_t>(within_period(v.texture.u, period_u_)));
        hash = hash_word(hash, static_cast<std::uint64_t>(within_period(v.texture.v, period_v_)));
        entries.push_back({hash, index});
    }
    for_each_group(
        entries, [&](std::uint32_t index) { return vertex_key(index); },
        [&](const Entry* begin, const Entry* end) {
            CornerRef one = no_corner;
            for (const Entry* entry = begin; entry != end; ++entry) {
                const CornerRef other = corner_at(entry->index);
                if (one == no_corner || other == no_corner) {
                    one = one == no_corner ? other : one;
                    continue;
                }
                const auto &p = corner_of(mesh_, one), &q = corner_of(mesh_, other);
                if (p.displaced == q.displaced && p.displaced_normal == q.displaced_normal &&
                    p.generation == q.generation)
                    continue;
                ++result_.inconsistent_vertices;
                const std::uint32_t first_base = std::min(begin->index, entry->index) / 3;
                first_.offer(first_base, [&] {
                    return fmt::format(
                        "base triangle {}: a base vertex has different P', N' or generation than in base "
                        "triangle {}: "
                        "{}; {}",
                        mesh_.triangles[one / 3].base, mesh_.triangles[other / 3].base,
                        describe_corner(mesh_, one, registers_.formats),
                        describe_corner(mesh_, other, registers_.formats));
                });
                break;
            }
        });
}

}  // namespace

void check_base_edges(const EmittedMesh& mesh, const std::vector<datapath::Triangle>& base_triangles,
                      const datapath::Registers& registers, const BaseEdgeChains& chains,
                      InvariantResult& result, FirstViolation& first) {
    BaseEdgeCheck check(mesh, base_triangles, registers, chains, result, first);
    check.check_edges();
    check.check_vertices();
}

}  // namespace tessera
