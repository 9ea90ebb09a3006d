#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "modules/schedule/backend.h"
#include "modules/schedule/link.h"
#include "modules/schedule/shared_table.h"

namespace tessera::schedule {

/// The corners of a base triangle, in a unit whose edges wait for them.
struct Corners {
    unsigned left = 0;  ///< corners that have not arrived
    Cycle come = 0;     ///< in which the last one arrived
};

/// A triangle between Get Triangle and its decision in Pass or Tessellate.
struct Pass {
    using CornersOfTests = std::array<Corners, most_tests_units>;

    Facts facts;
    CornersOfTests bumped, on_screen;            ///< in each Normal Test and View Test
    Cycle arrived = 0;                           ///< at Pass or Tessellate: the triangle itself
    unsigned geometry_left = 0, tests_left = 0;  ///< parts that have not arrived there
    Join join;
};

using Passes = Latest<Pass>;

/// A unit with an input, a pipeline and outputs (stage.h), called in each cycle in which its state can change.
class SteppedStage {
  public:
    using Memory = SharedTable<SteppedStage>;

    SteppedStage(Calls& calls, Passes& passes, unsigned call, Link& input, const PipelinePlan& plan)
        : calls_(calls),
          passes_(passes),
          call_(call),
          input_(input),
          pipeline_(plan),
          items_(plan.stages),
          level_(plan.stages) {}

    /// parts: those that go to the consumer, one bit each.
    void delivers_to(Link& link, unsigned parts, Unit consumer) { outputs_.push_back({&link, parts, consumer}); }
    /// Sets the entries that a triangle's parts need, and the memory. number: of this unit among the memory's readers.
    void reads(Facts::Reads Facts::*reads, Memory& memory, unsigned number, Unit its) {
        reads_ = reads;
        memories_[0] = {&memory, number, its};
    }
    void reads_second(Memory& memory, unsigned number, Unit its) { memories_[1] = {&memory, number, its}; }
    /// Makes edges wait for their triangle's corners in Tessellation Tests unit `number`: the corners that the unit
    /// itself has read or, if `from` is given, those that arrive there.
    void waits_for(Pass::CornersOfTests Pass::*corners, unsigned number, Link* from = nullptr, Unit awaited = nobody) {
        corners_ = corners;
        number_ = number;
        from_ = from;
        awaited_ = awaited;
    }

    void step() {
        if (from_ != nullptr)
            take_corners();
        input_.admit();
        while (started_ > departed_ && first().finished <= calls_.now() && deliver())
            depart();
        while (ask() && may_start())
            start();
        if (started_ > departed_ && first().finished > calls_.now())
            calls_.wake_at(call_, first().finished);
    }

    /// The request on offer has been accepted.
    void accepted() {
        on_offer_ = false;
        calls_.wake(call_);
    }
    /// The last entry for item n arrives in this cycle.
    void answered(std::uint64_t n, Cycle cycle) {
        InPipeline& it = items_[n];
        it.answer = cycle;
        it.finished = cycle + pipeline_.latency();
        calls_.wake_at(call_, it.finished);
        if (corners_ != nullptr && it.item.part() < first_edge_part) {
            corner_came(it.item.pass(), cycle);
            calls_.wake_at(call_, cycle);
        }
    }
    States& states() { return states_; }
    Level& level() { return level_; }

  private:
    struct InPipeline {
        Item item;
        Cycle taken = 0;  ///< into the input's buffer
        Cycle due = 0;    ///< from which the interval allowed it to start
        Cycle start = 0;
        Cycle answer = 0;    ///< to its last request
        Cycle finished = 0;  ///< `never`: not known yet
        Unit memory = nobody;
    };
    struct Output {
        Link* link = nullptr;
        unsigned parts = 0;
        Unit consumer = nobody;
    };

    void corner_came(std::uint64_t pass, Cycle cycle) {
        Corners& corners = (passes_[pass].*corners_)[number_];
        --corners.left;
        corners.come = cycle;
    }
    /// Accepts corners without waiting.
    void take_corners() {
        from_->admit();
        for (; !from_->empty(); from_->pop())
            corner_came(from_->front().pass(), calls_.now());
    }

