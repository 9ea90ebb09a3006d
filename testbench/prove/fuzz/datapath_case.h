#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "testbench/prove/random_edges/datapath_edge.h"

namespace tessera::fuzz {

/// All inputs of the datapath, made from a fuzzer's bytes: a design's formats and registers, its three tables, and a
/// small patch of base triangles that share edges. A case is valid for any bytes: its formats are those of a valid job
/// (ranges of testbench/setup/setting_keys.h), and its registers are in the ranges set by the host (testbench/machine/machine_setup.cpp).
/// The Generation Test is always on, since the recursion may not end without it.
struct DatapathCase {
    datapath::Registers registers;
    testing::Tables tables;
    std::vector<std::uint32_t> codes;       ///< the displacement map, bottom row first
    std::vector<datapath::Vertex> corners;  ///< of the patch; arbitrary positions and texture coordinates
    std::vector<datapath::Triangle> base;   ///< two per square of the patch, of equal winding
    std::array<std::int64_t, 3> vector{};   ///< operand of normalise(): components of up to 31 bits
};

DatapathCase make_datapath_case(std::string_view bytes);

}  // namespace tessera::fuzz
