#pragma once
#include <string>

#include "golden/golden_model.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/triangle_pass.h"

namespace tessera {

/// One line saying what differs, then every operand needed to work the case through by hand: the ends (or the
/// base vertex) as the hardware holds them, what both sides made of them, thresholds and formats. `edge`,
/// `vertex`: which of the pass's, -1: the other, or the pass as a whole. Hardware values are integers;
/// golden's are in the same LSB, with fractions.
std::string mismatch_text(const std::string& what, const datapath::Registers& registers,
                          const golden::Parameters& parameters, const datapath::TrianglePass& pass, int edge,
                          int vertex, const golden::EdgeEvaluation* evaluation,
                          const golden::Vertex* completed);

}  // namespace tessera
