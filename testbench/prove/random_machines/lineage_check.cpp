#include "testbench/prove/random_machines/lineage_check.h"

#include <fmt/core.h>

#include <array>
#include <cstddef>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "modules/datapath/tessellate.h"
#include "testbench/machine/bare_recursion.h"

namespace tessera {

namespace {

using datapath::TrianglePass, datapath::Vertex;

using Name = std::uint32_t;

/// An edge from its lower name to its higher.
struct EdgeKey {
    Name low, high;
    std::int64_t du, dv;
    friend bool operator==(const EdgeKey& a, const EdgeKey& b) {
        return a.low == b.low && a.high == b.high && a.du == b.du && a.dv == b.dv;
    }
};

struct EdgeHash {
    std::size_t operator()(const EdgeKey& key) const {
        std::uint64_t hash = std::uint64_t{key.low} << 32 | key.high;
        for (const std::int64_t part : {key.du, key.dv})
            hash = (hash ^ (hash >> 29) ^ static_cast<std::uint64_t>(part)) * 0xbf58476d1ce4e5b9U;
        return static_cast<std::size_t>(hash ^ (hash >> 32));
    }
};

/// Triangles on one side and on the other: along the key's direction, against it.
struct Sides {
    std::uint32_t along = 0, against = 0;
    friend bool operator==(const Sides& a, const Sides& b) {
        return a.along == b.along && a.against == b.against;
    }
    Sides turned() const { return {against, along}; }
};

struct Edge {
    Sides wanted, found;
    Name middle = 0;  // 0: nobody split it
};

/// An edge as a triangle has it.
struct DirectedEdge {
    EdgeKey key;
    bool along;
};

struct NamedTriangle {
    datapath::Triangle triangle;
    std::array<Name, 3> names;
};

class Lineage {
  public:
    explicit Lineage(const MachineSetup& setup) : setup_(setup), bare_(setup) {}

    LineageResult check();

  private:
    Vertex within_period(Vertex vertex) const;
    Name base_name(const Vertex& vertex);
    Name inserted_name(const DirectedEdge& edge, const Vertex& vertex);
    void meet(Name name, const Vertex& vertex);
    static DirectedEdge edge_between(Name a, const Vertex& at_a, Name b, const Vertex& at_b);
    void split(const NamedTriangle& parent, TrianglePass& pass);
    void finish(const NamedTriangle& triangle);
    void judge_edges();
    template <class Describe>
    void fault(std::uint64_t& count, Describe&& describe) {
        ++count;
        if (result_.first_fault.empty())
            result_.first_fault = describe();
    }
    std::string describe(Name name) const;

