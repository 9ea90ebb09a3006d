#pragma once
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace tessera {

/// The result of a job of testbench/examples/jobs, in either mode; half_donut is the default job. It changes with the
/// datapath, the host, a default or the timing. The commit message must explain a changed line.
struct JobResult {
    const char* name;
    std::uint64_t triangles;  ///< finished
    std::uint64_t splits;     ///< edges
    std::uint64_t edges;      ///< tested
    std::uint64_t cycles;     ///< timed mode
    /// 64 bit FNV-1a of mesh.ply's lines after "end_header", in the file's order.
    std::uint64_t mesh;
};

inline constexpr std::array<JobResult, 6> job_results{{
    {"crater_lake_24", 13911, 13887, 69408, 832913, 0xfa8fb8b4afaaa589},
    {"crater_lake_704", 13542, 12838, 67305, 807677, 0x4c430db663d9fa69},
    {"crater_lake_rank", 5081, 5057, 30414, 48226, 0x6fd3aef843b0009f},
    {"half_donut", 11948, 11930, 59100, 709217, 0xd542341843ddeb42},
    {"head", 19891, 17843, 94146, 1131298, 0x77f947936fc60938},
    {"teapot", 83960, 82968, 402087, 4825069, 0x80344fd6c579f824},
}};

inline const JobResult& result_of(const std::string& job) {
    for (const JobResult& result : job_results)
        if (result.name == job)
            return result;
    throw std::invalid_argument(job);
}

}  // namespace tessera
