#include "testbench/job/frame_job.h"

#include <fmt/format.h>

#include <filesystem>

namespace tessera {

namespace {

constexpr std::string_view frame_prefix = "frame_";

}  // namespace

Job frame_job(const Job& job, std::int64_t k) {
    Job frame = job;
    frame.frames = {};
    const double first = job.frames.first_scale, last = job.displacement.scale;
    const std::int64_t steps = job.frames.count - 1;
    if (k < steps)
        frame.displacement.scale = first + (last - first) * static_cast<double>(k) / static_cast<double>(steps);
    frame.output.folder = (std::filesystem::path(job.output.folder) / frame_name(k)).string();
    return frame;
}

std::string frame_name(std::int64_t k) {
    return fmt::format("{}{:03}", frame_prefix, k);
}

bool is_frame_name(std::string_view name) {
    if (name.size() < frame_prefix.size() + 3 || name.substr(0, frame_prefix.size()) != frame_prefix)
        return false;
    return name.find_first_not_of("0123456789", frame_prefix.size()) == std::string_view::npos;
}

}  // namespace tessera
