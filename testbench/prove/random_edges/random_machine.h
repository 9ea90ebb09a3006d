#pragma once
#include "modules/datapath/vertex.h"
#include "testbench/common/random.h"
#include "testbench/prove/random_edges/direct_edge.h"
#include "testbench/prove/random_edges/edge_machine.h"

namespace tessera {

enum class FormatWidths { usual, narrow, wide, any };

/// Registers and tables drawn at random, held by the machine as its memories hold them and once more as they are.
struct RandomMachine {
    Machine machine;
    DirectMap map;
};

/// Maps up to 64 x 64, one of four 1 x N or N x 1: noise, extremes (0 and full scale), steps. Formats up to
/// the widest a job may ask for. A camera whose near plane cuts through the vertices.
RandomMachine make_random_machine(Random& random, FormatWidths widths);

/// A base vertex anywhere: on the map, its borders and, where it repeats, periods beyond; or near another one, where
/// rounding bites. Complete.
datapath::Vertex make_random_vertex(Random& random, Machine& machine, const datapath::Vertex* near);

}  // namespace tessera
