#pragma once
#include <string>

#include "golden/golden_model.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/triangle_pass.h"

namespace tessera {

/// One line with the difference, then every operand needed to recalculate it by hand: the ends (or the base vertex) as
/// the hardware holds them, both sides' results, thresholds and formats. `edge`, `vertex`: index within the pass, or -1
/// if the mismatch is not of an edge or not of a vertex. Hardware values are integers; golden's are in the same LSB,
/// with fractions.
std::string mismatch_text(const std::string& what, const datapath::Registers& registers,
                          const golden::Parameters& parameters, const datapath::TrianglePass& pass, int edge,
                          int vertex, const golden::EdgeEvaluation* evaluation, const golden::Vertex* completed);

}  // namespace tessera
