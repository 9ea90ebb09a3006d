#pragma once
#include <algorithm>
#include <cstdint>
#include <deque>
#include <vector>

#include "modules/datapath/tessellate.h"
#include "testbench/prove/random_edges/edge_machine.h"

/// The recursion, using only the datapath's functions.
namespace tessera::testing {

using tessera::EdgeMachine;
using tessera::make_tables;
using tessera::same_bits;
using tessera::Tables;

/// The recursion: triangles waiting first in, first out.
class WorkList {
  public:
    WorkList(EdgeMachine& machine, const std::vector<datapath::Triangle>& base)
        : waiting(base.begin(), base.end()), machine_(machine) {
        for (datapath::Triangle& triangle : waiting)
            machine.complete_base(triangle);
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
    EdgeMachine& machine_;
};

}  // namespace tessera::testing
