#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "testbench/machine/host_traffic.h"

namespace tessera {

/// What a run of several frames says of one.
struct FrameRow {
    std::string name;  ///< frame_000
    double scale = 0;  ///< displacement.scale, model units
    HostTraffic sent;  ///< what the host sends for it after the frame before
    std::uint64_t triangles = 0, edges_tested = 0, edges_split = 0;
    std::optional<std::uint64_t> cycles;  ///< timed mode
    std::uint64_t tessellated_bytes = 0;  ///< the mesh, had the host to send it tessellated (indexed)
};

/// Takes what the frame counted from the statistics.json in its folder.
void read_counts(const std::filesystem::path& folder, FrameRow& row);

/// frames.csv: a heading, then a row a frame. No cycles in functional mode: the cell is empty.
std::string frames_csv(const std::vector<FrameRow>& rows);

/// The table on a terminal, and what the host sends for the first frame, a later one, and all.
std::string frames_heading();
std::string frames_line(const FrameRow& row);
std::string frames_traffic(const std::vector<FrameRow>& rows);

}  // namespace tessera
