#pragma once
#include <cstddef>
#include <cstdint>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/clock/clock.h"
#include "modules/stream/random_stalls.h"
#include "modules/stream/stream.h"

namespace tessera {

/// A unit's input. Functional mode: hands b_transport to the unit. Timed mode: a buffer of `depth` items; an item that
/// finds it full waits at the door, its END_REQ withheld. Checks the producer's phases.
template <class Payload>
class StreamInput : public tlm::tlm_target_socket<32, Stream<Payload>>,
                    public tlm::tlm_fw_transport_if<Stream<Payload>> {
    using Socket = tlm::tlm_target_socket<32, Stream<Payload>>;

  public:
    explicit StreamInput(const char* name) : Socket(name), ring_(1) {
        Socket::bind(static_cast<tlm::tlm_fw_transport_if<Stream<Payload>>&>(*this));
    }

    /// Functional mode: `(unit.*Method)(payload, delay)` does the work.
    template <auto Method, class Unit>
    void serve(Unit& unit) {
        server_ = &unit;
        serve_ = [](void* server, Payload& payload, sc_core::sc_time& delay) {
            (static_cast<Unit*>(server)->*Method)(payload, delay);
        };
    }

    /// Timed mode: `unit` is called when an item has come. depth: at least 1.
    void clocked_by(Clock& clock, Clocked& unit, std::size_t depth, const StallParameters& stalls) {
        clock_ = &clock;
        unit_ = &unit;
        ring_.assign(depth, Payload{});
        depth_ = depth;
        stalls_ = RandomStalls(stalls, this->name());
    }

    /// Timed mode, for a unit that does nothing until there is an item in all of its inputs: it is called only then.
    /// empty_inputs: how many of them are empty; shared by them, and theirs to count.
    void waits_for_all(unsigned& empty_inputs) {
        empty_inputs_ = &empty_inputs;
        ++empty_inputs;
    }

    bool empty() const { return size_ == 0; }
    std::size_t size() const { return size_; }
    std::size_t depth() const { return depth_; }
    /// An item waits at the door.
    bool holds_back() const { return at_the_door_ != nullptr; }
    std::uint64_t taken() const { return taken_; }

    Payload& front() { return ring_[first_]; }
    const Payload& front() const { return ring_[first_]; }

    /// Removes the first item, and lets the one at the door in.
    void pop() {
        first_ = first_ + 1 == depth_ ? 0 : first_ + 1;
        --size_;
        if (empty_inputs_ != nullptr && size_ == 0)
            ++*empty_inputs_;
        admit();
    }

    /// Lets the item at the door in if its time has come and there is room. To be called at the start of each step.
    void admit() {
        if (at_the_door_ != nullptr)
            open_the_door();
    }

  private:
    void open_the_door() {
        if (size_ == depth_)
            return;
        if (clock_->cycle() < door_opens_) {
            clock_->wake_at(*unit_, door_opens_);
            return;
        }
        Payload& payload = *at_the_door_;
        at_the_door_ = nullptr;
        push(payload);
        tlm::tlm_phase phase = tlm::END_REQ;
        sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
        (*this)->nb_transport_bw(payload, phase, delay);
    }

    tlm::tlm_sync_enum nb_transport_fw(Payload& payload, tlm::tlm_phase& phase,
                                       sc_core::sc_time& delay) override {
        if (phase != tlm::BEGIN_REQ)
            stream_protocol_error(this->name(), "a phase other than BEGIN_REQ", clock_);
        if (at_the_door_ != nullptr)
            stream_protocol_error(this->name(), "BEGIN_REQ before END_REQ of the item before", clock_);
        if (unit_ == nullptr)
            stream_protocol_error(this->name(), "nb_transport in functional mode", clock_);
        const std::uint64_t wait = stalls_.next() + clock_->cycles(delay);
        if (wait == 0 && size_ < depth_) {
            push(payload);
            if (empty_inputs_ == nullptr || *empty_inputs_ == 0)
                clock_->wake(*unit_);
            else
                clock_->show(*unit_);
            phase = tlm::END_REQ;
            return tlm::TLM_UPDATED;
        }
        at_the_door_ = &payload;
        door_opens_ = clock_->cycle() + wait;
        if (size_ < depth_)
            clock_->wake_at(*unit_, door_opens_);
        else
            clock_->show(*unit_);
        return tlm::TLM_ACCEPTED;
    }

    void b_transport(Payload& payload, sc_core::sc_time& delay) override { serve_(server_, payload, delay); }
    bool get_direct_mem_ptr(Payload&, tlm::tlm_dmi&) override { return false; }
    unsigned transport_dbg(Payload&) override { return 0; }

    void push(const Payload& payload) {
        const std::size_t place = first_ + size_;
        ring_[place < depth_ ? place : place - depth_] = payload;
        if (empty_inputs_ != nullptr && size_ == 0)
            --*empty_inputs_;
        ++size_;
        ++taken_;
    }

    void* server_ = nullptr;
    void (*serve_)(void*, Payload&, sc_core::sc_time&) = nullptr;
    Clock* clock_ = nullptr;
    Clocked* unit_ = nullptr;
    std::vector<Payload> ring_;
    std::size_t depth_ = 1;
    std::size_t first_ = 0;
    std::size_t size_ = 0;
    Payload* at_the_door_ = nullptr;
    std::uint64_t door_opens_ = 0;
    unsigned* empty_inputs_ = nullptr;
    std::uint64_t taken_ = 0;
    RandomStalls stalls_;
};

}  // namespace tessera
