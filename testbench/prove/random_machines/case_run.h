#pragma once
#include <cstdint>
#include <string>

#include "testbench/prove/random_machines/random_case.h"

namespace tessera {

/// The figures of one run of one case.
struct CaseFigures {
    std::uint64_t runs = 0;
    std::uint64_t base_triangles = 0;
    std::uint64_t triangles = 0;
    std::uint64_t edges = 0;  ///< evaluated
    std::uint64_t cracks = 0;
    std::uint64_t t_vertices = 0;
    std::uint64_t other_violations = 0;  ///< of the invariants
    std::uint64_t collapsed = 0;         ///< caused by rounding or by the input
    std::uint64_t turned_over = 0;       ///< likewise
    std::uint64_t open_input_edges = 0;  ///< at texture seams and creases of the input
    std::uint64_t flips = 0;             ///< edges, allowed: golden within the formats' bound of its threshold
    std::uint64_t mismatches = 0;        ///< against the golden model
    std::uint64_t spilled = 0;           ///< triangles sent off chip
    std::uint64_t cycles = 0;
    /// Digest of all fields of one run's emitted triangles, independent of order; not added up.
    std::uint64_t mesh_digest = 0;

    void add(const CaseFigures& other);
};

struct CaseResult {
    CaseFigures figures;
    /// Empty: invariants, conformance and work check hold, and the run ended normally.
    std::string failure;
};

/// Runs a case in this process, which must not have elaborated anything before (SystemC can do so once).
CaseResult run_case(const RandomCase& random_case, Mode mode);

}  // namespace tessera
