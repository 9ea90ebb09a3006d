#include "testbench/check/mesh/patch_check.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <tuple>

namespace tessera {
namespace {

using Corner = EmittedTriangle::Corner;
__extension__ using Wide = __int128;

template <class HasTexture>
Place in_texture(const HasTexture& vertex) {
    return {vertex.texture.u, vertex.texture.v};
}
template <class HasPosition>
Place in_position(const HasPosition& vertex, int along) {
    const datapath::Position& p = vertex.position;
    return along == 0 ? Place{p.y, p.z} : (along == 1 ? Place{p.z, p.x} : Place{p.x, p.y});
}

std::int64_t manhattan(const Place& a, const Place& b) {
    return std::abs(a.x - b.x) + std::abs(a.y - b.y);
}

/// Twice the signed area of origin, a, b.
Wide doubled_area(const Place& origin, const Place& a, const Place& b) {
    return Wide{a.x - origin.x} * (b.y - origin.y) - Wide{a.y - origin.y} * (b.x - origin.x);
}

Wide doubled_area(const EmittedTriangle& triangle) {
    const auto& c = triangle.corners;
    return doubled_area(in_texture(c[0]), in_texture(c[1]), in_texture(c[2]));
}

Wide absolute(Wide value) {
    return value < 0 ? -value : value;
}

int generation_of(const EmittedTriangle& triangle) {
    const auto& c = triangle.corners;
    return std::max({c[0].generation, c[1].generation, c[2].generation});
}

/// How often its edges have been cut, at most: its generation, unless that may have saturated.
int depth_of(const EmittedTriangle& triangle, const datapath::Registers& registers) {
    const int generation = generation_of(triangle);
    const bool saturated =
        !registers.tests.generation_test && generation == (1 << registers.formats.generation_bits) - 1;
    return saturated ? 255 : generation;
}

/// Twice the bound on what rounding does to a triangle's doubled area: see
/// InvariantResult::collapsed_explained.
template <class ToPlace>
Wide doubled_rounding(const EmittedTriangle& triangle, int depth, ToPlace&& place) {
    const auto& c = triangle.corners;
    const Place a = place(c[0]), b = place(c[1]), d = place(c[2]);
    std::array<std::int64_t, 3> lengths = {manhattan(a, b), manhattan(b, d), manhattan(d, a)};
    std::sort(lengths.begin(), lengths.end());
    const Wide g = depth;
    return g * (lengths[0] + lengths[1]) + g * g;
}

bool alike(const Corner& a, const Corner& b) {
    return a.displaced == b.displaced && a.displaced_normal == b.displaced_normal &&
           a.generation == b.generation;
}

}  // namespace

PatchCheck::PatchCheck(const EmittedMesh& mesh, const std::vector<datapath::Triangle>& base_triangles,
                       const datapath::Registers& registers, InvariantResult& result, FirstViolation& first,
                       BaseEdgeChains& chains)
    : mesh_(mesh),
      base_triangles_(base_triangles),
      registers_(registers),
      result_(result),
      first_(first),
      chains_(chains),
      vertices_(mesh) {}

void PatchCheck::check(std::uint32_t base, const std::uint32_t* triangles, std::size_t count) {
    base_ = base;
    const auto& v = base_triangles_[base].vertices;
    base_area_ = doubled_area(in_texture(v[0]), in_texture(v[1]), in_texture(v[2]));
    base_sign_ = base_area_ > 0 ? 1 : (base_area_ < 0 ? -1 : 0);
    base_seen_area_ = 0;
    plane_ = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const Wide area =
            doubled_area(in_position(v[0], axis), in_position(v[1], axis), in_position(v[2], axis));
        if (absolute(area) > absolute(base_seen_area_)) {
            base_seen_area_ = area;
            plane_ = axis;
        }
    }
    start(texture_folds_, base_area_, in_texture(v[0]), in_texture(v[1]), in_texture(v[2]));
    start(position_folds_, base_seen_area_, in_position(v[0], plane_), in_position(v[1], plane_),
          in_position(v[2], plane_));
    patch_area_ = border_area_ = border_rounding_ = 0;
    doubled_edge_ = false;
    unlike_.clear();
    coincident_.clear();
    edges_.clear();
    open_.clear();

