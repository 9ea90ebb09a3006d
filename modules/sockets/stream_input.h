#pragma once
#include <cstddef>
#include <cstdint>
#include <systemc>
#include <tlm>

#include "modules/sockets/items.h"
#include "modules/sockets/stream.h"
#include "modules/timing/cycle_scheduler.h"
#include "modules/timing/pending_item.h"
#include "modules/timing/random_stalls.h"
#include "modules/timing/ring.h"

namespace tessera {

/// A unit's input. Functional mode: forwards b_transport to the unit. Timed mode: a buffer of `depth` items; while it
/// is full, the next item waits and END_REQ is withheld. Checks the producer's phases.
template <class Payload>
class StreamInput final : public tlm::tlm_target_socket<32, Stream<Payload>>,
                          public tlm::tlm_fw_transport_if<Stream<Payload>>,
                          private CycleInput {
    using Socket = tlm::tlm_target_socket<32, Stream<Payload>>;

  public:
    explicit StreamInput(const char* name) : Socket(name), buffer_(1) {
        Socket::bind(static_cast<tlm::tlm_fw_transport_if<Stream<Payload>>&>(*this));
    }

    /// Functional mode: `(unit.*Method)(payload, delay)` processes the items.
    template <auto Method, class Unit>
    void register_b_transport(Unit& unit) {
        server_ = &unit;
        serve_ = [](void* server, Payload& payload, sc_core::sc_time& delay) {
            (static_cast<Unit*>(server)->*Method)(payload, delay);
        };
    }

    /// Timed mode: `unit` is called when an item arrives. depth: at least 1. Call once.
    void clocked_by(CycleScheduler& clock, CycleProcess& unit, std::size_t depth, const StallParameters& stalls) {
        clock_ = &clock;
        unit_ = &unit;
        unit.add_input(*this);
        buffer_ = Ring<Payload>(depth);
        stalls_ = RandomStalls(stalls, this->name());
    }

    /// Timed mode, for inputs from which the unit takes one item each, together: an item calls the unit only if none of
    /// them is then empty. empty_inputs: how many of them are empty; a counter shared and maintained by them.
    void waits_for_all(unsigned& empty_inputs) {
        empty_inputs_ = &empty_inputs;
        ++empty_inputs;
    }

    bool empty() const { return buffer_.empty(); }
    std::size_t size() const { return buffer_.size(); }
    std::size_t depth() const { return buffer_.capacity(); }
    /// True if an item waits to enter the buffer.
    bool holds_back() const { return !pending_.empty(); }
    /// Timed mode: items accepted so far.
    std::uint64_t taken() const { return taken_; }

    Payload& front() { return buffer_.front(); }
    const Payload& front() const { return buffer_.front(); }

    /// Removes the first item, and moves a waiting one into the buffer.
    void pop() {
        buffer_.pop();
        if (empty_inputs_ != nullptr && buffer_.empty())
            ++*empty_inputs_;
        if (!pending_.empty())
            admit();
    }

    /// b_transport without TLM.
    void transport(Payload& payload, sc_core::sc_time& delay) { serve_(server_, payload, delay); }

    /// BEGIN_REQ without TLM, this many cycles from now. Returns true if the item is accepted at once.
    bool offer(Payload& payload, std::uint64_t cycles = 0) {
        if (!pending_.empty())
            stream_protocol_error(this->name(), "BEGIN_REQ before END_REQ of the previous item", clock_);
        if (unit_ == nullptr)
            stream_protocol_error(this->name(), "nb_transport in functional mode", clock_);
        const std::uint64_t wait = stalls_.next() + cycles;
        if (wait == 0 && !buffer_.full()) {
            push(payload);
            if (empty_inputs_ == nullptr || *empty_inputs_ == 0)
                clock_->wake(*unit_);
            else
                clock_->wake_if_observed(*unit_);
            return true;
        }
        pending_.hold(payload, clock_->cycle() + wait);
        set_waiting(true);
        if (!buffer_.full())
            clock_->wake_at(*unit_, pending_.due_cycle());
        else
            clock_->wake_if_observed(*unit_);
        return false;
    }

  private:
    /// Moves the waiting item into the buffer, if it is due and there is room.
    void admit() override {
        if (buffer_.full())
            return;
        if (!pending_.due(clock_->cycle())) {
            clock_->wake_at(*unit_, pending_.due_cycle());
            return;
        }
        Payload& payload = pending_.take();
        set_waiting(false);
        push(payload);
        tlm::tlm_phase phase = tlm::END_REQ;
        sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
        (*this)->nb_transport_bw(payload, phase, delay);
    }

    tlm::tlm_sync_enum nb_transport_fw(Payload& payload, tlm::tlm_phase& phase, sc_core::sc_time& delay) override {
        if (phase != tlm::BEGIN_REQ)
            stream_protocol_error(this->name(), "a phase other than BEGIN_REQ", clock_);
        if (!offer(payload, clock_ == nullptr ? 0 : clock_->cycles(delay)))
            return tlm::TLM_ACCEPTED;
        phase = tlm::END_REQ;
        return tlm::TLM_UPDATED;
    }

    void b_transport(Payload& payload, sc_core::sc_time& delay) override { transport(payload, delay); }
    bool get_direct_mem_ptr(Payload&, tlm::tlm_dmi&) override { return false; }
    unsigned transport_dbg(Payload&) override { return 0; }

    void push(const Payload& payload) {
        if (empty_inputs_ != nullptr && buffer_.empty())
            --*empty_inputs_;
        buffer_.push(payload);
        ++taken_;
    }

    void* server_ = nullptr;
    void (*serve_)(void*, Payload&, sc_core::sc_time&) = nullptr;
    CycleScheduler* clock_ = nullptr;
    CycleProcess* unit_ = nullptr;
    Ring<Payload> buffer_;
    PendingItem<Payload> pending_;
    unsigned* empty_inputs_ = nullptr;
    std::uint64_t taken_ = 0;
    RandomStalls stalls_;
};

#define TESSERA_DECLARE_STREAM(Item) extern template class StreamInput<Item>;  // see stream_instances.cpp
TESSERA_FOR_EACH_STREAM_ITEM(TESSERA_DECLARE_STREAM)
#undef TESSERA_DECLARE_STREAM

}  // namespace tessera
