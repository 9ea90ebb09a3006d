#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <systemc>
#include <tlm>

#include "golden/golden_model.h"
#include "modules/datapath/triangle_pass.h"
#include "testbench/check/conformance/conformance_result.h"
#include "testbench/check/conformance/error_bounds.h"
#include "testbench/check/conformance/golden_inputs.h"

namespace tessera {

/// Checks every decided triangle (PassOrTessellate::decided): the golden model evaluates the same edges from the same
/// ends, dequantised.
///
/// Values: P_ij, (N_i+N_j)/2, t_ij, N_ij, T_ij, N'_ij, P'_ij, P's_ij, w_ij; P', N', P's, w of a base triangle's
/// vertices. Each must lie within its bound (error_bounds.h) of golden's, which is first saturated to the format like
/// the hardware's. N's is not compared: the golden model has none.
///
/// Tests: SHT, VT, TCT, GT and the diagonal are exact on both sides and must agree. NT may differ if golden's
/// largest difference lies within N'_ij's bound of the threshold, in_front if golden's w lies within its bound of the
/// near plane, and the split decision if it follows from such an NT or HT.
/// HT, compared if the design has it, may differ as NT does (with its own threshold), and if golden's N'_ij . H
/// lies within its bound of the cosine and neither end is in the highlight; the ends' own products are exact.
///
/// Only values that the machine has evaluated are compared: N_ij, T_ij, N'_ij, NT and HT if the Normal Test was
/// evaluated; SHT likewise; of a final edge only that golden does not split it.
///
/// With families, an edge's tests and its midpoint are reported separately (Told), and (N_i+N_j)/2, which no unit
/// sends, is not compared.
///
/// Any other difference is a mismatch: counted, the first kept with all operands. The diagonal is calculated by the
/// datapath's function (triangulate.h), which Tessellation applies later, from the pass's P'.
///
/// Cost: no allocation per edge; about 0.55 microseconds per edge, golden included.
class Scoreboard : public tlm::tlm_analysis_if<datapath::TrianglePass> {
  public:
    /// `inputs` must outlive the scoreboard.
    Scoreboard(const datapath::Registers& registers, const GoldenInputs& inputs);

    void write(const datapath::TrianglePass& pass) override;

    ConformanceResult result() const;
    std::uint64_t mismatches() const { return mismatches_; }

  private:
    enum Value {
        inserted_position,
        inserted_mean_normal,
        inserted_texture,
        inserted_normal,
        inserted_tangent,
        inserted_displaced_normal,
        inserted_displaced,
        inserted_screen,
        inserted_w,
        base_displaced,
        base_displaced_normal,
        base_screen,
        base_w,
        inserted_distance,
        base_distance,
        value_count
    };
    enum Decision {
        normal_decision,
        summed_height_decision,
        view_decision,
        tex_coord_decision,
        generation_decision,
        highlight_decision,
        split_decision,
        cut_decision,
        diagonal_decision,
        in_front_decision,
        decision_count
    };
    struct ValueStatistics {
        std::uint64_t count = 0, outside = 0;
        double max_error = 0, squares = 0, max_bound = 0, worst_ratio = 0;
    };
    struct DecisionStatistics {
        std::uint64_t compared = 0, agreed = 0, allowed_flips = 0, mismatches = 0;
    };
    using Interval = ErrorBounds::Interval;

    /// The current comparison, for the text of a mismatch.
    struct Context {
        const datapath::TrianglePass* pass = nullptr;
        int edge = -1;    // or
        int vertex = -1;  // of a base triangle
        const golden::EdgeEvaluation* evaluation = nullptr;
        const golden::Vertex* completed = nullptr;
    };

    void compare_base_vertex(const datapath::TrianglePass& pass, int k, const golden::Vertex& given);
    void compare_edge(const datapath::TrianglePass& pass, int k, const golden::Vertex& i, const golden::Vertex& j);
    /// Golden's value from a map, and the bound on the hardware's error.
    template <class Value>
    struct MapValue {
        Value value{0};
        Value error{0};
    };
    MapValue<glm::dvec3> map_normal_at(const glm::dvec2& t) const;
    /// Error bound of P'. `t`: where the displacement map is read.
    glm::dvec3 displaced_bound(const glm::dvec3& p, const glm::dvec2& t, const glm::dvec3& n, const glm::dvec3& n_error,
                               const glm::dvec3& displaced) const;
    /// Whether HT may differ. `difference_leeway`: error bound of golden's normal_difference.
    bool highlight_may_flip(const golden::EdgeEvaluation& golden, const glm::dvec3& normal_bound,
                            double difference_leeway) const;
    bool cuts_one_edge() const { return inputs_.parameters.diagonal == golden::Diagonal::greatest_rank; }
    void compare_cut(const datapath::TrianglePass& pass, const std::array<golden::Vertex, 3>& given);
    void compare_diagonal(const datapath::TrianglePass& pass, const std::array<golden::Vertex, 3>& given);
    /// Returns whether in_front flipped as allowed.
    bool compare_displaced(Value position, Value screen, Value w, Value distance, const datapath::Position& displaced,
                           const datapath::ScreenPosition& on_screen, const golden::Vertex& golden,
                           const glm::dvec3& position_bound, const Context& context);
    void compare_vector(Value value, const datapath::Direction& hardware, const glm::dvec3& golden,
                        const glm::dvec3& bound, const Context& context);

    /// Compares the hardware's integer with golden's value, in golden's units.
    void compare(Value value, std::int64_t hardware, double golden, const Interval& bound,
                 const datapath::Format& format, double per_unit, char component, const Context& context);
    /// Returns whether it flipped as allowed.
    bool decide(Decision decision, bool hardware, bool golden, bool flip_allowed, const Context& context);
    void mismatch(const std::string& what, const Context& context);

    datapath::Registers registers_;
    const GoldenInputs& inputs_;
    Dequantise dequantise_;
    ErrorBounds bounds_;
    double per_position_, per_normal_, per_texture_, per_screen_, per_view_distance_;  // LSB per unit

    std::array<ValueStatistics, value_count> values_;
    std::array<DecisionStatistics, decision_count> decisions_;
    std::uint64_t passes_ = 0, edges_ = 0, base_vertices_ = 0, flipped_edges_ = 0, mismatches_ = 0;
    std::string first_mismatch_;
};

}  // namespace tessera
