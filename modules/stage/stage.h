#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <systemc>

#include "modules/datapath/reads.h"
#include "modules/sockets/stream_input.h"
#include "modules/sockets/stream_output.h"
#include "modules/stage/unit.h"

namespace tessera {

class MemoryPort;
using datapath::Entries;
using datapath::Reads;

/// How a stage reads: not at all; by requests that it offers and whose answers it takes; all at once, from a prompt
/// memory (PromptMemory).
enum class TableReads { none, requested, prompt };

/// A unit that accepts an item, reads any table entries it needs, processes it, and passes the result on. A derived
/// unit declares its sockets once and implements the functions below; both modes run the same functions.
///
/// Timed mode: an item starts when the interval is over, a register stage is free and the memory has accepted the
/// requests of the previous item. It is finished a latency after its start or, if it reads, after its last answer.
/// Items leave in order. There are register_stages(), so that neither the unit's nor the memory's latency reduces
/// throughput. Functional mode: reads, processes the item, adds the latency, and passes the result on.
template <class In, class Out>
class Stage : public Unit {
  public:
    std::string describe_contents() const override;
    std::uint64_t occupied_cycles() const override;
    void trace_signals(Signals& signals) const override;

  protected:
    /// servers: parallel pipelines, used round-robin. memory_latency: of the table that the unit reads.
    Stage(const sc_core::sc_module_name& name, const UnitContext& context, const UnitTiming& timing,
          unsigned servers = 1, unsigned memory_latency = 0);

    /// Call these in the derived unit's constructor: for its input; for each output, with the function that makes its
    /// payload from a result and the parts that it is for; for each port that it reads through (most_requests: the most
    /// requests that one item makes through this port).
    void takes_from(const UnitContext& context, StreamInput<In>& input);
    void delivers_to(const UnitContext& context, StreamOutput<Out>& output, Parts only = all_parts);
    template <class Payload>
    void delivers_to(const UnitContext& context, StreamOutput<Payload>& output, Payload (*select)(const Out&),
                     Parts only);
    void reads_through(MemoryPort& port, unsigned most_requests);
    /// For a unit that overrides may_start(). heeds_arrival: what process() sets counts there from entries_arrive() on;
    /// otherwise process() is not called before then.
    void may_wait(bool heeds_arrival = false) {
        may_wait_ = true;
        heeds_arrival_ = heeds_arrival;
    }
    /// Area beyond what Stage counts itself (the input buffer, and the wider of the items in and out in each register
    /// stage): an item's multiplications; bits kept with it in each register stage.
    void multiplies(const datapath::Multiplications& multiplications);
    void keeps(int bits);

    /// For a unit that calls may_wait() in its constructor. Returns false if the item waits for another input; in
    /// functional mode that is an error.
    virtual bool may_start(const In&) const { return true; }
    /// The unit that drives this other input; in functional mode, the time at which its data arrived.
    virtual const sc_core::sc_object* awaited_unit() const { return nullptr; }
    virtual sc_core::sc_time may_start_after(const In&) const { return sc_core::SC_ZERO_TIME; }

    /// Determines the entries that an item needs.
    virtual void reads(const In&, Reads&) const {}
    /// Processes an item with the entries read for it, and returns the result. With a prompt memory it is called when the
    /// item starts.
    virtual Out process(const In& item, const Entries& entries) = 0;
    /// Within process(), timed mode: the cycle in which the item's entries arrive.
    std::uint64_t entries_arrive() const { return entries_arrive_; }

    /// Signals in addition to the items' fields, for an item that has been processed.
    virtual void trace_processed(Signals&, const In&, const Out&) const {}

    void start_of_simulation() override;
    void step() override;

    const UnitTiming timing_;

  private:
    struct Machinery;  // stage_steps.h

    bool reads_tables() const;
    template <class Figure>
    std::uint64_t over_ports(Figure figure) const;
    void b_transport(In& item, sc_core::sc_time& delay);
    void read_entries(const In& item, Entries& entries, sc_core::sc_time& delay);
    // Three copies: units without tables skip all that concerns requests.
    template <TableReads Access>
    void step_with();
    template <TableReads Access>
    void start(std::uint64_t cycle);
    void take_answers(std::uint64_t cycle);

    const sc_core::sc_time latency_;
    bool may_wait_ = false;
    bool heeds_arrival_ = false;
    std::uint64_t entries_arrive_ = 0;
    StreamInput<In>* input_ = nullptr;
    const std::shared_ptr<Machinery> machinery_;  // its deleter, unlike a unique_ptr's, needs no stage_steps.h
};

}  // namespace tessera
