#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <systemc>
#include <tlm>

#include "modules/datapath/format.h"
#include "modules/sockets/stream_input.h"
#include "testbench/prove/faults/fault.h"
#include "testbench/prove/faults/flip_bit.h"

namespace tessera {

/// Inserted between a stream's output and its input. Corrupts one transaction and forwards all others unchanged,
/// payload and phases, in both transports.
///
///   bit_flip               the consumer gets a copy with a bit flipped
///   dropped                END_REQ to the producer, nothing to the consumer
///   doubled                the consumer gets it twice, by the protocol; the producer waits for both
///   reordered              the next one is sent first; not for the last of a run
///   back_pressure_ignored  as dropped, when the consumer has no room: it is overwritten
///   request_before_end     a second BEGIN_REQ while the consumer withholds END_REQ
///   end_request_doubled    the producer gets END_REQ twice
template <class Payload>
class StreamFault : public sc_core::sc_module,
                    public tlm::tlm_fw_transport_if<Stream<Payload>>,
                    public tlm::tlm_bw_transport_if<Stream<Payload>> {
    using Types = Stream<Payload>;
    using Forward = tlm::tlm_fw_transport_if<Types>;
    using Backward = tlm::tlm_bw_transport_if<Types>;

  public:
    // Bound to this module itself: a producer finds it by its interface (module_behind) and reports its name.
    tlm::tlm_target_socket<32, Types> in{"in"};
    tlm::tlm_initiator_socket<32, Types> out{"out"};

    /// `trigger` must outlive it. consumer: the unit whose lack of room is observed.
    StreamFault(const sc_core::sc_module_name& name, FaultTrigger& trigger, const datapath::Formats& formats,
                int tag_bits, const StreamInput<Payload>& consumer)
        : sc_module(name), trigger_(trigger), formats_(formats), tag_bits_(tag_bits), consumer_(consumer) {
        in.bind(static_cast<Forward&>(*this));
        out.bind(static_cast<Backward&>(*this));
    }

  private:
    /// Sends `payload` to the consumer in place of this transaction.
    void replace(const Payload& payload) {
        if (held_) {
            copies_ = {payload, *held_};
            held_.reset();
            trigger_.wait_for_next(false);
            return;
        }
        copies_ = {payload};
        switch (trigger_.kind()) {
            case FaultKind::bit_flip:
                trigger_.require_bit(flip_bit(copies_.front(), formats_, tag_bits_, trigger_.fault().bit));
                break;
            case FaultKind::doubled: copies_.push_back(payload); break;
            case FaultKind::reordered:
                held_ = payload;
                trigger_.wait_for_next(true);
                copies_.clear();
                break;
            default: copies_.clear();
        }
    }

    void b_transport(Payload& payload, sc_core::sc_time& delay) override {
        if (!held_ && !trigger_.strikes()) {
            out->b_transport(payload, delay);
            return;
        }
        replace(payload);
        for (; !copies_.empty(); copies_.pop_front())
            out->b_transport(copies_.front(), delay);
    }

    tlm::tlm_sync_enum nb_transport_fw(Payload& payload, tlm::tlm_phase& phase, sc_core::sc_time& delay) override {
        switch (trigger_.kind()) {
            case FaultKind::request_before_end: return begin_again(payload, phase, delay);
            case FaultKind::end_request_doubled: return end_twice(payload, phase, delay);
            case FaultKind::back_pressure_ignored:
                if (consumer_.size() < consumer_.depth() || !trigger_.strikes())
                    return out->nb_transport_fw(payload, phase, delay);
                break;
            default:
                if (!held_ && !trigger_.strikes())
                    return out->nb_transport_fw(payload, phase, delay);
                replace(payload);
        }
        offered_ = &payload;
        if (!send_copies())
            return tlm::TLM_ACCEPTED;
        offered_ = nullptr;
        phase = tlm::END_REQ;
        return tlm::TLM_UPDATED;
    }

    tlm::tlm_sync_enum begin_again(Payload& payload, tlm::tlm_phase& phase, sc_core::sc_time& delay) {
        const tlm::tlm_sync_enum status = out->nb_transport_fw(payload, phase, delay);
        if (status == tlm::TLM_ACCEPTED && trigger_.strikes()) {
            copies_ = {payload};
            tlm::tlm_phase again = tlm::BEGIN_REQ;
            out->nb_transport_fw(copies_.front(), again, delay);
        }
        return status;
    }

    tlm::tlm_sync_enum end_twice(Payload& payload, tlm::tlm_phase& phase, sc_core::sc_time& delay) {
        const bool now = trigger_.strikes();
        const tlm::tlm_sync_enum status = out->nb_transport_fw(payload, phase, delay);
        if (now && status == tlm::TLM_ACCEPTED)
            ends_twice_ = &payload;
        else if (now)
            end(payload);
        return status;
    }

    void end(Payload& payload) {
        tlm::tlm_phase phase = tlm::END_REQ;
        sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
        in->nb_transport_bw(payload, phase, delay);
    }

    /// Returns false if the consumer withholds END_REQ of the first.
    bool send_copies() {
        for (; !copies_.empty(); copies_.pop_front()) {
            tlm::tlm_phase phase = tlm::BEGIN_REQ;
            sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
            if (out->nb_transport_fw(copies_.front(), phase, delay) == tlm::TLM_ACCEPTED)
                return false;
        }
        return true;
    }

    tlm::tlm_sync_enum nb_transport_bw(Payload& payload, tlm::tlm_phase& phase, sc_core::sc_time& delay) override {
        if (copies_.empty() || &payload != &copies_.front()) {
            const tlm::tlm_sync_enum status = in->nb_transport_bw(payload, phase, delay);
            if (&payload == ends_twice_)
                end(payload);
            return status;
        }
        copies_.pop_front();
        if (send_copies()) {
            Payload& taken = *offered_;
            offered_ = nullptr;
            end(taken);
        }
        return tlm::TLM_ACCEPTED;
    }

    bool get_direct_mem_ptr(Payload&, tlm::tlm_dmi&) override { return false; }
    unsigned transport_dbg(Payload&) override { return 0; }
    void invalidate_direct_mem_ptr(sc_dt::uint64, sc_dt::uint64) override {}

    FaultTrigger& trigger_;
    datapath::Formats formats_;
    int tag_bits_;
    const StreamInput<Payload>& consumer_;
    std::deque<Payload> copies_;  // still to be sent to the consumer instead of the producer's payload
    Payload* offered_ = nullptr;  // the producer's payload, which waits for them
    Payload* ends_twice_ = nullptr;
    std::optional<Payload> held_;  // held until the next has been sent
};

}  // namespace tessera
