#include "testbench/prove/exact_arithmetic/exact_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "modules/datapath/light.h"
#include "modules/datapath/midpoint.h"
#include "testbench/check/conformance/scoreboard.h"
#include "testbench/common/error.h"
#include "testbench/machine/bare_recursion.h"

namespace tessera {

namespace {

using Corners = std::array<golden::Vertex, 3>;

/// Visits the datapath's recursion together with the golden model; stores with each triangle the corners of exact
/// arithmetic.
class Walk {
  public:
    Walk(const MachineSetup& setup, const ExactModel& exact, std::uint64_t most_triangles)
        : setup_(setup),
          exact_(exact),
          most_triangles_(most_triangles),
          datapath_(setup),
          inputs_(setup),
          scoreboard_(setup.registers, inputs_),
          dequantise_(setup.registers.formats),
          base_corners_(exact.corners_of(setup)) {}

    ExactComparison run() {
        result_.edges = datapath_.walk(*this);
        return finish();
    }

    using Note = Corners;

    const Corners& begin(const datapath::Triangle& base) {
        const Corners& exact = base_corners_[next_base_++];
        for (std::size_t k = 0; k < 3; ++k)
            compare_position(base.vertices[k].displaced, exact[k]);
        return exact;
    }

    void decided(const datapath::TrianglePass& pass, const datapath::ChildIndices&, const Corners& exact) {
        scoreboard_.write(pass);
        std::copy(exact.begin(), exact.end(), vertices_.begin());
        for (std::size_t k = 0; k < 3; ++k)
            vertices_[3 + k] = compare_edge(pass, k, exact);
        for (std::size_t k = 0; k < 3; ++k)
            if ((pass.split >> k & 1u) != 0)
                compare_position(pass.new_vertex[k].displaced, vertices_[3 + k]);
    }

    Corners child(const std::array<std::uint8_t, 3>& corners) const {
        return {vertices_[corners[0]], vertices_[corners[1]], vertices_[corners[2]]};
    }

    void finished(const datapath::Triangle& triangle, bool culled) {
        if (mesh_.triangles.size() == most_triangles_)
            throw ResourceError(
                fmt::format("limits.triangles = {}: the mesh has more triangles than that", most_triangles_));
        if (!culled)
            for (const datapath::Vertex& vertex : triangle.vertices)
                datapath::light(vertex.screen_normal, setup_.registers.light, setup_.registers.formats, others_);
        mesh_.triangles.push_back(EmittedTriangle::from(triangle, culled));
    }

  private:
    /// Compares the decisions on edge k; returns the exact vertex on its midpoint.
    golden::Vertex compare_edge(const datapath::TrianglePass& pass, std::size_t k, const Corners& exact) {
        // Displace Vertex normalises it too, as the Normal Test does, and has its own counter.
        others_.degenerate_normal += pass.new_vertex[k].mean_normal == datapath::Direction{} ? 1u : 0u;
        const bool split = (pass.split >> k & 1u) != 0;
        result_.edges_split += split ? 1u : 0u;
        golden::EdgeEvaluation golden =
            golden::evaluate_edge(exact[k], exact[(k + 1) % 3], exact_.map(), exact_.parameters());
        const auto compare = [&](Decided decided, bool machine, bool is_exact) {
            result_.flips[static_cast<std::size_t>(decided)] += machine != is_exact ? 1u : 0u;
        };
        const auto says = [&](datapath::TestBits bit) { return (pass.edges[k].tests & bit) != 0; };
        compare(Decided::normal, says(datapath::normal_bit), golden.normal_test);
        compare(Decided::summed_height, says(datapath::summed_height_bit), golden.summed_height_test);
        compare(Decided::view, says(datapath::view_bit), golden.view_test);
        compare(Decided::tex_coord, says(datapath::tex_coord_bit), golden.tex_coord_test);
        compare(Decided::generation, says(datapath::generation_bit), golden.generation_test);
        compare(Decided::highlight, says(datapath::highlight_bit), golden.highlight_test);
        compare(Decided::split, split, golden.split);
        return golden.inserted.vertex;
    }

    void compare_position(const datapath::Position& machine, const golden::Vertex& exact) {
        const double distance = glm::length(setup_.model_scale.to_model(dequantise_.position(machine)) -
                                            exact_.model_scale().to_model(exact.displaced_position));
        ++result_.positions;
        squares_ += distance * distance;
        result_.position_max = std::max(result_.position_max, distance);
    }

    ExactComparison finish() {
        mesh_.sort();
        result_.triangles = mesh_.triangles.size();
        result_.conformance = scoreboard_.result();
        result_.invariants = check_invariants(mesh_, setup_);
        result_.end_to_end = compare_end_to_end(setup_, inputs_, mesh_);
        result_.saturations = datapath_.saturations;
        result_.saturations += others_;
        result_.position_rms =
            result_.positions == 0 ? 0 : std::sqrt(squares_ / static_cast<double>(result_.positions));
        result_.position_lsb = std::ldexp(1.0, -setup_.registers.formats.position.fraction) / setup_.model_scale.scale;
        return std::move(result_);
    }

    const MachineSetup& setup_;
    const ExactModel& exact_;
    std::uint64_t most_triangles_;
    BareRecursion datapath_;
    GoldenInputs inputs_;
    Scoreboard scoreboard_;
    Dequantise dequantise_;
    std::vector<Corners> base_corners_;
    std::size_t next_base_ = 0;
    std::array<golden::Vertex, 6> vertices_;  // of the last decided pass, numbered as in datapath::ChildIndices
    EmittedMesh mesh_;
    datapath::Saturations others_;  // of everything outside the bare recursion
    double squares_ = 0;
    ExactComparison result_;
};

}  // namespace

ExactComparison compare_with_exact(const MachineSetup& setup, const ExactModel& exact, std::uint64_t most_triangles) {
    return Walk(setup, exact, most_triangles).run();
}

}  // namespace tessera