    number_vertices(triangles, count);
    for (std::size_t i = 0; i < count; ++i)
        judge_shape(triangles[i]);
    judge_vertices();
    match_edges();
    walk_border();
    judge_remaining();
    compare_areas();
    if (doubled_edge_)
        count_duplicates(triangles, count);
}

void PatchCheck::start(FoldMap& folds, Wide area, const Place& a, const Place& b, const Place& c) {
    folds.start({std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})},
                {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})});
    if (area == 0)
        folds.add_everything();
}

void PatchCheck::number_vertices(const std::uint32_t* triangles, std::size_t count) {
    vertices_.start(3 * count);
    edges_.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
        std::array<std::uint32_t, 3> ids;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const CornerRef ref = 3 * triangles[i] + k;
            ids[k] = vertices_.insert(ref);
            if (!alike(corner_of(mesh_, ref), corner_of(mesh_, vertices_.first_corner(ids[k]))))
                unlike_.push_back(ref);
        }
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t a = ids[k], b = ids[k == 2 ? 0 : k + 1];
            if (a != b)  // an edge of no length has no sides
                edges_.push_back(
                    {std::min(a, b), std::max(a, b), 2 * (3 * triangles[i] + k) + (a > b ? 1 : 0)});
        }
    }
}

bool PatchCheck::is_explained(const EmittedTriangle& triangle) const {
    if (base_sign_ == 0)
        return true;
    // how much smaller its exact area may be than the bound of rounding, doubled
    const int depth = depth_of(triangle, registers_);
    const Wide room = doubled_rounding(triangle, depth, [](const Corner& c) { return in_texture(c); }) -
                      2 * absolute(doubled_area(triangle));
    if (2 * (absolute(base_area_) >> std::min(2 * depth, 126)) > room)
        return false;
    if (base_seen_area_ == 0)
        return true;
    // P was halved as t was: what is left of the base triangle's area there, at least, is left of it in t
    const auto in_plane = [&](const Corner& c) { return in_position(c, plane_); };
    const Wide area = doubled_area(in_plane(triangle.corners[0]), in_plane(triangle.corners[1]),
                                   in_plane(triangle.corners[2])) *
                      (base_seen_area_ < 0 ? -1 : 1);
    const Wide left = 2 * area - doubled_rounding(triangle, depth, in_plane);
    Wide needed, possible;
    if (__builtin_mul_overflow(left, absolute(base_area_), &needed) ||
        __builtin_mul_overflow(room, absolute(base_seen_area_), &possible))
        return true;  // formats wide enough for this overflow nowhere else
    return needed <= possible;
}

void PatchCheck::judge_shape(std::uint32_t index) {
    const EmittedTriangle& triangle = mesh_.triangles[index];
    const auto& c = triangle.corners;
    const Wide area = doubled_area(triangle);
    patch_area_ += area;
    if (c[0].displaced == c[1].displaced || c[1].displaced == c[2].displaced ||
        c[2].displaced == c[0].displaced)
        ++result_.displaced_collapsed;
    const auto& tests = registers_.tests;
    if (tests.generation_test && generation_of(triangle) > static_cast<int>(tests.generation_limit)) {
        ++result_.generation_violations;
        first_.offer(base_, [&] {
            return fmt::format("base triangle {}: a vertex of generation {} is beyond the limit of {}: {}",
                               base_, generation_of(triangle), tests.generation_limit,
                               describe_corner(mesh_, 3 * index, registers_.formats));
        });
    }

    const Place seen[] = {in_position(c[0], plane_), in_position(c[1], plane_), in_position(c[2], plane_)};
    const Wide seen_area = doubled_area(seen[0], seen[1], seen[2]);
    if (base_seen_area_ != 0 && (base_seen_area_ < 0 ? seen_area >= 0 : seen_area <= 0))
        position_folds_.add(seen[0], seen[1], seen[2]);

    const bool turned = base_sign_ != 0 && area * base_sign_ < 0;
    if (area != 0 && !turned)
        return;
    if (base_sign_ != 0)
        texture_folds_.add(in_texture(c[0]), in_texture(c[1]), in_texture(c[2]));
    const bool explained = is_explained(triangle);
    ++(turned ? result_.turned_over : result_.collapsed);
    if (explained)
        ++(turned ? result_.turned_over_explained : result_.collapsed_explained);
    else
        first_.offer(base_, [&] {
            return fmt::format(
                "base triangle {}: a triangle {} in texture space, which rounding does not explain: {}; {}; "
                "{}",
                base_, turned ? "turned over" : "collapsed",
                describe_corner(mesh_, 3 * index, registers_.formats),
                describe_corner(mesh_, 3 * index + 1, registers_.formats),
                describe_corner(mesh_, 3 * index + 2, registers_.formats));
        });
}

