// The golden model's Highlight Test, on operands derived by hand.
#include <catch2/catch.hpp>
#include <vector>

#include "golden/golden_model.h"
#include "testbench/tests/golden/golden_cases.h"

using namespace tessera::golden;
using namespace tessera::golden::testing;

namespace {

/// A row of 16 texels: normals straight up, but (0.6, 0, 0.8) in texel 8 and (-0.28, 0, 0.96) in texel 2.
struct Row {
    Map map{16, 1, AddressMode::clamp, AddressMode::clamp, constant_codes(16, 1, 0)};
    Parameters p;

    Row() {
        std::vector<glm::dvec3> normals(16, glm::dvec3(0, 0, 1));
        normals[8] = {0.6, 0, 0.8};
        normals[2] = {-0.28, 0, 0.96};
        map.set_normals(normals);
        p.enabled = {};
        p.enabled.normal = p.enabled.summed_height = false;
        p.enabled.highlight = true;
        p.half_vector = {0.6, 0, 0.8};
        p.highlight_cosine = 0.9;
        p.highlight_normal_threshold = 0.5;
    }

    EdgeEvaluation edge(double from, double to) const {
        const auto vertex = [&](double u) {
            Vertex a;
            a.position = {u, 0, 0};
            a.normal = {0, 0, 1};
            a.tangent = {1, 0, 0};
            a.texture = {u, 0.5};
            return complete_base_vertex(a, map, p);
        };
        return evaluate_edge(vertex(from), vertex(to), map, p);
    }
};

}  // namespace

TEST_CASE("highlight: each of the three normals can lie in the highlight, or none") {
    Row row;
    EdgeEvaluation e = row.edge(8.5, 14.5);  // one end: 1 and 0.8
    CHECK(e.end_cosine == Approx(1));
    CHECK(e.midpoint_cosine == Approx(0.8));
    CHECK(e.highlight_test);
    CHECK(e.split);
    e = row.edge(14.5, 8.5);  // the other
    CHECK(e.end_cosine == Approx(1));
    CHECK(e.highlight_test);
    e = row.edge(4.5, 12.5);  // the midpoint
    CHECK(e.end_cosine == Approx(0.8));
    CHECK(e.midpoint_cosine == Approx(1));
    CHECK(e.highlight_test);
    e = row.edge(2.5, 6.5);  // -0.168 + 0.768 = 0.6: differs, but outside the highlight
    CHECK(e.normal_difference == Approx(0.28));
    row.p.highlight_normal_threshold = 0.2;
    CHECK_FALSE(row.edge(2.5, 6.5).highlight_test);
    CHECK_FALSE(row.edge(2.5, 6.5).split);
}

TEST_CASE("highlight: true only strictly above the cosine and the threshold") {
    Row row;
    row.p.half_vector = {0, 0, 1};
    const auto asks = [&](double cosine, double threshold) {
        row.p.highlight_cosine = cosine;
        row.p.highlight_normal_threshold = threshold;
        return row.edge(4.5, 12.5).highlight_test;  // 1, 1, 0.8; difference 0.6
    };
    CHECK(asks(0.999, 0.59));
    CHECK_FALSE(asks(1, 0.59));
    CHECK_FALSE(asks(0.999, 0.61));
    CHECK_FALSE(row.edge(10.5, 14.5).highlight_test);  // equal normals
}

TEST_CASE("highlight: it splits only edges within the generation limit, and is false if switched off") {
    Row row;
    row.p.generation_limit = 0;
    CHECK(row.edge(8.5, 14.5).highlight_test);
    CHECK_FALSE(row.edge(8.5, 14.5).split);
    row.p.generation_limit = 1;
    CHECK(row.edge(8.5, 14.5).split);
    row.p.enabled.highlight = false;
    CHECK_FALSE(row.edge(8.5, 14.5).highlight_test);
    CHECK_FALSE(row.edge(8.5, 14.5).split);
}
