#pragma once
#include <vector>

#include "testbench/check/mesh/base_edge_chains.h"
#include "testbench/check/mesh/invariants.h"
#include "testbench/check/mesh/violation_text.h"

namespace tessera {

/// Compares how neighbouring base triangles were cut along the edges they share, and what was made of the
/// vertices they share. Joined sides (invariants.h) must agree in every piece; others are counted where they
/// do not.
///
/// Of three sides and more at one base edge, all that are joined must agree; if an odd number of them is,
/// that group must have met another. chains: from PatchCheck, of every base triangle.
void check_base_edges(const EmittedMesh& mesh, const std::vector<datapath::Triangle>& base_triangles,
                      const datapath::Registers& registers, const BaseEdgeChains& chains,
                      InvariantResult& result, FirstViolation& first);

}  // namespace tessera
