#pragma once
#include <cstddef>
#include <systemc>

#include "modules/sockets/items.h"
#include "modules/sockets/stream_output.h"
#include "modules/stage/unit.h"

namespace tessera {

/// Common base of Collect Tests and of both kinds of Sequence Tests: joins the results of an edge's tests.
class CollectingUnit : public Unit {
  public:
    /// Its output to Pass or Tessellate; with several lanes one per lane.
    virtual StreamOutput<TestedEdge>& tested_edges(std::size_t lane = 0) = 0;

  protected:
    using Unit::Unit;
};

}  // namespace tessera
