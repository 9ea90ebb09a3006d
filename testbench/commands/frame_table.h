#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "testbench/machine/host_traffic.h"

namespace tessera {

/// One frame's row in the table of a run of several frames.
struct FrameRow {
    std::string name;  ///< frame_000
    double scale = 0;  ///< displacement.scale, model units
    HostTraffic sent;  ///< sent by the host for this frame, given the frame before
    std::uint64_t triangles = 0, edges_tested = 0, edges_split = 0;
    std::optional<std::uint64_t> cycles;  ///< timed mode
    std::uint64_t tessellated_bytes = 0;  ///< if the host sent the tessellated mesh instead (indexed)
};

/// Reads the frame's counts from the statistics.json in its folder.
void read_counts(const std::filesystem::path& folder, FrameRow& row);

/// frames.csv: a heading and one row per frame. In functional mode the cell for cycles is empty.
std::string frames_csv(const std::vector<FrameRow>& rows);

/// The table for a terminal, and the host's traffic for the first frame, for a later one and in total.
std::string frames_heading();
std::string frames_line(const FrameRow& row);
std::string frames_traffic(const std::vector<FrameRow>& rows);

}  // namespace tessera
