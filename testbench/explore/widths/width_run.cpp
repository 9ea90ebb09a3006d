#include "testbench/explore/widths/width_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "modules/datapath/cull.h"
#include "modules/datapath/edge_tests.h"
#include "modules/datapath/light.h"
#include "modules/datapath/midpoint.h"
#include "modules/datapath/tessellate.h"
#include "modules/datapath/transform.h"
#include "testbench/check/conformance/scoreboard.h"
#include "testbench/common/error.h"
#include "testbench/machine/bare_recursion.h"

namespace tessera {

namespace {

using Corners = std::array<golden::Vertex, 3>;

/// A triangle of the machine, and where exact arithmetic would have put its corners.
struct Pair {
    datapath::Triangle machine;
    Corners exact;
};

class Walk {
  public:
    Walk(const MachineSetup& setup, const ExactModel& exact, std::uint64_t most_triangles)
        : setup_(setup),
          exact_(exact),
          most_triangles_(most_triangles),
          datapath_(setup),
          inputs_(setup),
          scoreboard_(setup.registers, inputs_),
          borders_(setup.registers.formats),
          dequantise_(setup.registers.formats) {}

    WidthRun run() {
        const std::vector<Corners> corners = exact_.corners_of(setup_);
        for (std::size_t k = 0; k < corners.size(); ++k) {
            work_.push_back({setup_.base_triangles[k], corners[k]});
            datapath_.complete_base(work_.back().machine);
            for (std::size_t c = 0; c < 3; ++c)
                compare_position(work_.back().machine.vertices[c].displaced, corners[k][c]);
            pass_.new_vertices = 7;
            while (!work_.empty()) {
                step();
                pass_.new_vertices = 0;
            }
        }
        return finish();
    }

  private:
    /// One pass of one triangle.
    void step() {
        const Pair pair = work_.back();
        work_.pop_back();
        pass_.triangle = pair.machine;
        pass_.split = 0;
        Corners inserted;
        for (int k = 0; k < 3; ++k)
            inserted[static_cast<std::size_t>(k)] = decide(k, pair.exact);
        scoreboard_.write(pass_);
        borders_.write(pass_);
        result_.edges += 3;
        if (pass_.split == 0)
            emit(pass_.triangle);
        else
            tessellate_both(pair.exact, inserted);
    }

    /// Both decide edge k; returns the exact vertex on its midpoint.
    golden::Vertex decide(int k, const Corners& exact) {
        const auto edge = static_cast<std::size_t>(k);
        const datapath::Vertex &i = pass_.edge_begin(k), &j = pass_.edge_end(k);
        datapath_.evaluate_edge(pass_, k);
        datapath::EdgeTests& tested = pass_.edges[edge];
        const datapath::TestParameters& tests = setup_.registers.tests;
        if (tests.highlight_test &&
            datapath::highlight_test(i.displaced_normal, j.displaced_normal, tested.displaced_normal, tests))
            tested.tests |= datapath::highlight_bit;
        datapath::Direction& mean = pass_.new_vertex[edge].mean_normal;
        mean = datapath::midpoint(i.normal, j.normal);
        tested.texture = pass_.new_vertex[edge].texture;  // calculated in both branches
        // Displace Vertex normalises it as the Normal Test does, and counts for itself.
        others_.degenerate_normal += mean == datapath::Direction{} ? 1u : 0u;

        const bool split = datapath::split_decision(tested.tests);
        pass_.split = static_cast<std::uint8_t>(pass_.split | (split ? 1u << k : 0u));
        result_.edges_split += split ? 1u : 0u;

        golden::EdgeEvaluation golden =
            golden::evaluate_edge(exact[edge], exact[(edge + 1) % 3], exact_.map(), exact_.parameters());
        const auto compare = [&](Decided decided, bool machine, bool is_exact) {
            result_.flips[static_cast<std::size_t>(decided)] += machine != is_exact ? 1u : 0u;
        };
        const auto says = [&](datapath::TestBits bit) { return (tested.tests & bit) != 0; };
        compare(Decided::normal, says(datapath::normal_bit), golden.normal_test);
        compare(Decided::summed_height, says(datapath::summed_height_bit), golden.summed_height_test);
        compare(Decided::view, says(datapath::view_bit), golden.view_test);
        compare(Decided::tex_coord, says(datapath::tex_coord_bit), golden.tex_coord_test);
        compare(Decided::generation, says(datapath::generation_bit), golden.generation_test);
        compare(Decided::highlight, says(datapath::highlight_bit), golden.highlight_test);
        compare(Decided::split, split, golden.split);
        return golden.inserted.vertex;
    }

