#pragma once
#include <memory>
#include <string>
#include <vector>

#include "modules/unit_factory.h"
#include "testbench/check/transport/read_check.h"
#include "testbench/prove/faults/fault_trigger.h"

namespace tessera {

/// Puts the fault that a job asks for, and the read checks, between the units while the machine is built. To be made
/// before the simulation, in one scope with it: what stands between the units is part of the machine.
class CheckedUnits : public UnitFactory {
  public:
    CheckedUnits(const Job& job, const datapath::Formats& formats, int tag_bits);
    ~CheckedUnits() override;

    /// Neither a fault nor read checks are asked for: the machine is to be wired straight.
    static bool wanted(const Job& job) { return job.fault.kind != FaultKind::none || job.check.reads; }

    void made(sc_core::sc_module& module) override;
    void join(MemoryPort& port, TableMemory& memory) override;
    void join(MemoryPort& port, OffChipMemory& memory) override;

    /// To be called when the machine is built. Throws InputError if the fault's place is none that its kind
    /// can strike in the job's mode; names all that there are.
    void require_placed() const;

    /// From now on the fault does not come.
    void disarm() { trigger_.disarm(); }

    const FaultTrigger& trigger() const { return trigger_; }
    const std::vector<std::unique_ptr<ReadCheck>>& read_checks() const { return read_checks_; }

  private:
    template <class Payload>
    void interpose(StreamOutput<Payload>& output);
    bool is_place(const std::string& name, bool applies);
    void join_memory(MemoryPort& port, MemoryServer& memory, bool check_reads);

    Job::Fault fault_;
    datapath::Formats formats_;
    int tag_bits_;
    bool timed_;
    bool check_reads_;
    FaultTrigger trigger_;
    bool placed_ = false;
    bool lacks_cycles_ = false;  // at a memory of functional mode, which answers in one call
    std::vector<std::string> places_;
    std::vector<std::unique_ptr<sc_core::sc_module>> faults_;
    std::vector<std::unique_ptr<ReadCheck>> read_checks_;
};

/// Whether a kind strikes streams, or memories; with and without cycles.
bool strikes_streams(FaultKind kind);
bool strikes_memories(FaultKind kind);

}  // namespace tessera
