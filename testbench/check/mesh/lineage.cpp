#include "testbench/check/mesh/lineage.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <tuple>

#include "modules/datapath/tessellate.h"
#include "testbench/check/mesh/corner_text.h"
#include "testbench/common/distinct_table.h"

namespace tessera {

using datapath::TrianglePass, datapath::Vertex;

namespace {

std::uint64_t hash_of(const datapath::Position& p) {
    return mix_hash(mix_hash(0, hash_word(p.x, p.y)), hash_word(0, p.z));
}

}  // namespace

Lineage::Lineage(const MachineSetup& setup, BareRecursion& bare) : setup_(setup) {
    const datapath::MapGeometry& map = setup.registers.map;
    const auto period = [&](std::uint32_t size, datapath::AddressMode mode) {
        return mode == datapath::AddressMode::repeat ? std::uint64_t{size} << setup.registers.formats.texture.fraction
                                                     : 0;
    };
    period_u_ = period(map.width, map.address_u);
    period_v_ = period(map.height, map.address_v);
    name_base_mesh(bare);
}

std::uint64_t Lineage::within_period(std::uint32_t value, std::uint64_t period) const {
    return period == 0 ? value : value % period;
}

bool Lineage::same_texture(const datapath::TexCoord& a, const datapath::TexCoord& b) const {
    return a == b || (within_period(a.u, period_u_) == within_period(b.u, period_u_) &&
                      within_period(a.v, period_v_) == within_period(b.v, period_v_));
}

template <class Text>
void Lineage::fault(std::uint64_t& count, Text&& text) {
    ++count;
    if (result_.first_violation.empty())
        result_.first_violation =
            fmt::format("{}: {}", base_ == none ? "base mesh" : fmt::format("base triangle {}", base_), text());
}

std::string Lineage::vertex_text(const Vertex& v) const {
    return corner_text({v.position, v.displaced, v.displaced_normal, v.texture, v.generation},
                       setup_.registers.formats);
}

void Lineage::name_base_mesh(BareRecursion& bare) {
    DistinctTable vertex_table, edge_table;
    const auto vertex_hash = [&](const Vertex& v) {
        std::uint64_t hash = hash_of(v.position);
        for (const std::uint64_t part : {hash_word(v.normal.x, v.normal.y), hash_word(v.normal.z, v.tangent.x),
                                         hash_word(v.tangent.y, v.tangent.z), within_period(v.texture.u, period_u_),
                                         within_period(v.texture.v, period_v_)})
            hash = mix_hash(hash, part);
        return hash;
    };
    const auto number_vertex = [&](const Vertex& v) {
        const Number number = vertex_table.number_of(
            vertex_hash(v),
            [&](Number known) {
                const Vertex& other = vertices_[known].vertex;
                return v.position == other.position && v.normal == other.normal && v.tangent == other.tangent &&
                       v.handedness == other.handedness && same_texture(v.texture, other.texture);
            },
            [&](Number known) { return vertex_hash(vertices_[known].vertex); });
        if (number == vertices_.kept().size())
            vertices_.add(false, {v});
        return number;
    };
    const auto edge_hash = [&](const Edge& edge, const Way& way) {
        return mix_hash(
            mix_hash(mix_hash(0, std::uint64_t{edge.from} << 32 | edge.to), static_cast<std::uint64_t>(way.u)),
            static_cast<std::uint64_t>(way.v));
    };
    const auto number_edge = [&](Edge edge, Way way) {
        // If both ends have the same number (whole periods apart), the sign of the change in t gives the direction.
        const bool along = std::make_tuple(edge.from, -way.u, -way.v) < std::make_tuple(edge.to, way.u, way.v);
        if (!along) {
            std::swap(edge.from, edge.to);
            way = way.turned();
        }
        const Number number = edge_table.number_of(
            edge_hash(edge, way),
            [&](Number known) {
                return edges_[known].from == edge.from && edges_[known].to == edge.to && ways_[known] == way;
            },
            [&](Number known) { return edge_hash(edges_[known], ways_[known]); });
        if (number == ways_.size()) {
            edges_.add(false, edge);
            ways_.push_back(way);
        }
        ++edges_[number].wanted.of(along);
        return Side{number, along};
    };
    base_notes_.reserve(setup_.base_triangles.size());
    for (datapath::Triangle base : setup_.base_triangles) {
        bare.complete_base(base);
        Note note{};
        for (std::size_t k = 0; k < 3; ++k)
            note.vertices[k] = number_vertex(base.vertices[k]);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            const datapath::TexCoord &a = base.vertices[k].texture, &b = base.vertices[next].texture;
            note.edges[k] = number_edge({note.vertices[k], note.vertices[next], none, none, {}, {}},
                                        {std::int64_t{b.u} - std::int64_t{a.u}, std::int64_t{b.v} - std::int64_t{a.v}});
        }
        base_notes_.push_back(note);
    }
}

