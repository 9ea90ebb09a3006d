#pragma once
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <systemc>
#include <utility>
#include <vector>

#include "modules/sockets/memory_port.h"
#include "modules/sockets/stream_input.h"
#include "modules/sockets/stream_output.h"
#include "modules/timing/cycle_scheduler.h"

/// Drivers, sinks and filled tables for testing a single unit.
namespace tessera::testing {

/// Offers items one after another, each when the previous one has been accepted and its own gap has passed.
template <class Payload>
class Driver : public sc_core::sc_module, public CycleProcess {
  public:
    StreamOutput<Payload> out{"out"};
    std::vector<Payload> items;
    std::vector<std::uint64_t> offered;  ///< the cycle of each

    Driver(const sc_core::sc_module_name& name, CycleScheduler& clock, const StallParameters& gaps = {})
        : sc_module(name), clock_(clock), gaps_(gaps, "gaps") {
        clock.attach(*this);
        out.clocked_by(clock, *this);
    }
    bool idle() const { return next_ == items.size() && out.free(); }

  private:
    void start_of_simulation() override { clock_.wake_at(*this, 0); }
    void step() override {
        while (next_ < items.size() && out.free()) {
            if (clock_.cycle() < not_before_) {
                clock_.wake_at(*this, not_before_);
                return;
            }
            offered.push_back(clock_.cycle());
            not_before_ = clock_.cycle() + gaps_.next();
            out.send(items[next_++]);
        }
    }

    CycleScheduler& clock_;
    RandomStalls gaps_;
    std::uint64_t not_before_ = 0;
    std::size_t next_ = 0;
};

/// Accepts items after the stalls of its channel and records the cycle (in timed mode).
template <class Payload>
class Sink : public sc_core::sc_module, public CycleProcess {
  public:
    StreamInput<Payload> in{"in"};
    std::vector<Payload> items;
    std::vector<std::uint64_t> cycles;
    std::vector<sc_core::sc_time> delays;  ///< functional mode: annotated delays on arrival

    Sink(const sc_core::sc_module_name& name, CycleScheduler& clock, const StallParameters& stalls = {})
        : sc_module(name), clock_(clock) {
        clock.attach(*this);
        in.template register_b_transport<&Sink::b_transport>(*this);
        in.clocked_by(clock, *this, 1, stalls);
    }

    /// Takes nothing before this cycle.
    void open_at(std::uint64_t cycle) { opening_ = cycle; }

  private:
    void b_transport(Payload& payload, sc_core::sc_time& delay) {
        items.push_back(payload);
        delays.push_back(delay);
    }
    void step() override {
        if (clock_.cycle() < opening_) {
            clock_.wake_at(*this, opening_);
            return;
        }
        while (!in.empty()) {
            items.push_back(in.front());
            cycles.push_back(clock_.cycle());
            in.pop();
        }
    }

    CycleScheduler& clock_;
    std::uint64_t opening_ = 0;
};

/// Calls a test's function when the clock calls it.
class Caller : public CycleProcess {
  public:
    explicit Caller(CycleScheduler& clock) { clock.attach(*this); }
    std::function<void()> on_step = [] {};

  private:
    void step() override { on_step(); }
};

/// A producer that can violate the protocol: the test drives its socket.
template <class Payload>
class BareInitiator : public sc_core::sc_module, public tlm::tlm_bw_transport_if<Stream<Payload>> {
  public:
    tlm::tlm_initiator_socket<32, Stream<Payload>> out{"out"};
    std::vector<std::pair<Payload*, sc_core::sc_time>> ended;  ///< END_REQs on the backward path

    explicit BareInitiator(const sc_core::sc_module_name& name) : sc_module(name) { out.bind(*this); }
    tlm::tlm_sync_enum offer(Payload& payload, tlm::tlm_phase& phase, sc_core::sc_time delay) {
        return out->nb_transport_fw(payload, phase, delay);
    }

  private:
    tlm::tlm_sync_enum nb_transport_bw(Payload& payload, tlm::tlm_phase& phase, sc_core::sc_time& delay) override {
        if (phase == tlm::END_REQ)
            ended.emplace_back(&payload, delay);
        return tlm::TLM_ACCEPTED;
    }
    void invalidate_direct_mem_ptr(sc_dt::uint64, sc_dt::uint64) override {}
};

/// A consumer whose responses are given by the test.
template <class Payload>
class BareTarget : public sc_core::sc_module, public tlm::tlm_fw_transport_if<Stream<Payload>> {
  public:
    tlm::tlm_target_socket<32, Stream<Payload>> in{"in"};
    tlm::tlm_sync_enum status = tlm::TLM_ACCEPTED;
    tlm::tlm_phase phase_back = tlm::BEGIN_REQ;

    explicit BareTarget(const sc_core::sc_module_name& name) : sc_module(name) { in.bind(*this); }
    tlm::tlm_sync_enum send_back(Payload& payload, tlm::tlm_phase phase, sc_core::sc_time delay) {
        return in->nb_transport_bw(payload, phase, delay);
    }

  private:
    tlm::tlm_sync_enum nb_transport_fw(Payload&, tlm::tlm_phase& phase, sc_core::sc_time&) override {
        phase = phase_back;
        return status;
    }
    void b_transport(Payload&, sc_core::sc_time&) override {}
    bool get_direct_mem_ptr(Payload&, tlm::tlm_dmi&) override { return false; }
    unsigned transport_dbg(Payload&) override { return 0; }
};

/// The message of the SC_ERROR raised by `action`; empty if none.
template <class Action>
std::string error_of(Action action) {
    try {
        action();
    } catch (const sc_core::sc_report& report) {
        return report.get_msg();
    }
    return {};
}

/// Writes a table's entries, row by row, bypassing the clock.
inline void fill_table(MemoryPort& port, const datapath::TableLayout& table,
                       const std::vector<std::uint64_t>& entries) {
    for (std::size_t k = 0; k < entries.size(); ++k) {
        std::vector<unsigned char> bytes;
        for (std::uint32_t byte = 0; byte < table.entry_bytes; ++byte)
            bytes.push_back(static_cast<unsigned char>(entries[k] >> (8 * byte)));
        MemoryRequest request{
            tlm::TLM_WRITE_COMMAND, 1, table.entry_bytes, {table.base + k * table.entry_bytes}, bytes.data()};
        REQUIRE(port.socket->transport_dbg(request) == bytes.size());
    }
}

}  // namespace tessera::testing