    void tessellate_both(const Corners& exact, const Corners& inserted) {
        const std::array<const golden::Vertex*, 6> vertices = {&exact[0],    &exact[1],    &exact[2],
                                                               &inserted[0], &inserted[1], &inserted[2]};
        for (unsigned k = 0; k < 3; ++k)
            if ((pass_.split >> k & 1u) != 0)
                compare_position(pass_.new_vertex[k].displaced, inserted[k]);
        const bool second =
            datapath::choose_second_diagonal(pass_.split, setup_.registers.triangulation,
                                             [&](std::uint8_t index) -> const datapath::Position& {
                                                 return index < 3 ? pass_.triangle.vertices[index].displaced
                                                                  : pass_.new_vertex[index - 3u].displaced;
                                             });
        const datapath::ChildIndices indices = datapath::triangulate(pass_.split, second);
        if (indices.count == 3)
            compare_diagonal(vertices, indices);
        std::size_t child = 0;
        datapath::tessellate(
            pass_, setup_.registers.triangulation, setup_.registers.formats, others_,
            [&](const datapath::Triangle& triangle) {
                const auto& c = indices.children[child++];
                work_.push_back({triangle, {*vertices[c[0]], *vertices[c[1]], *vertices[c[2]]}});
            });
    }

    void compare_diagonal(const std::array<const golden::Vertex*, 6>& exact,
                          const datapath::ChildIndices& machine) {
        std::array<golden::Vertex, 6> corners;
        std::transform(exact.begin(), exact.end(), corners.begin(),
                       [](const golden::Vertex* corner) { return *corner; });
        const golden::Subdivision cut =
            golden::subdivide({(pass_.split & 1) != 0, (pass_.split & 2) != 0, (pass_.split & 4) != 0},
                              corners, exact_.parameters().diagonal);
        // Both list the quadrilateral's halves in the same order.
        const auto& a = machine.children[1];
        const auto& b = cut.children[1];
        ++result_.quadrilaterals;
        result_.diagonal_flips += std::equal(a.begin(), a.end(), b.begin(), b.end()) ? 0u : 1u;
    }

    void emit(datapath::Triangle& triangle) {
        if (mesh_.triangles.size() == most_triangles_)
            throw ResourceError(
                fmt::format("limits.triangles = {}: the mesh has more triangles than that", most_triangles_));
        const datapath::Registers& r = setup_.registers;
        const auto& v = triangle.vertices;
        const bool culled =
            r.back_face_culling && datapath::faces_away(v[0].screen, v[1].screen, v[2].screen);
        for (const datapath::Vertex& vertex : v) {
            const datapath::Direction normal =
                datapath::transform_normal(vertex.displaced_normal, r.transform, r.formats, others_);
            if (!culled)
                datapath::light(normal, r.light, r.formats, others_);
        }
        mesh_.triangles.push_back(EmittedTriangle::from(triangle, culled));
    }

    void compare_position(const datapath::Position& machine, const golden::Vertex& exact) {
        const double distance = glm::length(setup_.model_scale.to_model(dequantise_.position(machine)) -
                                            exact_.model_scale().to_model(exact.displaced_position));
        ++result_.positions;
        squares_ += distance * distance;
        result_.position_max = std::max(result_.position_max, distance);
    }

    WidthRun finish() {
        mesh_.sort();
        result_.triangles = mesh_.triangles.size();
        result_.conformance = scoreboard_.result();
        result_.invariants = check_invariants(mesh_, setup_.base_triangles, setup_.registers);
        result_.texel_borders = borders_.count();
        result_.end_to_end = compare_end_to_end(setup_, inputs_, mesh_);
        result_.saturations = datapath_.saturations();
        result_.saturations += others_;
        result_.position_rms =
            result_.positions == 0 ? 0 : std::sqrt(squares_ / static_cast<double>(result_.positions));
        result_.position_lsb =
            std::ldexp(1.0, -setup_.registers.formats.position.fraction) / setup_.model_scale.scale;
        return std::move(result_);
    }

    const MachineSetup& setup_;
    const ExactModel& exact_;
    std::uint64_t most_triangles_;
    BareRecursion datapath_;
    GoldenInputs inputs_;
    Scoreboard scoreboard_;
    TexelBorders borders_;
    Dequantise dequantise_;
    std::vector<Pair> work_;
    datapath::TrianglePass pass_;
    EmittedMesh mesh_;
    datapath::Saturations others_;  // of what is not the bare recursion's
    double squares_ = 0;
    WidthRun result_;
};

}  // namespace

WidthRun run_widths(const MachineSetup& setup, const ExactModel& exact, std::uint64_t most_triangles) {
    return Walk(setup, exact, most_triangles).run();
}

}  // namespace tessera
