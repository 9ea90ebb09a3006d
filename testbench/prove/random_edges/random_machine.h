#pragma once
#include "modules/datapath/vertex.h"
#include "testbench/common/random.h"
#include "testbench/prove/random_edges/direct_edge.h"
#include "testbench/prove/random_edges/edge_machine.h"

namespace tessera {

enum class FormatWidths { usual, narrow, wide, any };

/// Random registers and tables, in the machine's format and as a plain map.
struct RandomMachine {
    EdgeMachine machine;
    DirectMap map;
};

/// Maps up to 64 x 64, one of four 1 x N or N x 1: noise, extremes (0 and full scale), steps. Formats up to
/// a job's widest. Any height test; the table of another than the Summed Height Test holds random bits. The camera's
/// near plane passes through the vertices.
RandomMachine make_random_machine(Random& random, FormatWidths widths);

/// A complete base vertex at a random place: on the map, its borders and, if it repeats, periods beyond; or near
/// another vertex, where rounding matters.
datapath::Vertex make_random_vertex(Random& random, EdgeMachine& machine, const datapath::Vertex* near);

}  // namespace tessera
