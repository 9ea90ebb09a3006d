#pragma once
#include <algorithm>
#include <cstdint>
#include <deque>
#include <vector>

#include "modules/datapath/bump.h"
#include "modules/datapath/displace.h"
#include "modules/datapath/edge_tests.h"
#include "modules/datapath/map_address.h"
#include "modules/datapath/map_entry.h"
#include "modules/datapath/midpoint.h"
#include "modules/datapath/normalise.h"
#include "modules/datapath/rectangle.h"
#include "modules/datapath/tessellate.h"
#include "modules/datapath/transform.h"
#include "modules/datapath/triangle_pass.h"
#include "testbench/prove/random_edges/edge_machine.h"

/// The recursion, using only the datapath's functions.
namespace tessera::testing {

using tessera::Machine;
using tessera::make_tables;
using tessera::same_bits;
using tessera::Tables;

/// The recursion: triangles waiting first in, first out.
class WorkList {
  public:
    WorkList(Machine& machine, const std::vector<datapath::Triangle>& base) : machine_(machine) {
        for (datapath::Triangle triangle : base) {
            for (datapath::Vertex& vertex : triangle.vertices)
                machine.complete(vertex);
            waiting.push_back(triangle);
        }
    }

    std::deque<datapath::Triangle> waiting;
    std::uint64_t finished = 0;
    int largest_generation = 0;

    /// Processes one triangle; calls result(triangle) if no edge splits.
    template <class Result>
    void step(Result&& result) {
        const datapath::TrianglePass pass = machine_.evaluate(waiting.front());
        waiting.pop_front();
        if (pass.split == 0) {
            ++finished;
            result(pass.triangle);
            return;
        }
        tessellate(pass, machine_.registers.triangulation, machine_.registers.formats, machine_.saturations,
                   [&](const datapath::Triangle& child) {
                       for (const datapath::Vertex& vertex : child.vertices)
                           largest_generation = std::max(largest_generation, int{vertex.generation});
                       waiting.push_back(child);
                   });
    }

    /// Runs until no triangle waits or `bound` triangles are finished.
    template <class Result>
    void run(std::uint64_t bound, Result&& result) {
        while (!waiting.empty() && finished < bound)
            step(result);
    }
    void run(std::uint64_t bound) {
        run(bound, [](const datapath::Triangle&) {});
    }

  private:
    Machine& machine_;
};

}  // namespace tessera::testing
