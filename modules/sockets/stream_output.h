#pragma once
#include <cstdint>
#include <functional>
#include <systemc>
#include <tlm>
#include <utility>

#include "modules/sockets/packed_item.h"
#include "modules/sockets/stream.h"
#include "modules/sockets/stream_input.h"
#include "modules/timing/cycle_scheduler.h"
#include "modules/timing/design.h"

namespace tessera {

/// A unit's output (timed mode: one item on offer at a time). Checks the consumer's phases. BUSWIDTH has no meaning for
/// a stream; widths follow from the formats.
template <class Payload>
class StreamOutput : public tlm::tlm_initiator_socket<32, Stream<Payload>>,
                     public tlm::tlm_bw_transport_if<Stream<Payload>> {
    using Socket = tlm::tlm_initiator_socket<32, Stream<Payload>>;

  public:
    explicit StreamOutput(const char* name) : Socket(name) {
        Socket::bind(static_cast<tlm::tlm_bw_transport_if<Stream<Payload>>&>(*this));
    }

    /// Binds this output to its input in place of bind(), and can insert a unit or a fault between them.
    using Interposer = std::function<void(StreamOutput& from, StreamInput<Payload>& to)>;
    void interpose(Interposer interposer) { interposer_ = std::move(interposer); }

    using Socket::bind;
    void bind(StreamInput<Payload>& input) {
        input_ = &input;
        if (const Interposer interposer = std::exchange(interposer_, nullptr)) {
            interposer(*this, input);
        } else {
            direct_ = true;
            Socket::bind(input);
        }
    }
    /// The input that the items reach, possibly through something that is no unit; null: bound to another socket.
    const StreamInput<Payload>* input() const { return input_; }

    /// Timed mode: `unit` is called when a delayed item is accepted.
    void clocked_by(CycleScheduler& clock, CycleProcess& unit) {
        clock_ = &clock;
        unit_ = &unit;
    }
    /// The same for a unit of the machine, whose items go through their packed form if the design asks for it.
    void clocked_by(const UnitContext& context, CycleProcess& unit) {
        clocked_by(context.clock, unit);
        if (context.design.packed_streams)
            wires_ = {&context.registers.formats, tag_bits_in_use(context.design)};
    }

    /// Functional mode: sends an item; on return everything downstream has finished.
    void transport(Payload& payload, sc_core::sc_time& delay) {
        if (wires_.formats == nullptr) {
            pass_on(payload, delay);
            return;
        }
        Payload packed = through_wires(payload);
        pass_on(packed, delay);
    }

    /// Timed mode: items offered so far.
    std::uint64_t sent() const { return sent_; }
    /// True if nothing is on offer.
    bool free() const { return on_offer_ == nullptr; }

    /// Offers an item, which must stay in place until free(). Returns true if it is accepted at once.
    bool send(Payload& payload) {
        if (on_offer_ != nullptr)
            stream_protocol_error(this->name(), "BEGIN_REQ before END_REQ of the previous item", clock_);
        if (wires_.formats != nullptr)
            packed_ = through_wires(payload);
        Payload& sent = wires_.formats != nullptr ? packed_ : payload;
        ++sent_;
        if (direct_ ? input_->offer(sent) : offer_by_tlm(sent))
            return true;
        on_offer_ = &sent;
        return false;
    }

    /// Offers an item; call again with the same item until it is accepted. Returns true once the consumer has accepted
    /// it; until then it must stay in place.
    bool deliver(Payload& payload) {
        delivering_ = delivering_ ? !free() : !send(payload);
        return !delivering_;
    }

    /// The module that accepts the items, and can block this one.
    const sc_core::sc_object* consumer() const {
        if (consumer_ == nullptr)
            consumer_ = module_behind(this->get_base_port().get_interface());
        return consumer_;
    }

  private:
    /// Null: items are passed on without packing.
    struct Wires {
        const datapath::Formats* formats = nullptr;
        int tag_bits = 0;
    };

    void pass_on(Payload& payload, sc_core::sc_time& delay) {
        if (direct_)
            input_->transport(payload, delay);
        else
            (*this)->b_transport(payload, delay);
    }

    bool offer_by_tlm(Payload& payload) {
        tlm::tlm_phase phase = tlm::BEGIN_REQ;
        sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
        const tlm::tlm_sync_enum status = (*this)->nb_transport_fw(payload, phase, delay);
        if (status == tlm::TLM_UPDATED && phase == tlm::END_REQ)
            return true;
        if (status != tlm::TLM_ACCEPTED)
            stream_protocol_error(this->name(), "BEGIN_REQ was answered by neither END_REQ nor TLM_ACCEPTED", clock_);
        return false;
    }

    Payload through_wires(const Payload& payload) const {
        if constexpr (is_described<Payload>) {
            PackedItem packed;
            if (!pack_item(payload, *wires_.formats, wires_.tag_bits, packed))
                stream_protocol_error(this->name(), "a value that does not fit its field", clock_);
            return unpack_item<Payload>(packed, *wires_.formats, wires_.tag_bits);
        } else {
            return payload;
        }
    }

    tlm::tlm_sync_enum nb_transport_bw(Payload& payload, tlm::tlm_phase& phase, sc_core::sc_time& delay) override {
        if (on_offer_ != &payload || phase != tlm::END_REQ)
            stream_protocol_error(this->name(), "a phase other than the expected END_REQ", clock_);
        on_offer_ = nullptr;
        if (unit_ != nullptr)
            clock_->wake_at(*unit_, clock_->cycle() + clock_->cycles(delay));
        return tlm::TLM_ACCEPTED;
    }
    void invalidate_direct_mem_ptr(sc_dt::uint64, sc_dt::uint64) override {}

    CycleScheduler* clock_ = nullptr;
    CycleProcess* unit_ = nullptr;
    StreamInput<Payload>* input_ = nullptr;
    bool direct_ = false;  // nothing is in between: the input is called without TLM
    std::uint64_t sent_ = 0;
    const Payload* on_offer_ = nullptr;
    Interposer interposer_;
    Wires wires_;
    Payload packed_{};
    bool delivering_ = false;                               // deliver() has not yet returned true for its item
    mutable const sc_core::sc_object* consumer_ = nullptr;  // looked up once: it is slow
};

/// Calls `each` with every output of a module.
template <class Each>
void for_each_output(const sc_core::sc_module& module, Each&& each) {
    for (sc_core::sc_object* child : module.get_child_objects()) {
        StreamItems::for_each([&](auto type) {
            if (auto* output = dynamic_cast<StreamOutput<typename decltype(type)::Item>*>(child))
                each(*output);
        });
    }
}

#define TESSERA_DECLARE_STREAM(Item) extern template class StreamOutput<Item>;  // see stream_instances.cpp
TESSERA_FOR_EACH_STREAM_ITEM(TESSERA_DECLARE_STREAM)
#undef TESSERA_DECLARE_STREAM

}  // namespace tessera
