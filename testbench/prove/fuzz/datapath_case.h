#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "testbench/prove/random_edges/datapath_edge.h"

namespace tessera::fuzz {

/// A design's formats and registers, its three tables, and a small patch of base triangles that share edges: all that
/// the datapath works on, of a fuzzer's bytes. Whatever the bytes, a case is legal: its formats are those of a job that
/// validates (by job_keys.cpp's ranges, which are asked for, not repeated), its registers lie where the host sets them
/// (testbench/machine/machine_setup.cpp). The Generation Test is always on: without it a recursion need not end.
struct DatapathCase {
    datapath::Registers registers;
    testing::Tables tables;
    std::vector<std::uint32_t> codes;       ///< the displacement map, bottom row first
    std::vector<datapath::Vertex> corners;  ///< of the patch; positions and texture coordinates anywhere
    std::vector<datapath::Triangle> base;   ///< two to each square of the patch, wound alike
    std::array<std::int64_t, 3> vector{};   ///< to be normalised: components of up to 31 bits
};

DatapathCase make_datapath_case(std::string_view bytes);

}  // namespace tessera::fuzz
