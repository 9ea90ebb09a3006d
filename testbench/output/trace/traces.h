#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "testbench/common/atomic_set.h"
#include "testbench/job/job.h"
#include "testbench/machine/simulation.h"
#include "testbench/output/trace/trace_window.h"

namespace tessera {

/// The units whose signals output.trace_units asks for: those whose name contains one of its words; all if there is
/// none. Throws InputError on a word that no name contains.
std::vector<const Unit*> units_to_trace(const std::string& words, const Pipeline& pipeline);

/// The traces a job requests, trace.vcd and timeline.json, written into the run's folder while the simulation runs;
/// they get their names only when complete (AtomicFile, AtomicSet). Without finish() nothing remains.
class Traces {
  public:
    static bool wanted(const Job& job) { return job.output.vcd || job.output.timeline; }

    /// Before the simulation runs. The folder must exist.
    Traces(const Job& job, const std::filesystem::path& folder, Simulation& simulation,
           const std::vector<const Unit*>& units);
    ~Traces();

    /// Throws what went wrong in writing, as AtomicFile does; the simulation was stopped by it.
    void check() const;

    /// After the simulation has ended, however it did. Throws like check().
    void finish();

    /// For the summary: what was written, and of which cycles. One line each.
    std::vector<std::string> text() const;

  private:
    struct Files;
    std::unique_ptr<Files> files_;
    Simulation& simulation_;
    TraceWindow window_;
};

/// Makes trace.fst of trace.vcd, which is in the set of files, and adds it. Returns what went wrong, in words for the
/// user; empty: nothing.
std::string make_fst(const std::filesystem::path& folder, AtomicSet& files);

}  // namespace tessera
