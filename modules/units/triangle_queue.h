#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <systemc>
#include <vector>

#include "modules/sockets/items.h"
#include "modules/sockets/memory_port.h"
#include "modules/sockets/stream_input.h"
#include "modules/sockets/stream_output.h"
#include "modules/stage/unit.h"
#include "modules/timing/elastic_pipeline.h"
#include "modules/timing/level_history.h"
#include "modules/units/triangle_store.h"

namespace tessera {

/// Triangle Queue (paper figure 7): waiting triangles, first in first out (the paper's) or last in first out.
///
/// In:   triangles from Tessellation, in the family design from Pass or Tessellate. Out: triangles to Get Triangle, and
///       whether fewer triangles than the watermark wait, whenever that changes: one bit, which Get Triangle receives in
///       the same cycle and stores.
/// Capacity: `capacity` triangles on chip, unbounded by default and in functional mode; the high-water mark shows what
///       a design needs. Beyond it triangles spill to off-chip memory: the newest (first in first out), or the oldest
///       on chip (last in first out). They return when there is room on chip (first in first out; until none is left,
///       later triangles go off chip, too, which keeps the order), or when at most half of it is in use (last in first
///       out, so that a triangle does not go back and forth).
/// Timing: one triangle in and one out per interval; the latency is from store to output.
/// Waits for that unit, and for off-chip memory; held back by Get Triangle, and when full by off-chip memory.
class TriangleQueue : public Unit {
  public:
    StreamInput<datapath::Triangle> from_tessellation{"from_tessellation"};
    StreamOutput<datapath::Triangle> to_get_triangle{"to_get_triangle"};
    MemoryPort off_chip_memory;
    StreamOutput<QueueLevel> level{"level"};

    TriangleQueue(const sc_core::sc_module_name& name, const UnitContext& context);

    bool below_watermark() const { return waiting() < design_.watermark; }

    bool drained() const { return waiting() == 0 && !sending_; }
    /// Functional mode: notified when the last waiting triangle has gone through the machine.
    const sc_core::sc_event& emptied() const { return emptied_; }
    /// Triangles on chip, off chip, and in transit.
    std::size_t waiting() const {
        return store_.size() + static_cast<std::size_t>(off_chip_) + refills_ + leaving_.size();
    }
    std::uint64_t taken() const { return taken_; }
    std::size_t high_water_mark() const { return high_water_mark_; }
    /// Of those in its places, at most the capacity, and those leaving.
    std::size_t on_chip_high_water_mark() const { return on_chip_high_water_mark_; }
    std::uint64_t spilled() const { return spilled_; }
    std::uint64_t refilled() const { return refilled_; }
    LevelHistory& history() { return history_; }
    /// With QueueOverflow::error: there was no place for a triangle.
    bool overflowed() const { return overflowed_; }

    /// Off-chip memory is not the machine's: a triangle that comes back changed is an SC_ERROR.
    void check_off_chip_memory() { checks_off_chip_memory_ = true; }
    /// A triangle had to be spilled while off-chip memory was full.
    bool off_chip_memory_full() const { return off_chip_memory_full_; }

    std::string describe_contents() const override;
    std::uint64_t occupied_cycles() const override { return taken_ * timing_.interval; }
    void trace_signals(Signals& signals) const override;

  private:
    void b_transport(datapath::Triangle& triangle, sc_core::sc_time& delay);
    void send_waiting();
    void tell_level(sc_core::sc_time& delay);

    void step() override;
    void take_back();
    void refill();
    bool put(const datapath::Triangle& triangle);
    void spill(const datapath::Triangle& triangle);
    void level_changed(std::uint64_t cycle);
    std::uint32_t checksum(const unsigned char* record) const;
    void check_returned();
    bool on_chip_room() const { return design_.capacity == 0 || store_.size() + refills_ < design_.capacity; }
    std::uint64_t place_address(std::uint64_t place) const {
        return place % design_.off_chip_triangles * record_bytes_;
    }

    const datapath::Registers& registers_;
    QueueDesign design_;
    UnitTiming timing_;
    sc_core::sc_time latency_;
    std::size_t record_bytes_;
    TriangleStore store_;
    ElasticPipeline<datapath::Triangle> leaving_;
    std::uint64_t next_in_ = 0;        // cycle from which a triangle may be accepted
    std::uint64_t off_chip_ = 0;       // triangles in off-chip memory
    std::uint64_t off_chip_head_ = 0;  // place of the oldest
    std::size_t refills_ = 0;          // triangles on their way back
    std::uint64_t spilled_ = 0;
    std::uint64_t refilled_ = 0;
    bool checks_off_chip_memory_ = false;
    std::vector<std::uint32_t> checksums_;  // of the triangles off chip, by place
    std::deque<std::uint64_t> returning_;   // checksums of those on their way back
    bool overflowed_ = false;
    bool off_chip_memory_full_ = false;
    LevelHistory history_;

    sc_core::sc_event arrival_{"arrival"};
    sc_core::sc_event emptied_{"emptied"};
    bool sending_ = false;
    QueueLevel told_;
    std::uint64_t taken_ = 0;
    std::size_t high_water_mark_ = 0;
    std::size_t on_chip_high_water_mark_ = 0;
};

}  // namespace tessera
