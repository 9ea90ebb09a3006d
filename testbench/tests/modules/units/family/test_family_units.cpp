#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "modules/units/family/pass_or_tessellate.h"
#include "modules/units/family/tessellation.h"
#include "testbench/common/random.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/timed_modules.h"

// Tessellation and Pass or Tessellate of a machine of families, each alone, through its sockets.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

constexpr unsigned triangles = 60;

datapath::Registers with_families() {
    datapath::Registers registers;
    registers.formats.families = registers.formats.codes = true;
    return registers;
}

Design with(const Timing& timing, unsigned lanes) {
    Design design;
    design.timing = timing;
    design.work = Work::family;
    design.test_order = TestOrder::cheap_first;
    design.edge_lanes = lanes;
    return design;
}

struct Row {
    std::string name;
    unsigned lanes = 1, buffer = 8;
    StallParameters stalls;

    Timing timing() const {
        Timing timing;
        timing.pass_or_tessellate.buffer = buffer;
        timing.stalls = stalls;
        return timing;
    }
};

const std::initializer_list<Row> designs{{"one lane", 1, 8, {}},
                                         {"three lanes", 3, 8, {}},
                                         {"nine lanes, random stalls", 9, 4, {3, 400, 9}},
                                         {"four lanes, one family, random stalls", 4, 1, {4, 300, 20}}};

/// The common part of every bench: a clock, and outputs to sinks.
struct Surroundings {
    datapath::Registers registers = with_families();
    Design design;
    CycleScheduler clock{"clock", sc_core::sc_time(10, sc_core::SC_PS)};
    UnitContext context{clock, registers, design};

    explicit Surroundings(const Row& row) : design(with(row.timing(), row.lanes)) {}

    template <class Socket, class Item>
    std::unique_ptr<Sink<Item>> sink(const char* name, unsigned k, Socket& output) {
        auto made = std::make_unique<Sink<Item>>((name + std::to_string(k)).c_str(), clock, design.timing.stalls);
        output.bind(made->in);
        return made;
    }
};

/// A value that identifies a corner or midpoint of a triangle.
std::int32_t mark(unsigned triangle, unsigned vertex) {
    return static_cast<std::int32_t>(10 * triangle + vertex);
}
bool is_base(unsigned triangle) {
    return triangle % 5 == 0;
}
unsigned split_of(unsigned triangle) {
    return is_base(triangle) ? 0 : 1 + triangle % 7;
}

/// Every fifth triangle is a base triangle with only P, N, T and t known; the others split in all seven ways.
TakenTriangle taken(unsigned number) {
    TakenTriangle item;
    item.tag = number;
    item.origin = {number, number};
    datapath::Triangle& triangle = item.triangle;
    triangle.base = number;
    triangle.split = static_cast<std::uint8_t>(split_of(number));
    for (unsigned k = 0; k < 3; ++k) {
        datapath::Vertex& vertex = triangle.vertices[k];
        vertex.position.x = mark(number, k);
        vertex.handedness = 1;
        vertex.generation = static_cast<std::uint8_t>(k);
        vertex.code = static_cast<std::uint16_t>(mark(number, k));
        triangle.midpoints[k].normal.x = mark(number, 3 + k);
        triangle.midpoints[k].displaced_normal.x = -mark(number, 3 + k);
        if (is_base(number))
            continue;
        vertex.displaced.x = vertex.screen_normal.x = vertex.displaced_normal.x = mark(number, k);
        vertex.displaced_known = vertex.screen_normal_known = true;
    }
    return item;
}

/// The parts that the vertex pipeline makes of it, in order.
std::vector<ScreenPoint> points(unsigned number) {
    std::vector<ScreenPoint> made;
    for (unsigned part = 0; part <= first_edge_part + 2; ++part) {
        const unsigned k = part % 3;
        const bool wanted = is_base(number) ? part < 3 : part >= first_edge_part && (split_of(number) >> k & 1u) != 0;
        if (!wanted)
            continue;
        ScreenPoint point;
        point.tag = {number, static_cast<std::uint8_t>(part), {number, number}};
        const std::int32_t name = mark(number, part < 3 ? k : 3 + k);
        point.p.x = point.displaced.x = point.n.x = point.displaced_n.x = name;
        point.code = static_cast<std::uint16_t>(name);
        made.push_back(point);
    }
    return made;
}

