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
    /// 64 bit FNV-1a of mesh.ply's lines after "end_header", sorted as the file has them.
    std::uint64_t mesh;
};

inline constexpr std::array<JobResult, 5> job_results{{
    {"crater_lake_24", 13906, 13882, 69381, 832589, 0xd173c8e2cff0eee9},
    {"crater_lake_704", 13480, 12776, 66966, 803609, 0xad0ca088dee075da},
    {"half_donut", 11948, 11930, 59100, 709217, 0xd542341843ddeb42},
    {"head", 21160, 19360, 100359, 1206000, 0x6c1452fe5b8b14be},
    {"teapot", 83959, 82967, 402216, 4826617, 0xe43464d87e28f74b},
}};

}  // namespace tessera