    const MachineSetup& setup_;
    BareRecursion bare_;
    LineageResult result_;
    using BaseKey = std::tuple<std::array<std::int32_t, 9>, std::int8_t, std::uint32_t, std::uint32_t>;
    std::map<BaseKey, Name> base_names_;
    std::vector<Vertex> vertices_{1};  // by name, as first seen, within the first period; there is no name 0
    std::unordered_map<EdgeKey, Edge, EdgeHash> edges_;
    std::vector<NamedTriangle> work_;
};

Vertex Lineage::within_period(Vertex vertex) const {
    const datapath::MapGeometry& map = setup_.registers.map;
    const int fraction = setup_.registers.formats.texture.fraction;
    const auto reduce = [&](std::uint32_t& value, std::uint32_t size, datapath::AddressMode mode) {
        if (mode == datapath::AddressMode::repeat)
            value %= size << fraction;
    };
    reduce(vertex.texture.u, map.width, map.address_u);
    reduce(vertex.texture.v, map.height, map.address_v);
    return vertex;
}

void Lineage::meet(Name name, const Vertex& vertex) {
    const Vertex seen = within_period(vertex), &known = vertices_[name];
    if (seen.position == known.position && seen.normal == known.normal && seen.tangent == known.tangent &&
        seen.texture == known.texture && seen.handedness == known.handedness &&
        seen.generation == known.generation && seen.displaced == known.displaced &&
        seen.displaced_normal == known.displaced_normal && seen.screen == known.screen)
        return;
    fault(result_.unlike_vertices,
          [&] { return "a vertex comes out differently from two sides: " + describe(name); });
}

Name Lineage::base_name(const Vertex& vertex) {
    const Vertex v = within_period(vertex);
    const BaseKey key{{v.position.x, v.position.y, v.position.z, v.normal.x, v.normal.y, v.normal.z,
                       v.tangent.x, v.tangent.y, v.tangent.z},
                      v.handedness,
                      v.texture.u,
                      v.texture.v};
    const auto [at, fresh] = base_names_.insert({key, static_cast<Name>(vertices_.size())});
    if (fresh)
        vertices_.push_back(v);
    else
        meet(at->second, vertex);
    return at->second;
}

DirectedEdge Lineage::edge_between(Name a, const Vertex& at_a, Name b, const Vertex& at_b) {
    const std::int64_t du = std::int64_t{at_b.texture.u} - at_a.texture.u;
    const std::int64_t dv = std::int64_t{at_b.texture.v} - at_a.texture.v;
    // Of two ends with one name, periods apart, the way in t decides which comes first.
    const bool along = std::make_tuple(a, -du, -dv) < std::make_tuple(b, du, dv);
    return along ? DirectedEdge{{a, b, du, dv}, true} : DirectedEdge{{b, a, -du, -dv}, false};
}

Name Lineage::inserted_name(const DirectedEdge& edge, const Vertex& vertex) {
    Edge& known = edges_[edge.key];
    if (known.middle == 0) {
        known.middle = static_cast<Name>(vertices_.size());
        vertices_.push_back(within_period(vertex));
    } else {
        meet(known.middle, vertex);
    }
    return known.middle;
}

void Lineage::split(const NamedTriangle& parent, TrianglePass& pass) {
    std::array<Vertex, 6> vertices;
    std::array<Name, 6> names{};
    datapath::Saturations ignored;           // the machine counts them
    std::array<bool, 36> on_parents_edge{};  // from one of the six to another
    const auto mark = [&](std::size_t a, std::size_t b) {
        on_parents_edge[6 * a + b] = on_parents_edge[6 * b + a] = true;
    };
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3, middle = 3 + k;
        vertices[k] = pass.triangle.vertices[k];
        names[k] = parent.names[k];
        mark(k, next);
        if ((pass.split >> k & 1) == 0)
            continue;
        vertices[middle] = datapath::inserted_vertex(pass, static_cast<int>(k));
        vertices[middle].generation =
            datapath::kept_generation(vertices[middle].generation, setup_.registers.formats, ignored);
        const Vertex &a = pass.triangle.vertices[k], &b = pass.triangle.vertices[next];
        const DirectedEdge whole = edge_between(parent.names[k], a, parent.names[next], b);
        names[middle] = inserted_name(whole, vertices[middle]);
        const Sides wanted = whole.along ? edges_[whole.key].wanted : edges_[whole.key].wanted.turned();
        for (const DirectedEdge& piece :
             {edge_between(parent.names[k], a, names[middle], vertices[middle]),
              edge_between(names[middle], vertices[middle], parent.names[next], b)})
            edges_[piece.key].wanted = piece.along ? wanted : wanted.turned();
        mark(k, middle);
        mark(middle, next);
    }
    const bool second = datapath::choose_second_diagonal(
        pass.split, setup_.registers.triangulation,
        [&](std::uint8_t index) -> const datapath::Position& { return vertices[index].displaced; });
    const datapath::ChildIndices indices = datapath::triangulate(pass.split, second);
    std::size_t number = 0;
    datapath::tessellate(
        pass, setup_.registers.triangulation, setup_.registers.formats, ignored,
        [&](const datapath::Triangle& child) {
            const auto& corners = indices.children[number++];
            work_.push_back({child, {names[corners[0]], names[corners[1]], names[corners[2]]}});
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t a = corners[k], b = corners[(k + 1) % 3];
                if (on_parents_edge[6 * a + b])
                    continue;
                const DirectedEdge inner = edge_between(names[a], vertices[a], names[b], vertices[b]);
                Sides& wanted = edges_[inner.key].wanted;  // both children that have it add their side
                ++(inner.along ? wanted.along : wanted.against);
            }
        });
}

void Lineage::finish(const NamedTriangle& done) {
    ++result_.triangles;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        const DirectedEdge edge = edge_between(done.names[k], done.triangle.vertices[k], done.names[next],
                                               done.triangle.vertices[next]);
        Sides& found = edges_[edge.key].found;
        ++(edge.along ? found.along : found.against);
    }
}

std::string Lineage::describe(Name name) const {
    const Vertex& v = vertices_[name];
    return fmt::format("vertex {}, P ({}, {}, {}), P' ({}, {}, {}), t ({}, {}), generation {}", name,
                       v.position.x, v.position.y, v.position.z, v.displaced.x, v.displaced.y, v.displaced.z,
                       v.texture.u, v.texture.v, int{v.generation});
}

void Lineage::judge_edges() {
    for (const auto& [key, edge] : edges_) {
        const auto text = [&, low = key.low, high = key.high](const char* what) {
            return fmt::format("{}: {}; {}", what, describe(low), describe(high));
        };
        if (edge.middle != 0) {
            if (!(edge.found == Sides{}))
                fault(result_.t_vertices,
                      [&] { return text("an edge split by one triangle and whole in another"); });
        } else if (!(edge.found == edge.wanted)) {
            fault(result_.cracks, [&] { return text("an edge without the triangles it should have"); });
        }
    }
}

LineageResult Lineage::check() {
    for (datapath::Triangle base : setup_.base_triangles) {
        bare_.complete_base(base);
        NamedTriangle named{base, {}};
        for (std::size_t k = 0; k < 3; ++k)
            named.names[k] = base_name(base.vertices[k]);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            const DirectedEdge edge =
                edge_between(named.names[k], base.vertices[k], named.names[next], base.vertices[next]);
            Sides& wanted = edges_[edge.key].wanted;
            ++(edge.along ? wanted.along : wanted.against);
        }
        work_.push_back(named);
    }
    TrianglePass pass;
    while (!work_.empty()) {
        const NamedTriangle next = work_.back();
        work_.pop_back();
        pass.triangle = next.triangle;
        bare_.evaluate(pass);
        result_.edges += 3;
        if (pass.split == 0)
            finish(next);
        else
            split(next, pass);
    }
    judge_edges();
    result_.vertices = vertices_.size() - 1;
    return result_;
}

}  // namespace

LineageResult check_lineage(const MachineSetup& setup) {
    return Lineage(setup).check();
}

}  // namespace tessera
