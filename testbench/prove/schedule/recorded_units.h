#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <tlm>
#include <vector>

#include "modules/memories/interleave.h"
#include "modules/unit_factory.h"
#include "testbench/machine/hosted_machine.h"
#include "testbench/prove/schedule/facts.h"

namespace tessera::schedule {

/// A pass of a triangle through a clocked machine: about 1 KB.
struct RecordedPass {
    Facts facts;
    std::uint64_t triangle = 0;               ///< hash of its base triangle and its corners
    std::array<std::uint64_t, 4> children{};  ///< of each child, in the order in which Tessellation sends them

    bool is_base() const { return (facts.parts & vertex_parts) != 0; }
};

/// Records what the cycles of a machine's passes depend on.
class PassRecord {
  public:
    enum class Reader { displace_vertex, height_test, normal_test };

    /// Records an item of that unit and the banks that it reads. memories: those that the unit reads, in the order of its
    /// ports.
    void read(Reader reader, const PartTag& tag, const Reads& reads, const std::vector<BankOfEntry>& memories);

    /// Records the decisions from now on.
    void observe(HostedMachine& hosted);

    /// After the run: in the order in which Get Triangle began them. Leaves the record empty.
    std::vector<RecordedPass> take_passes();

  private:
    RecordedPass& pass(std::uint32_t number);

    struct Decisions : tlm::tlm_analysis_if<datapath::TrianglePass> {
        explicit Decisions(PassRecord& its_record) : record(its_record) {}
        void write(const datapath::TrianglePass& pass) override;
        PassRecord& record;
    };
    struct Finished : tlm::tlm_analysis_if<datapath::Triangle> {
        explicit Finished(PassRecord& its_record) : record(its_record) {}
        void write(const datapath::Triangle& triangle) override;
        PassRecord& record;
    };

    std::vector<RecordedPass> passes_;
    struct End {
        Way way = Way::dropped;
        std::uint64_t triangle = 0;
    };
    std::vector<End> finished_;  // in order
    const datapath::Registers* registers_ = nullptr;
    Decisions decisions_{*this};
    Finished finishes_{*this};
};

/// Makes units that record their reads, separately for each machine.
class RecordedUnits : public UnitFactory {
  public:
    RecordedUnits();

    /// The record of the machine with this clock.
    PassRecord& of(const CycleScheduler& clock) { return records_[&clock]; }

  private:
    std::map<const CycleScheduler*, PassRecord> records_;
};

}  // namespace tessera::schedule