/// Two vertices can share (P, t) only where the patch is folded both in P and in t.
bool PatchCheck::may_coincide(const Corner& corner) {
    return texture_folds_.covers(in_texture(corner)) && position_folds_.covers(in_position(corner, plane_));
}

void PatchCheck::judge_vertices() {
    const auto vertex_of = [&](CornerRef ref) {
        return vertices_.find(surface_point(corner_of(mesh_, ref)));
    };
    std::sort(unlike_.begin(), unlike_.end(), [&](CornerRef a, CornerRef b) {
        return std::make_tuple(vertex_of(a), a) < std::make_tuple(vertex_of(b), b);
    });
    std::uint32_t last = CornerTable::none;
    for (const CornerRef ref : unlike_) {
        const std::uint32_t vertex = vertex_of(ref);
        if (vertex == last)
            continue;
        last = vertex;
        const Corner& corner = corner_of(mesh_, ref);
        if (may_coincide(corner)) {
            ++result_.coincident_vertices;
            coincident_.push_back(vertex);
            continue;
        }
        ++result_.inconsistent_vertices;
        first_.offer(base_, [&] {
            const CornerRef other = vertices_.first_corner(vertex);
            return fmt::format(
                "base triangle {}: one vertex has different P', N' or generation in two triangles: {}, "
                "generation {}; {}, generation {}",
                base_, describe_corner(mesh_, other, registers_.formats), corner_of(mesh_, other).generation,
                describe_corner(mesh_, ref, registers_.formats), corner_of(mesh_, ref).generation);
        });
    }
}

void PatchCheck::crack_between(CornerRef first, const char* what) {
    ++result_.cracks;
    first_.offer(base_, [&] {
        return fmt::format("base triangle {}: the edge {}; {} {}", base_,
                           describe_corner(mesh_, first, registers_.formats),
                           describe_corner(mesh_, next_corner(first), registers_.formats), what);
    });
}

void PatchCheck::match_edges() {
    std::sort(edges_.begin(), edges_.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::make_tuple(std::uint64_t{a.low} << 32 | a.high, a.corner_and_way) <
               std::make_tuple(std::uint64_t{b.low} << 32 | b.high, b.corner_and_way);
    });
    const HalfEdge* begin = edges_.data();
    const HalfEdge* const stop = begin + edges_.size();
    while (begin != stop) {
        const HalfEdge* end = begin + 1;
        while (end != stop && end->low == begin->low && end->high == begin->high)
            ++end;
        match_run(begin, end);
        begin = end;
    }
}