using Ends = std::pair<std::int32_t, std::int32_t>;
Ends ends(std::int32_t i, std::int32_t j) {
    return {std::min(i, j), std::max(i, j)};
}

/// Edges of a family's children, by marks, that are not whole edges of the triangle; for a base triangle all.
std::set<Ends> new_edges(unsigned number, bool second_diagonal) {
    std::set<Ends> edges;
    const datapath::ChildIndices children = datapath::triangulate(split_of(number), second_diagonal);
    for (unsigned c = 0; c < static_cast<unsigned>(children.count); ++c) {
        for (unsigned k = 0; k < 3; ++k) {
            const unsigned i = children.children[c][k], j = children.children[c][(k + 1) % 3];
            if (is_base(number) || i > 2 || j > 2)
                edges.insert(ends(mark(number, i), mark(number, j)));
        }
    }
    return edges;
}

struct TessellationBench : Surroundings {
    FamilyTessellation unit;
    Driver<TakenTriangle> from_get_triangle;
    Driver<ScreenPoint> from_transform;
    std::vector<std::unique_ptr<Sink<TestOperands>>> lanes;
    std::unique_ptr<Sink<Family>> families;

    explicit TessellationBench(const Row& row)
        : Surroundings(row),
          unit("tessellation", context),
          from_get_triangle("from_get_triangle", clock, row.stalls),
          from_transform("from_transform", clock, row.stalls) {
        clock.attach(unit);
        from_get_triangle.out.bind(unit.from_get_triangle);
        from_transform.out.bind(unit.from_transform);
        for (unsigned k = 0; k < row.lanes; ++k)
            lanes.push_back(sink<StreamOutput<TestOperands>, TestOperands>("lane_", k, unit.to_tessellation_tests[k]));
        families = sink<StreamOutput<Family>, Family>("families_", 0, unit.to_pass_or_tessellate);
        for (unsigned number = 0; number < triangles; ++number) {
            from_get_triangle.items.push_back(taken(number));
            for (const ScreenPoint& point : points(number))
                from_transform.items.push_back(point);
        }
    }
};

void check_tessellation(const Row& row) {
    TessellationBench bench(row);
    sc_core::sc_start();
    const std::vector<Family>& families = bench.families->items;
    REQUIRE(families.size() == triangles);
    std::vector<std::set<Ends>> left(triangles);
    for (unsigned number = 0; number < triangles; ++number) {
        CAPTURE(number);
        const Family& family = families[number];
        CHECK(family.tag == number);
        CHECK(family.untested == is_base(number));
        CHECK(family.triangle.split == split_of(number));
        for (unsigned k = 0; k < 6; ++k) {
            if (k >= 3 && (split_of(number) >> (k - 3) & 1u) == 0)
                continue;
            const datapath::Vertex& vertex = family.vertices[k];
            CAPTURE(k);
            CHECK(vertex.position.x == mark(number, k));
            CHECK(vertex.displaced.x == mark(number, k));
            CHECK(vertex.screen_normal.x == mark(number, k));
            CHECK(vertex.displaced_normal.x == (k < 3 ? mark(number, k) : -mark(number, k)));
            CHECK(vertex.displaced_known);
            CHECK(vertex.screen_normal_known);
            if (k >= 3) {
                CHECK(vertex.normal.x == mark(number, k));
                CHECK(vertex.generation == std::max(k - 3, (k - 2) % 3) + 1);
            }
        }
        left[number] = new_edges(number, family.second_diagonal);
    }
    std::size_t sent = 0;
    for (unsigned lane = 0; lane < row.lanes; ++lane) {
        for (const TestOperands& edge : bench.lanes[lane]->items) {
            CAPTURE(lane, edge.tag.triangle, edge.tag.part);
            CHECK((edge.tag.part - first_edge_part) % row.lanes == lane);
            CHECK(edge.new_vertices == 0);
            CHECK(left[edge.tag.triangle].erase(ends(edge.ends[0].code, edge.ends[1].code)) == 1);
            ++sent;
        }
    }
    CHECK(sent == bench.unit.parts_sent());
    CHECK(std::all_of(left.begin(), left.end(), [](const auto& edges) { return edges.empty(); }));
    CHECK(bench.unit.describe_contents().empty());
    CHECK(bench.unit.idle());
}
const CaseTable tessellation("families, Tessellation: each family and each of its new edges once, ", designs,
                             check_tessellation);

