#pragma once
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

/// A pass of a triangle through a clocked machine, in the order in which Get Triangle begins them.
struct RecordedPass {
    Facts facts;
    std::uint32_t base = 0;  ///< the base triangle that it descends from

    bool is_base() const { return (facts.parts & vertex_parts) != 0; }
};

/// Records what the cycles of a machine's passes depend on.
class PassRecord {
  public:
    enum class Reader { displace_vertex, height_test, normal_test };

    /// Makes an item of that unit known, and the banks of its reads. memories: by the unit's ports.
    void read(Reader reader, const PartTag& tag, const Reads& reads, const std::vector<BankOfEntry>& memories);

    /// Records the decisions from now on.
    void observe(HostedMachine& machine);

    /// After the run.
    std::vector<RecordedPass> passes();

  private:
    RecordedPass& pass(std::uint32_t number);

    struct Decisions : tlm::tlm_analysis_if<datapath::TrianglePass> {
        explicit Decisions(PassRecord& record) : record_(record) {}
        void write(const datapath::TrianglePass& pass) override;
        PassRecord& record_;
    };
    struct Finished : tlm::tlm_analysis_if<datapath::Triangle> {
        explicit Finished(PassRecord& record) : record_(record) {}
        void write(const datapath::Triangle& triangle) override;
        PassRecord& record_;
    };

    std::vector<RecordedPass> passes_;
    std::vector<Way> finished_;  // in order
    bool culls_ = false;
    Decisions decisions_{*this};
    Finished finishes_{*this};
};

/// Makes units of modules/ that record what they read, for each machine.
class RecordedUnits : public UnitFactory {
  public:
    std::unique_ptr<DisplaceVertex> displace_vertex(Name name, const UnitContext& context) override;
    std::unique_ptr<HeightTestUnit> height_test(Name name, const UnitContext& context) override;
    std::unique_ptr<NormalTest> normal_test(Name name, const UnitContext& context, Parts takes) override;

    PassRecord& of(const CycleScheduler& clock) { return records_[&clock]; }

  private:
    std::map<const CycleScheduler*, PassRecord> records_;
};

}  // namespace tessera::schedule