Lineage::Note Lineage::begin(const datapath::Triangle& base) {
    judge_patch();
    base_ = base.base;
    return base_notes_[base_];
}

void Lineage::meet(Number vertex, const Vertex& seen) {
    KnownVertex& known = vertices_[vertex];
    const Vertex& v = known.vertex;
    if (known.unlike ||
        (seen.position == v.position && seen.normal == v.normal && seen.tangent == v.tangent &&
         same_texture(seen.texture, v.texture) && seen.handedness == v.handedness && seen.generation == v.generation &&
         seen.displaced == v.displaced && seen.displaced_normal == v.displaced_normal && seen.screen == v.screen))
        return;
    known.unlike = true;
    fault(result_.inconsistent_vertices,
          [&] { return fmt::format("a vertex differs between triangles: {}; {}", vertex_text(v), vertex_text(seen)); });
}

void Lineage::split(const Side& side, const Vertex& inserted) {
    const Edge whole = edges_[side.edge];
    if (whole.middle != none)
        return;
    const bool inside = Numbered<Edge>::is_inside(side.edge);
    const Number middle = vertices_.add(inside, {inserted});
    const Number pieces = edges_.add(inside, {whole.from, middle, none, none, whole.wanted, {}});
    edges_.add(inside, {middle, whole.to, none, none, whole.wanted, {}});
    edges_[side.edge].middle = middle;
    edges_[side.edge].pieces = pieces;
}

void Lineage::decided(const TrianglePass& pass, const datapath::ChildIndices&, const Note& note) {
    for (std::size_t k = 0; k < 3; ++k)
        meet(note.vertices[k], pass.triangle.vertices[k]);
    if (pass.split == 0) {
        for (const Side& side : note.edges)
            ++edges_[side.edge].found.of(side.along);
        return;
    }
    for (auto& row : sides_)
        row.fill({none, true});
    const auto know = [&](std::size_t a, std::size_t b, const Side& side) {
        sides_[a][b] = side;
        sides_[b][a] = side.turned();
    };
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3, middle = 3 + k;
        const Side& side = note.edges[k];
        corners_[k] = note.vertices[k];
        know(k, next, side);
        if ((pass.split >> k & 1) == 0)
            continue;
        Vertex inserted = datapath::inserted_vertex(pass, static_cast<int>(k));
        datapath::Saturations ignored;  // the recursion counts them
        inserted.generation = datapath::kept_generation(inserted.generation, setup_.registers.formats, ignored);
        split(side, inserted);
        const Edge& whole = edges_[side.edge];
        corners_[middle] = whole.middle;
        know(k, middle, {whole.pieces + (side.along ? 0 : 1), side.along});
        know(middle, next, {whole.pieces + (side.along ? 1 : 0), side.along});
    }
}

Lineage::Note Lineage::child(const std::array<std::uint8_t, 3>& corners) {
    Note note{};
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t a = corners[k], b = corners[(k + 1) % 3];
        if (sides_[a][b].edge == none) {
            const Number inner = edges_.add(true, {corners_[a], corners_[b], none, none, {1, 1}, {}});
            sides_[a][b] = {inner, true};
            sides_[b][a] = {inner, false};
        }
        note.vertices[k] = corners_[a];
        note.edges[k] = sides_[a][b];
    }
    return note;
}

void Lineage::judge(const std::vector<Edge>& edges) {
    for (const Edge& edge : edges) {
        const auto ends = [&] {
            return vertex_text(vertices_[edge.from].vertex) + "; " + vertex_text(vertices_[edge.to].vertex);
        };
        if (edge.middle != none) {
            if (!(edge.found == Sides{}))
                fault(result_.t_vertices, [&] {
                    return "T-vertex: an edge is split by one of its triangles and not by another: " + ends();
                });
        } else if (!(edge.found == edge.wanted)) {
            fault(result_.cracks, [&] {
                return fmt::format("an edge has {} and {} triangles on its sides, expected {} and {}: {}",
                                   edge.found.along, edge.found.against, edge.wanted.along, edge.wanted.against,
                                   ends());
            });
        }
    }
}

void Lineage::judge_patch() {
    judge(edges_.inside());
    edges_.forget_inside();
    vertices_.forget_inside();
}