/// Whether the tests split an edge.
bool splits(const Ends& edge) {
    return (edge.first + edge.second) % 3 == 0;
}
datapath::EdgeTests found(const Ends& edge) {
    datapath::EdgeTests found;
    found.normal.x = edge.first + edge.second;
    found.evaluated = datapath::all_tests;
    found.tests = static_cast<std::uint8_t>(datapath::gating_tests | (splits(edge) ? datapath::normal_bit : 0));
    return found;
}

/// A child as expected at the output.
struct Child {
    std::array<std::int32_t, 3> corners{};
    unsigned split = 0;
    std::array<std::int32_t, 3> midpoint_normals{};
};
std::vector<Child> children_of(unsigned number, bool second_diagonal) {
    std::vector<Child> children;
    const std::set<Ends> edges = new_edges(number, second_diagonal);
    const datapath::ChildIndices indices = datapath::triangulate(split_of(number), second_diagonal);
    for (unsigned c = 0; c < static_cast<unsigned>(indices.count); ++c) {
        Child child;
        for (unsigned k = 0; k < 3; ++k)
            child.corners[k] = mark(number, indices.children[c][k]);
        for (unsigned k = 0; k < 3; ++k) {
            const Ends edge = ends(child.corners[k], child.corners[(k + 1) % 3]);
            if (edges.count(edge) == 0 || !splits(edge))
                continue;
            child.split |= 1u << k;
            child.midpoint_normals[k] = edge.first + edge.second;
        }
        children.push_back(child);
    }
    return children;
}

Family family_of(unsigned number) {
    Family family;
    family.tag = number;
    family.origin = {number, number};
    family.triangle.base = number;
    family.triangle.split = static_cast<std::uint8_t>(split_of(number));
    family.triangle.split_by = datapath::summed_height_bit;
    family.second_diagonal = number % 2 != 0;
    family.untested = is_base(number);
    for (unsigned k = 0; k < 6; ++k) {
        family.vertices[k].screen_normal.x = mark(number, k);
        family.vertices[k].displaced_known = family.vertices[k].screen_normal_known = true;
    }
    return family;
}

struct PassOrTessellateBench : Surroundings {
    FamilyPassOrTessellate unit;
    Driver<Family> from_tessellation;
    std::vector<std::unique_ptr<Driver<TestedEdge>>> lanes;
    std::unique_ptr<Sink<TriangleToLight>> lit;
    std::unique_ptr<Sink<datapath::Triangle>> queued;

    explicit PassOrTessellateBench(const Row& row)
        : Surroundings(row),
          unit("pass_or_tessellate", context),
          from_tessellation("from_tessellation", clock, row.stalls) {
        clock.attach(unit);
        from_tessellation.out.bind(unit.from_tessellation);
        for (unsigned k = 0; k < row.lanes; ++k) {
            lanes.push_back(
                std::make_unique<Driver<TestedEdge>>(("lane_" + std::to_string(k)).c_str(), clock, row.stalls));
            lanes[k]->out.bind(unit.from_tessellation_tests[k]);
        }
        lit = sink<StreamOutput<TriangleToLight>, TriangleToLight>("lit_", 0, unit.to_lighting);
        queued = sink<StreamOutput<datapath::Triangle>, datapath::Triangle>("queued_", 0, unit.to_triangle_queue);
        for (unsigned number = 0; number < triangles; ++number)
            add(number);
    }

    /// Adds a family, and sends its edges to their lanes in a random order.
    void add(unsigned number) {
        const Family family = family_of(number);
        from_tessellation.items.push_back(family);
        const datapath::FamilyEdges edges = datapath::family_edges(
            datapath::triangulate(split_of(number), family.second_diagonal), datapath::open_edges(family.untested, 0));
        std::vector<unsigned> order(edges.count);
        for (unsigned k = 0; k < edges.count; ++k)
            order[k] = k;
        for (std::uint32_t k = edges.count; k > 1; --k)
            std::swap(order[k - 1], order[random.natural(0, k - 1)]);
        for (const unsigned k : order) {
            TestedEdge edge;
            edge.tag = {number, static_cast<std::uint8_t>(first_edge_part + k), family.origin};
            edge.found = found(ends(mark(number, edges.edges[k].i), mark(number, edges.edges[k].j)));
            lanes[k % lanes.size()]->items.push_back(edge);
        }
    }

