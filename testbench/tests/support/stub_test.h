#pragma once
#include <systemc>
#include <vector>

#include "modules/sockets/items.h"
#include "modules/stage/stage_steps.h"

namespace tessera::testing {

/// Replaces a table test: answers edges with what `answer` says, and records what it receives.
template <class Operands, class Result>
class StubTest : public Stage<Operands, Result> {
  public:
    using Answer = Result (*)(const Operands&);

    StreamInput<Operands> input{"input"};
    StreamOutput<Result> output{"output"};
    std::vector<PartTag> asked;
    Tag answers_for = ~Tag{0};  ///< another triangle than the edge's

    StubTest(const sc_core::sc_module_name& name, const UnitContext& context, const UnitTiming& timing, Answer answer)
        : Stage<Operands, Result>(name, context, timing), answer_(answer) {
        this->takes_from(context, input);
        this->delivers_to(context, output, edge_parts);
    }

  private:
    Result process(const Operands& edge, const Entries&) override {
        asked.push_back(edge.tag);
        Result result = edge.tag.is_edge() ? answer_(edge) : Result{edge.tag};
        if (answers_for != ~Tag{0})
            result.tag.triangle = answers_for;
        return result;
    }

    Answer answer_;
};

}  // namespace tessera::testing