const Vertex& Lineage::begin_of(const Side& side) const {
    const Edge& edge = edges_[side.edge];
    return vertices_[side.along ? edge.from : edge.to].vertex;
}

std::uint64_t Lineage::pieces_of(Number number) const {
    const Edge& edge = edges_[number];
    return edge.middle == none ? 1 : pieces_of(edge.pieces) + pieces_of(edge.pieces + 1);
}

/// Number of pieces where two sides of the same direction do not meet; if one side is finer, all its pieces.
std::uint64_t Lineage::open_pieces(Side a, Side b) const {
    const Edge &one = edges_[a.edge], &other = edges_[b.edge];
    if (one.middle == none && other.middle == none) {
        const bool meet = begin_of(a).displaced == begin_of(b).displaced &&
                          begin_of(a.turned()).displaced == begin_of(b.turned()).displaced;
        return meet ? 0 : 1;
    }
    if (one.middle == none || other.middle == none)
        return std::max(pieces_of(a.edge), pieces_of(b.edge));
    const auto half = [](const Side& side, const Edge& edge, bool first) {
        return Side{edge.pieces + (side.along == first ? 0 : 1), side.along};
    };
    return open_pieces(half(a, one, true), half(b, other, true)) +
           open_pieces(half(a, one, false), half(b, other, false));
}

void Lineage::compare_base_edges() {
    struct Placed {
        Number low, high;  // first vertex at the position of either end
        Side side;         // from low to high
    };
    std::vector<Number> first_there;
    DistinctTable places;
    const auto place_of = [&](Number vertex) {
        const auto position = [&](Number v) -> const datapath::Position& { return vertices_[v].vertex.position; };
        const std::uint32_t place = places.number_of(
            hash_of(position(vertex)),
            [&](std::uint32_t known) { return position(first_there[known]) == position(vertex); },
            [&](std::uint32_t known) { return hash_of(position(first_there[known])); });
        if (place == first_there.size())
            first_there.push_back(vertex);
        return place;
    };
    std::vector<Placed> placed;
    for (Number number = 0; number < ways_.size(); ++number) {
        const Number from = place_of(edges_[number].from), to = place_of(edges_[number].to);
        if (from != to)
            placed.push_back({std::min(from, to), std::max(from, to), {number, from < to}});
    }
    const auto key = [](const Placed& p) { return std::make_tuple(p.low, p.high, p.side.edge); };
    std::sort(placed.begin(), placed.end(), [&](const Placed& a, const Placed& b) { return key(a) < key(b); });
    for (auto begin = placed.begin(); begin != placed.end();) {
        std::uint64_t triangles = 0;
        bool seam = false, crease = false;
        std::optional<Side> lone;  // the last edge here with an odd number of triangles
        auto end = begin;
        for (; end != placed.end() && end->low == begin->low && end->high == begin->high; ++end) {
            const Side side = end->side;
            const Sides& wanted = edges_[side.edge].wanted;
            triangles += wanted.along + wanted.against;
            if ((wanted.along + wanted.against) % 2 == 0)
                continue;
            if (lone) {
                const auto way = [&](const Side& s) { return s.along ? ways_[s.edge] : ways_[s.edge].turned(); };
                const bool textures_agree =
                    same_texture(begin_of(*lone).texture, begin_of(side).texture) && way(*lone) == way(side);
                const auto same_normals = [](const Vertex& a, const Vertex& b) { return a.normal == b.normal; };
                // Different normals open the edge whatever the map holds.
                const bool is_crease = textures_agree || !same_normals(begin_of(*lone), begin_of(side)) ||
                                       !same_normals(begin_of(lone->turned()), begin_of(side.turned()));
                const std::uint64_t open = open_pieces(*lone, side);
                (is_crease ? crease : seam) = true;
                (is_crease ? result_.open_crease_edges : result_.open_texture_seam_edges) += open;
                result_.open_crease_edges_of_seams += is_crease && !textures_agree ? open : 0;
            }
            lone = side;
        }
        ++result_.base_edges;
        result_.border_base_edges += triangles == 1 ? 1 : 0;
        result_.non_manifold_base_edges += triangles > 2 ? 1 : 0;
        result_.texture_seams += seam ? 1 : 0;
        result_.creases += !seam && crease ? 1 : 0;
        begin = end;
    }
}

InvariantResult Lineage::finish() {
    judge_patch();
    base_ = none;
    judge(edges_.kept());
    compare_base_edges();
    return result_;
}

}  // namespace tessera