    Random random{17};
};

void check_pass_or_tessellate(const Row& row) {
    PassOrTessellateBench bench(row);
    sc_core::sc_start();
    std::size_t lit = 0, queued = 0, edges = 0, split = 0;
    for (unsigned number = 0; number < triangles; ++number) {
        edges += new_edges(number, family_of(number).second_diagonal).size();
        for (const Child& child : children_of(number, family_of(number).second_diagonal)) {
            CAPTURE(number, child.corners, child.split);
            split += static_cast<unsigned>(__builtin_popcount(child.split));
            if (child.split == 0) {
                REQUIRE(lit < bench.lit->items.size());
                const TriangleToLight& item = bench.lit->items[lit++];
                for (unsigned k = 0; k < 3; ++k)
                    CHECK(item.corners[k].screen_n.x == child.corners[k]);
                continue;
            }
            REQUIRE(queued < bench.queued->items.size());
            const datapath::Triangle& item = bench.queued->items[queued++];
            CHECK(item.base == number);
            CHECK(item.split == child.split);
            CHECK(item.split_by == datapath::normal_bit);
            CHECK_FALSE(item.finished);
            for (unsigned k = 0; k < 3; ++k) {
                CHECK(item.vertices[k].screen_normal.x == child.corners[k]);
                CHECK(item.midpoints[k].normal.x == child.midpoint_normals[k]);
            }
        }
    }
    CHECK(bench.lit->items.size() == lit);
    CHECK(bench.queued->items.size() == queued);
    CHECK(queued > 20);
    const DecidingUnit::Counts& counts = bench.unit.counts();
    CHECK(counts.finished == lit);
    CHECK(counts.passes == lit + queued);
    CHECK(counts.edges_tested == edges);
    CHECK(counts.edges_split == split);
    CHECK(bench.unit.most_incomplete() <= row.buffer);
    CHECK(bench.unit.describe_contents().empty());
    CHECK(bench.unit.idle());
}
const CaseTable pass_or_tessellate("families, Pass or Tessellate: each child once, decided by its edges, ", designs,
                                   check_pass_or_tessellate);

}  // namespace

// Parts that no correct machine sends, in functional mode; family 2 has new edges and two inserted vertices.
TEST_CASE("families, Tessellation: a part of an absent triangle, or one that comes twice, is an error") {
    TessellationBench bench(*designs.begin());
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    const auto bring = [&](ScreenPoint point) {
        sc_core::sc_time delay;
        bench.from_transform.out.transport(point, delay);
    };
    const ScreenPoint point = points(2).front();
    CHECK_THAT(error_of([&] { bring(point); }), Contains("for a triangle that has not arrived"));
    TakenTriangle triangle = taken(2);
    sc_core::sc_time delay;
    bench.from_get_triangle.out.transport(triangle, delay);
    bring(point);
    CHECK_THAT(error_of([&] { bring(point); }), Contains("a part arrived twice"));
    CHECK(bench.families->items.empty());
}

TEST_CASE("families, Pass or Tessellate: an edge of an absent family, or one that comes twice, is an error") {
    PassOrTessellateBench bench(*designs.begin());
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    TestedEdge edge;
    edge.tag = {100, first_edge_part, {}};
    const auto bring = [&] {
        sc_core::sc_time delay;
        bench.lanes[0]->out.transport(edge, delay);
    };
    CHECK_THAT(error_of(bring), Contains("for a family that has not arrived"));
    edge.tag.triangle = 2;
    Family family = family_of(2);
    sc_core::sc_time delay;
    bench.from_tessellation.out.transport(family, delay);
    bring();
    CHECK_THAT(error_of(bring), Contains("an edge of a family arrived twice"));
    CHECK_FALSE(bench.unit.joined());
}
