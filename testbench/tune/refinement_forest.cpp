#include "testbench/tune/refinement_forest.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "modules/datapath/triangle_pass.h"
#include "modules/datapath/triangulate.h"
#include "testbench/common/distinct_table.h"

namespace tessera {

namespace {

using datapath::Vertex;

bool same(const Vertex& a, const Vertex& b) {
    return a.position == b.position && a.normal == b.normal && a.tangent == b.tangent && a.texture == b.texture &&
           a.handedness == b.handedness;
}

std::uint64_t hash_of(const Vertex& v) {
    return mix_hash(point_hash(v.position), std::uint64_t{v.texture.u} << 32 | v.texture.v);
}

/// Index into Node::children of a split with this mask and diagonal.
std::size_t way(unsigned split, bool second) {
    constexpr std::array<std::size_t, 8> by_split{0, 0, 1, 4, 2, 6, 8, 3};
    const bool two = split == 3 || split == 5 || split == 6;
    return by_split[split] + (two && second ? 1 : 0);
}

std::uint32_t largest_difference(const datapath::Direction& a, const datapath::Direction& b) {
    return static_cast<std::uint32_t>(
        std::max({datapath::absolute_difference(a.x, b.x), datapath::absolute_difference(a.y, b.y),
                  datapath::absolute_difference(a.z, b.z)}));
}

std::uint32_t pixels(const datapath::ScreenPosition& i, const datapath::ScreenPosition& j) {
    if (i.in_front && j.in_front)
        return static_cast<std::uint32_t>(
            std::min<std::uint64_t>(datapath::absolute_difference(i.x, j.x) + datapath::absolute_difference(i.y, j.y),
                                    std::numeric_limits<std::uint32_t>::max()));
    return i.in_front || j.in_front ? std::numeric_limits<std::uint32_t>::max() : 0;
}

}  // namespace

RefinementForest::RefinementForest(const MachineSetup& setup, const TexelError* errors)
    : datapath_(setup),
      setup_(setup),
      height_test_(functions_of(setup.registers.formats.height_test)),
      errors_(errors) {
    DistinctTable known;
    const auto number_of = [&](const Vertex& vertex) {
        const std::uint32_t number = known.number_of(
            hash_of(vertex), [&](std::uint32_t k) { return same(vertices_[k], vertex); },
            [&](std::uint32_t k) { return hash_of(vertices_[k]); });
        if (number == vertices_.size())
            vertices_.push_back(vertex);
        return number;
    };
    std::vector<std::array<std::uint32_t, 3>> corners;
    for (datapath::Triangle triangle : setup.base_triangles) {
        datapath_.complete_base(triangle);
        corners.push_back(
            {number_of(triangle.vertices[0]), number_of(triangle.vertices[1]), number_of(triangle.vertices[2])});
    }
    roots_ = corners.size();
    for (std::size_t k = 0; k < roots_; ++k)
        make_node(corners[k], setup.base_triangles[k].base);
}

RefinementForest::Edge RefinementForest::make_edge(const Vertex& i, const Vertex& j) {
    datapath::TrianglePass pass;
    pass.triangle.vertices = {i, j, i};
    datapath_.evaluate_edge(pass, 0);
    const datapath::Registers& r = setup_.registers;
    Edge edge;
    const datapath::EdgeTests& tests = pass.edges[0];
    edge.normal = std::max(largest_difference(tests.displaced_normal, i.displaced_normal),
                           largest_difference(tests.displaced_normal, j.displaced_normal));
    const datapath::TexCoord& middle = pass.new_vertex[0].texture;
    const datapath::HeightDecision heights = datapath_.test_heights({i.texture, j.texture, middle});
    edge.height = heights.values.at(static_cast<std::size_t>(height_test_.compared));
    edge.weight = static_cast<std::uint32_t>(height_test_.weight(heights));
    if (heights.asks != (edge.height > height_test_.limit(edge.weight, r.tests)))
        throw std::logic_error(
            fmt::format("height test {}: decide() {} a split of an edge whose value {} = {} has the limit() {}",
                        height_test_.name, heights.asks ? "asks for" : "does not ask for",
                        height_test_.values.at(static_cast<std::size_t>(height_test_.compared)).name, edge.height,
                        height_test_.limit(edge.weight, r.tests)));
    edge.view = pixels(i.screen, j.screen);
    edge.open = datapath::tex_coord_test(i.texture, j.texture, middle, r.formats);
    edge.generation = datapath::inserted_generation(i.generation, j.generation);
    edge.middle = static_cast<std::uint32_t>(vertices_.size());
    vertices_.push_back(datapath::inserted_vertex(pass, 0));
    return edge;
}

const RefinementForest::Edge& RefinementForest::edge_between(std::uint32_t i, std::uint32_t j) {
    const std::uint64_t key = (std::uint64_t{std::min(i, j)} << 32) | std::max(i, j);
    const auto [at, is_new] = edge_of_.emplace(key, static_cast<std::uint32_t>(edges_.size()));
    if (is_new) {
        const Vertex from = vertices_[i], to = vertices_[j];  // make_edge() moves them
        edges_.push_back(make_edge(from, to));
    }
    return edges_[at->second];
}

std::uint32_t RefinementForest::make_node(const std::array<std::uint32_t, 3>& vertices, std::uint32_t base) {
    Node node{};
    node.vertices = vertices;
    node.base = base;
    for (std::size_t k = 0; k < 3; ++k)
        node.edges[k] = edge_between(vertices[k], vertices[(k + 1) % 3]);
    const auto position = [&](std::uint8_t index) -> const datapath::Position& {
        return vertices_[index < 3 ? node.vertices[index] : node.edges[index - 3u].middle].displaced;
    };
    for (unsigned whole = 0; whole < 3; ++whole)
        if (datapath::choose_second_diagonal(7u & ~(1u << whole), datapath::Triangulation::shorter, position))
            node.shorter_is_second = static_cast<std::uint8_t>(node.shorter_is_second | 1u << whole);
    nodes_.push_back(node);
    return static_cast<std::uint32_t>(nodes_.size() - 1);
}

std::uint32_t RefinementForest::children_of(std::uint32_t number, unsigned split, bool second) {
    const std::size_t which = way(split, second);
    if (nodes_[number].children[which] != 0)
        return nodes_[number].children[which];
    const Node parent = nodes_[number];
    const datapath::ChildIndices indices = datapath::triangulate(split, second);
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    const auto vertex = [&](std::uint8_t index) {
        return index < 3 ? parent.vertices[index] : parent.edges[index - 3u].middle;
    };
    for (int k = 0; k < indices.count; ++k) {
        const auto& corners = indices.children[static_cast<std::size_t>(k)];
        make_node({vertex(corners[0]), vertex(corners[1]), vertex(corners[2])}, parent.base);
    }
    nodes_[number].children[which] = first;
    return first;
}

bool RefinementForest::splits(const Edge& edge, const datapath::TestParameters& tests) const {
    if ((tests.tex_coord_test && !edge.open) || (tests.generation_test && edge.generation > tests.generation_limit) ||
        (tests.view_test && edge.view <= tests.view_threshold))
        return false;
    if (tests.normal_test && edge.normal > tests.normal_threshold)
        return true;
    return tests.summed_height_test && edge.height > height_test_.limit(edge.weight, tests);
}

template <class Leaf>
Outcome RefinementForest::walk(const datapath::TestParameters& tests, datapath::Triangulation triangulation,
                               std::uint64_t limit, Leaf&& leaf) {
    Outcome outcome;
    for (std::size_t root = 0; root < roots_; ++root) {
        work_.assign(1, static_cast<std::uint32_t>(root));
        while (!work_.empty()) {
            const std::uint32_t number = work_.back();
            work_.pop_back();
            const Node& node = nodes_[number];
            unsigned split = 0;
            for (unsigned k = 0; k < 3; ++k)
                if (splits(node.edges[k], tests))
                    split |= 1u << k;
            if (split == 0) {
                if (++outcome.triangles > limit) {
                    outcome.complete = false;
                    return outcome;
                }
                leaf(nodes_[number]);
                continue;
            }
            const unsigned whole = split == 6 ? 0 : (split == 5 ? 1 : 2);
            const bool second = triangulation == datapath::Triangulation::shorter
                                    ? (node.shorter_is_second >> whole & 1) != 0
                                    : triangulation == datapath::Triangulation::second;
            const int count = datapath::triangulate(split, second).count;
            const std::uint32_t first = children_of(number, split, second);
            for (int k = 0; k < count; ++k)
                work_.push_back(first + static_cast<std::uint32_t>(k));
        }
    }
    return outcome;
}

Outcome RefinementForest::count(const datapath::TestParameters& tests, datapath::Triangulation triangulation,
                                std::uint64_t limit) {
    return walk(tests, triangulation, limit, [](Node&) {});
}

Outcome RefinementForest::measure(const datapath::TestParameters& tests, datapath::Triangulation triangulation,
                                  std::uint64_t limit) {
    TexelError::Sum sum;
    std::uint8_t inserted = 1;  // the generation of the vertices inserted if its edges split
    Outcome outcome = walk(tests, triangulation, limit, [&](Node& node) {
        if (!node.measured) {
            node.error = errors_->of(
                {&vertices_[node.vertices[0]], &vertices_[node.vertices[1]], &vertices_[node.vertices[2]]}, node.base);
            node.measured = true;
        }
        sum.add(node.error);
        for (const Edge& edge : node.edges)
            inserted = std::max(inserted, edge.generation);
    });
    outcome.generation = static_cast<std::uint8_t>(inserted - 1);
    outcome.rms = sum.weight > 0 ? std::sqrt(sum.squares / sum.weight) : 0;
    outcome.max = sum.max;
    return outcome;
}

std::vector<std::array<Vertex, 3>> RefinementForest::mesh(const datapath::TestParameters& tests,
                                                          datapath::Triangulation triangulation) {
    std::vector<std::array<Vertex, 3>> result;
    walk(tests, triangulation, std::numeric_limits<std::uint64_t>::max(), [&](Node& node) {
        result.push_back({vertices_[node.vertices[0]], vertices_[node.vertices[1]], vertices_[node.vertices[2]]});
    });
    return result;
}

}  // namespace tessera