void PatchCheck::match_run(const HalfEdge* begin, const HalfEdge* end) {
    const auto low_corner = [&](const HalfEdge& e) -> const Corner& {
        const CornerRef ref = e.corner_and_way >> 1;
        return corner_of(mesh_, (e.corner_and_way & 1) == 0 ? ref : next_corner(ref));
    };
    const auto high_corner = [&](const HalfEdge& e) -> const Corner& {
        const CornerRef ref = e.corner_and_way >> 1;
        return corner_of(mesh_, (e.corner_and_way & 1) != 0 ? ref : next_corner(ref));
    };
    const auto same_ends = [&](const HalfEdge& a, const HalfEdge& b) {
        return alike(low_corner(a), low_corner(b)) && alike(high_corner(a), high_corner(b));
    };
    const auto meet = [&](const HalfEdge& a, const HalfEdge& b) {
        return low_corner(a).displaced == low_corner(b).displaced &&
               high_corner(a).displaced == high_corner(b).displaced;
    };
    // at each end one vertex, or two that rounding has put into one place
    const auto coincide = [&](const HalfEdge& a, const HalfEdge& b) {
        const auto fine = [&](const Corner& one, const Corner& other) {
            return one.displaced == other.displaced || may_coincide(one);
        };
        return fine(low_corner(a), low_corner(b)) && fine(high_corner(a), high_corner(b));
    };
    const auto opposite = [](const HalfEdge& a, const HalfEdge& b) {
        return ((a.corner_and_way ^ b.corner_and_way) & 1) != 0;
    };
    const auto keep_open = [&](const HalfEdge& e) {
        open_.push_back({e.low, e.high, e.corner_and_way, false, end - begin > 2});
    };

    if (end - begin == 1) {
        keep_open(*begin);
        return;
    }
    if (end - begin == 2 && opposite(begin[0], begin[1]) && meet(begin[0], begin[1]))
        return;

    // two with the same ends cancel first (rounding may have put several edges here), then two that meet in
    // P', then two that are only the same edge
    run_.assign(begin, end);
    std::sort(run_.begin(), run_.end(), [&](const HalfEdge& a, const HalfEdge& b) {
        const auto key = [&](const HalfEdge& e) {
            const Corner &low = low_corner(e), &high = high_corner(e);
            return std::make_tuple(low.displaced.x, low.displaced.y, low.displaced.z, high.displaced.x,
                                   high.displaced.y, high.displaced.z, low.generation, high.generation,
                                   low.displaced_normal.x, low.displaced_normal.y, low.displaced_normal.z,
                                   high.displaced_normal.x, high.displaced_normal.y, high.displaced_normal.z,
                                   e.corner_and_way);
        };
        return key(a) < key(b);
    });
    const auto cancel = [&](auto&& may_cancel, bool is_crack) {
        // a stack: of those that may cancel one another, whatever remains runs one way
        std::size_t top = 0;
        for (const HalfEdge edge : run_) {
            if (top == 0 || !opposite(run_[top - 1], edge) || !may_cancel(run_[top - 1], edge)) {
                run_[top++] = edge;
                continue;
            }
            --top;
            if (is_crack && coincide(run_[top], edge))
                ++result_.coincident_edges;
            else if (is_crack)
                crack_between(edge.corner_and_way >> 1,
                              "lies at another P' in the triangle on its other side");
        }
        run_.resize(top);
    };
    cancel(same_ends, false);
    cancel(meet, false);
    if (end - begin > 2)
        result_.coincident_edges += run_.empty() ? 1u : 0u;
    doubled_edge_ = doubled_edge_ || end - begin > 2 || !opposite(begin[0], begin[1]);
    cancel([](const HalfEdge&, const HalfEdge&) { return true; }, true);
    std::sort(run_.begin(), run_.end(),
              [](const HalfEdge& a, const HalfEdge& b) { return a.corner_and_way < b.corner_and_way; });
    for (const HalfEdge& e : run_)
        keep_open(e);
}

PatchCheck::OpenEdge* PatchCheck::find_open(std::uint32_t from, std::uint32_t to) {
    const std::uint32_t low = std::min(from, to), high = std::max(from, to);
    auto found = std::lower_bound(open_.begin(), open_.end(), std::make_tuple(low, high),
                                  [](const OpenEdge& e, const std::tuple<std::uint32_t, std::uint32_t>& key) {
                                      return std::make_tuple(e.low, e.high) < key;
                                  });
    for (; found != open_.end() && found->low == low && found->high == high; ++found)
        if (!found->used && (found->corner_and_way & 1) == (from > to ? 1u : 0u))
            return &*found;
    return nullptr;
}

const PatchCheck::HalfEdge* PatchCheck::find_matched(std::uint32_t from, std::uint32_t to) const {
    const std::uint32_t low = std::min(from, to), high = std::max(from, to);
    auto found = std::lower_bound(edges_.begin(), edges_.end(), std::make_tuple(low, high),
                                  [](const HalfEdge& e, const std::tuple<std::uint32_t, std::uint32_t>& key) {
                                      return std::make_tuple(e.low, e.high) < key;
                                  });
    for (; found != edges_.end() && found->low == low && found->high == high; ++found)
        if ((found->corner_and_way & 1) == (from > to ? 1u : 0u))
            return &*found;
    return nullptr;
}

