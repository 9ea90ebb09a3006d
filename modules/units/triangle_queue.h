#pragma once
#include <cstddef>
#include <cstdint>
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/memory/memory_port.h"
#include "modules/stream/stream_input.h"
#include "modules/stream/stream_output.h"
#include "modules/timing.h"
#include "modules/unit/elastic_pipeline.h"
#include "modules/unit/level_history.h"
#include "modules/unit/unit.h"
#include "modules/units/triangle_queue_level.h"
#include "modules/units/triangle_store.h"

namespace tessera {

/// What a full queue does (timed mode).
enum class QueueOverflow {
    spill,  ///< to off-chip memory
    stall,  ///< holds Tessellation back: a deadlock when the whole pipeline is full
    error,  ///< ends the run
};

struct QueueDesign {
    TriangleOrder order = TriangleOrder::fifo;
    std::size_t watermark = 1;  ///< at least 1
    std::size_t capacity = 0;   ///< triangles on chip; 0: unbounded
    QueueOverflow overflow = QueueOverflow::spill;
    std::uint64_t off_chip_triangles = std::uint64_t{1} << 20;  ///< places in off-chip memory
};

/// Triangle Queue (paper figure 7): waiting triangles, first in first out (the paper's) or last in first out.
///
/// In:   triangles from Tessellation. Out: triangles to Get Triangle.
/// Capacity: `capacity` triangles on chip, unbounded by default and in functional mode; the high-water mark says what a
///       design needs. Beyond it a triangle goes to off-chip memory: first in first out, the newest, behind those that
///       are there; last in first out, the oldest on chip. They come back when there is room on chip (first in first
///       out), or when no more than half of it is taken (last in first out, so that one triangle does not go back and
///       forth).
/// Timing: one triangle in and one out per interval; latency 1, interval 1 by default, from store to output.
/// Waits for Tessellation, and for off-chip memory; held back by Get Triangle, and when full by off-chip memory.
class TriangleQueue : public Unit, public TriangleQueueLevel {
  public:
    StreamInput<datapath::Triangle> from_tessellation{"from_tessellation"};
    StreamOutput<datapath::Triangle> to_get_triangle{"to_get_triangle"};
    MemoryPort off_chip_memory;
    sc_core::sc_export<TriangleQueueLevel> level{"level"};

    TriangleQueue(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
                  const QueueDesign& design, const Timing& timing);

    bool takes_host_triangles() const override { return waiting() < design_.watermark; }
    const sc_core::sc_event& host_may_send() override {
        host_waits_ = true;
        return host_may_send_;
    }

    bool drained() const { return waiting() == 0 && !sending_; }
    /// Everywhere: on chip, off chip, and on its way.
    std::size_t waiting() const {
        return store_.size() + static_cast<std::size_t>(off_chip_) + refills_ + leaving_.size();
    }
    std::uint64_t taken() const { return taken_; }
    std::size_t high_water_mark() const { return high_water_mark_; }
    std::size_t on_chip_high_water_mark() const { return on_chip_high_water_mark_; }
    std::uint64_t spilled() const { return spilled_; }
    std::uint64_t refilled() const { return refilled_; }
    const LevelHistory& history() const { return history_; }
    LevelHistory& history() { return history_; }
    /// A triangle came that found no place, with QueueOverflow::error.
    bool overflowed() const { return overflowed_; }

    /// A triangle was to be spilled when all places in off-chip memory were taken.
    bool off_chip_memory_full() const { return off_chip_memory_full_; }

    std::string holds() const override;
    std::uint64_t occupied_cycles() const override { return taken_ * timing_.interval; }
    void show(Signals& signals) const override;

  private:
    void b_transport(datapath::Triangle& triangle, sc_core::sc_time& delay);
    void send_waiting();

    void step() override;
    void take_back();
    void refill();
    bool put(const datapath::Triangle& triangle);
    void spill(const datapath::Triangle& triangle);
    void level_changed(std::uint64_t cycle);
    bool on_chip_room() const { return design_.capacity == 0 || store_.size() + refills_ < design_.capacity; }
    std::uint64_t place_address(std::uint64_t place) const {
        return place % design_.off_chip_triangles * record_bytes_;
    }

    const datapath::Registers& registers_;
    QueueDesign design_;
    UnitTiming timing_;
    std::size_t record_bytes_;
    TriangleStore store_;
    ElasticPipeline<datapath::Triangle> leaving_;
    std::uint64_t next_in_ = 0;        // cycle from which a triangle may be taken
    std::uint64_t off_chip_ = 0;       // triangles in off-chip memory
    std::uint64_t off_chip_head_ = 0;  // place of the oldest
    std::size_t refills_ = 0;          // on their way back
    std::uint64_t spilled_ = 0;
    std::uint64_t refilled_ = 0;
    bool overflowed_ = false;
    bool off_chip_memory_full_ = false;
    LevelHistory history_;

    sc_core::sc_event arrival_{"arrival"};
    sc_core::sc_event host_may_send_{"host_may_send"};
    bool sending_ = false;
    bool host_waits_ = false;
    std::uint64_t taken_ = 0;
    std::size_t high_water_mark_ = 0;
    std::size_t on_chip_high_water_mark_ = 0;
};

}  // namespace tessera
