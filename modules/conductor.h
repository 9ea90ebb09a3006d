#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <systemc>
#include <utility>
#include <vector>

#include "modules/host.h"
#include "modules/memories/interleave.h"
#include "modules/pipeline.h"
#include "modules/rasteriser.h"
#include "modules/schedule/timetable.h"

namespace tessera {

/// Times a machine in functional mode by its schedule (modules/schedule/README.md): asks the schedule for the triangle
/// that Get Triangle begins next, sends it from the host or the Triangle Queue through the machine, and passes to the
/// schedule the facts on which its timing depends. At the end of a run the units have the statistics of timed mode.
class Conductor : public sc_core::sc_module {
  public:
    /// The key of a job file whose value has no schedule; empty if the design has a schedule.
    static std::string key_without_schedule(const Design& design, const datapath::Formats& formats);

    /// machine: built from a conducted design, in functional mode; `timed`: the same design for timed mode.
    Conductor(const sc_core::sc_module_name& name, Pipeline& machine, Host& host, const Rasteriser& rasteriser,
              const Design& timed);

    /// The last cycle in which anything happened so far.
    std::uint64_t last_cycle() const { return schedule_->last(); }
    /// observer: null for none.
    void observe(const Unit& unit, schedule::ItemObserver* observer);
    /// Gives the units their statistics, for a run of `cycles` cycles.
    void finish(std::uint64_t cycles);

  private:
    /// Converts a unit's reads into the banks of the entries. Each item reads one of the unit's memories.
    class ReadFacts : public ReadObserver {
      public:
        using Parts = schedule::Facts::Reads;
        ReadFacts(Parts& parts, std::vector<BankOfEntry> memories) : parts_(parts), memories_(std::move(memories)) {}
        void read(unsigned part, const Reads& reads) override;

      private:
        Parts& parts_;
        std::vector<BankOfEntry> memories_;  // by the unit's ports
    };

    static schedule::Plan plan_of(Pipeline& machine, const Rasteriser& rasteriser, const Design& timed);
    void conduct();
    void send(const schedule::Source::Next& next);

    Pipeline& machine_;
    Host& host_;
    std::unique_ptr<schedule::Timetable> schedule_;
    schedule::Facts facts_;
    ReadFacts vertices_, heights_, normals_;
    std::vector<Unit*> units_;                          // by the schedule's numbers; null: the rasteriser, or absent
    std::vector<const sc_core::sc_object*> consumers_;  // the same, with the rasteriser
};

}  // namespace tessera