    InPipeline& first() { return items_[departed_]; }

    /// Offers the first item to its consumers. Returns true if all have accepted it. If several have not, the first
    /// output is taken as the cause.
    bool deliver() {
        const Item item = first().item;
        const bool offered = blocked_by_ != nobody;
        if (offered)
            states_.until(calls_.now(), State::blocked, blocked_by_);
        else
            account(first());
        blocked_by_ = nobody;
        for (std::size_t k = outputs_.size(); k-- > 0;) {
            const auto& [link, parts, consumer] = outputs_[k];
            if ((parts >> item.part() & 1) != 0 && !(offered ? link->free() : link->send(item)))
                blocked_by_ = consumer;
        }
        return blocked_by_ == nobody;
    }
    void depart() {
        pipeline_.depart(calls_.now());
        level_.stay(first().start, calls_.now());
        ++departed_;
    }
    /// Accounts for the cycles up to now. The first item has finished, and those before it have departed.
    void account(const InPipeline& it) {
        states_.until(it.taken, State::starved);
        states_.until(std::min(it.start, it.due), State::busy);
        states_.until(it.start, State::starved, awaited_);
        if (it.memory != nobody)
            states_.until(it.answer, State::waiting_for_memory, it.memory);
        states_.until(calls_.now(), State::busy);
    }

    /// Makes the requests of the item that started last. Returns true if all have been accepted.
    bool ask() {
        while (asked_ < to_ask_ && !on_offer_) {
            const InPipeline& it = items_[started_ - 1];
            const PartReads& reads = (passes_[it.item.pass()].facts.*reads_)[it.item.part()];
            const unsigned request = asked_++;
            const bool last = asked_ == to_ask_;
            const ItsMemory& memory = memories_[reads.memory];
            on_offer_ = !memory.table->offer(
                {this, reads.banks_of(request), reads.entries_of(request), last, started_ - 1}, memory.number);
        }
        return !on_offer_;
    }
    bool may_start() {
        if (input_.empty() || started_ - departed_ == pipeline_.stages())
            return false;
        Cycle from = pipeline_.due();
        const Item item = input_.front();
        if (corners_ != nullptr && item.part() >= first_edge_part) {
            const Corners& corners = (passes_[item.pass()].*corners_)[number_];
            from = corners.left > 0 ? never : std::max(from, corners.come);
        }
        if (from > calls_.now())
            calls_.wake_at(call_, from);
        return from <= calls_.now();
    }
    void start() {
        const Cycle now = calls_.now();
        InPipeline& it = items_[started_++];
        it.item = input_.front();
        it.taken = input_.since();
        it.due = std::max(it.taken, pipeline_.due());
        it.start = pipeline_.start(now);
        it.finished = now + pipeline_.latency();
        it.memory = nobody;
        if (reads_ != nullptr) {
            const PartReads& reads = (passes_[it.item.pass()].facts.*reads_)[it.item.part()];
            asked_ = 0;
            to_ask_ = reads.requests;
            if (to_ask_ > 0) {
                it.finished = never;
                it.memory = memories_[reads.memory].unit;
            }
        }
        input_.pop();
    }

    struct ItsMemory {
        Memory* table = nullptr;
        unsigned number = 0;  ///< which of its readers this is
        Unit unit = nobody;
    };

    Calls& calls_;
    Passes& passes_;
    unsigned call_;  // the unit's number in calls_
    Link& input_;
    Pipeline pipeline_;
    std::vector<Output> outputs_;
    Facts::Reads Facts::*reads_ = nullptr;
    std::array<ItsMemory, 2> memories_;
    Pass::CornersOfTests Pass::*corners_ = nullptr;
    Link* from_ = nullptr;
    Unit awaited_ = nobody;
    unsigned number_ = 0;

    Latest<InPipeline> items_;
    std::uint64_t started_ = 0, departed_ = 0;
    unsigned to_ask_ = 0, asked_ = 0;  // requests of the item that started last
    bool on_offer_ = false;            // a request is on offer
    Unit blocked_by_ = nobody;         // consumer that blocks the first item; nobody: the item is not on offer
    States states_;
    Level level_;
};

}  // namespace tessera::schedule
