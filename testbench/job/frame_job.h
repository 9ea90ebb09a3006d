#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "testbench/job/job.h"

namespace tessera {

/// The job of frame k of n = frames.count, a job of one frame: displacement.scale is first_scale + (scale -
/// first_scale) * k / (n - 1), for the last frame exactly the job's own; the folder is frame_name(k) in the job's;
/// everything else, bias included, is unchanged. Needs 0 <= k < n, n > 1.
Job frame_job(const Job& job, std::int64_t k);

/// frame_000, frame_001, ...
std::string frame_name(std::int64_t k);
bool is_frame_name(std::string_view name);

}  // namespace tessera
