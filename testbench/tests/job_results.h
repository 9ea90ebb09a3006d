#pragma once
#include <array>
#include <cstdint>

namespace tessera {

/// What a job of testbench/jobs comes to, in either mode; half_donut is the default job. A change of the datapath, the
/// host, a default or the timing shows here. Whoever changes a line says in the commit's message why it changed.
struct JobResult {
    const char* name;
    std::uint64_t triangles;  ///< finished
    std::uint64_t splits;     ///< edges
    std::uint64_t edges;      ///< tested
    std::uint64_t cycles;     ///< timed mode
    std::uint64_t mesh;       ///< 64 bit FNV-1a of mesh.ply's lines after "end_header", sorted as the file has them
};

inline constexpr std::array<JobResult, 5> job_results{{
    {"crater_lake_24", 0, 0, 0, 0, 0},
    {"crater_lake_704", 0, 0, 0, 0, 0},
    {"half_donut", 0, 0, 0, 0, 0},
    {"head", 0, 0, 0, 0, 0},
    {"teapot", 0, 0, 0, 0, 0},
}};

}  // namespace tessera