/// Takes a pair of matched edges apart again, if there is one, and gives the half that runs this way.
PatchCheck::OpenEdge* PatchCheck::reopen(std::uint32_t from, std::uint32_t to) {
    const HalfEdge *const there = find_matched(from, to), *const back = find_matched(to, from);
    if (there == nullptr || back == nullptr)
        return nullptr;
    const auto at =
        std::lower_bound(open_.begin(), open_.end(), *there, [](const OpenEdge& a, const HalfEdge& b) {
            return std::tie(a.low, a.high) < std::tie(b.low, b.high);
        });
    const OpenEdge pair[] = {{there->low, there->high, there->corner_and_way, false, true},
                             {back->low, back->high, back->corner_and_way, false, true}};
    open_.insert(at, std::begin(pair), std::end(pair));
    return find_open(from, to);
}

/// The midpoint of a, b is a vertex of the patch.
bool PatchCheck::is_split(const SurfacePoint& a, const SurfacePoint& b, SurfacePoint& middle) {
    middle = midpoint(a, b);
    return !(middle == a) && !(middle == b) && vertices_.find(middle) != CornerTable::none;
}

/// There are edges, matched or not, all along from a to b.
bool PatchCheck::is_covered(const SurfacePoint& a, const SurfacePoint& b, int depth) {
    const std::uint32_t from = vertices_.find(a), to = vertices_.find(b);
    if (from == CornerTable::none || to == CornerTable::none)
        return false;
    if (find_open(from, to) != nullptr || find_matched(from, to) != nullptr)
        return true;
    SurfacePoint middle;
    return depth < ChainPiece::max_depth && is_split(a, b, middle) && is_covered(a, middle, depth + 1) &&
           is_covered(middle, b, depth + 1);
}

void PatchCheck::walk_border() {
    const auto& v = base_triangles_[base_].vertices;
    for (std::size_t k = 0; k < 3; ++k) {
        const SurfacePoint a = surface_point(v[k]), b = surface_point(v[(k + 1) % 3]);
        pieces_of_edge_ = 0;
        depth_of_edge_ = 0;
        walk(a, b, 0, 0);
        chains_.end_edge();
        if (pieces_of_edge_ > 1) {
            const Wide six_e = 2 * depth_of_edge_ + 1;
            border_rounding_ += 12 * six_e * manhattan(in_texture(a), in_texture(b)) +
                                static_cast<Wide>(pieces_of_edge_) * six_e * six_e;
        }
    }
}

void PatchCheck::walk(const SurfacePoint& a, const SurfacePoint& b, std::uint32_t begin, int depth) {
    const std::uint32_t from = vertices_.find(a), to = vertices_.find(b);
    const bool ends_exist = from != CornerTable::none && to != CornerTable::none;
    OpenEdge* open = ends_exist ? find_open(from, to) : nullptr;
    if (open == nullptr) {
        SurfacePoint middle;
        bool split = depth < ChainPiece::max_depth && is_split(a, b, middle);
        if (is_folded() && ends_exist &&
            !(split && is_covered(a, middle, depth + 1) && is_covered(middle, b, depth + 1))) {
            open = reopen(from, to);
            split = split && open == nullptr;
        }
        if (split) {
            walk(a, middle, begin, depth + 1);
            walk(middle, b, begin + (ChainPiece::whole >> (depth + 1)), depth + 1);
            return;
        }
    }
    ++pieces_of_edge_;
    depth_of_edge_ = std::max(depth_of_edge_, depth);
    border_area_ +=
        doubled_area(in_texture(base_triangles_[base_].vertices[0]), in_texture(a), in_texture(b));
    if (open != nullptr) {
        open->used = true;
        const CornerRef first = open->corner_and_way >> 1;
        chains_.add_piece({begin, first, next_corner(first), open->ambiguous && is_folded(), coincides(from),
                           coincides(to)});
        return;
    }
    chains_.add_piece({begin, no_corner, no_corner, false, false, false});
    if (OpenEdge* const turned = ends_exist ? find_open(to, from) : nullptr)
        turned->used = true;  // the same place once more
    ++result_.cracks;
    first_.offer(base_, [&] {
        return fmt::format("base triangle {}: no triangle has this piece of its border: {}; {}", base_,
                           describe_point(a, registers_.formats), describe_point(b, registers_.formats));
    });
}

std::uint64_t PatchCheck::take_opposite(const SurfacePoint& a, const SurfacePoint& b, int depth) {
    const std::uint32_t from = vertices_.find(a), to = vertices_.find(b);
    if (from == CornerTable::none || to == CornerTable::none)
        return 0;
    if (depth > 0) {
        if (OpenEdge* const open = find_open(from, to)) {
            open->used = true;
            return 0;
        }
    }
    if (depth == ChainPiece::max_depth)
        return 0;
    SurfacePoint middle;
    if (!is_split(a, b, middle))
        return 0;
    return 1 + take_opposite(a, middle, depth + 1) + take_opposite(middle, b, depth + 1);
}

void PatchCheck::judge_remaining() {
    for (OpenEdge& open : open_) {
        if (open.used)
            continue;
        const CornerRef first = open.corner_and_way >> 1;
        const std::uint64_t between = take_opposite(surface_point(corner_of(mesh_, next_corner(first))),
                                                    surface_point(corner_of(mesh_, first)), 0);
        if (between == 0)
            continue;
        open.used = true;
        result_.t_vertices += between;
        first_.offer(base_, [&] {
            return fmt::format(
                "base triangle {}: T-vertex: the edge {}; {} is whole here and split on its other side",
                base_, describe_corner(mesh_, first, registers_.formats),
                describe_corner(mesh_, next_corner(first), registers_.formats));
        });
    }
    const OpenEdge* last = nullptr;
    for (const OpenEdge& open : open_) {
        if (open.used || (last != nullptr && last->low == open.low && last->high == open.high))
            continue;
        last = &open;
        crack_between(open.corner_and_way >> 1, "does not have one triangle on each side");
    }
}

void PatchCheck::compare_areas() {
    if (patch_area_ != border_area_) {
        ++result_.area_mismatches;
        first_.offer(base_, [&] {
            return fmt::format(
                "base triangle {}: its triangles' texture areas add up to {} than its border encloses", base_,
                (patch_area_ - border_area_) * base_sign_ > 0 ? "more" : "less");
        });
    }
    if (36 * absolute(border_area_ - base_area_) > border_rounding_) {
        ++result_.areas_beyond_rounding;
        first_.offer(base_, [&] {
            return fmt::format(
                "base triangle {}: its subdivided border encloses another texture area than it does itself, "
                "by more "
                "than rounding explains",
                base_);
        });
    }
}

void PatchCheck::count_duplicates(const std::uint32_t* triangles, std::size_t count) {
    triples_.clear();
    for (std::size_t i = 0; i < count; ++i) {
        const EmittedTriangle& triangle = mesh_.triangles[triangles[i]];
        const auto may_be_folded = [&](auto&& place) {
            const auto& c = triangle.corners;
            return 2 * absolute(doubled_area(place(c[0]), place(c[1]), place(c[2]))) <=
                   doubled_rounding(triangle, depth_of(triangle, registers_), place);
        };
        if (may_be_folded([](const Corner& c) { return in_texture(c); }) &&
            may_be_folded([&](const Corner& c) { return in_position(c, plane_); }))
            continue;  // rounding may have put two into one place
        std::array<std::uint32_t, 3> ids;
        for (std::uint32_t k = 0; k < 3; ++k)
            ids[k] = vertices_.find(surface_point(corner_of(mesh_, 3 * triangles[i] + k)));
        std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end()), ids.end());
        triples_.push_back(ids);
    }
    std::sort(triples_.begin(), triples_.end());
    for (std::size_t i = 1; i < triples_.size(); ++i)
        if (triples_[i] == triples_[i - 1]) {
            ++result_.duplicate_triangles;
            first_.offer(base_, [&] {
                return fmt::format(
                    "base triangle {}: a triangle was emitted more than once, with the vertex {}", base_,
                    describe_corner(mesh_, vertices_.first_corner(triples_[i][0]), registers_.formats));
            });
        }
}

}  // namespace tessera
