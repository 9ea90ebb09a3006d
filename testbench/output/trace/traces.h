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

/// The units whose signals output.trace_units selects: those whose name contains one of its words, or all if it is
/// empty. Throws InputError on a word that no name contains.
std::vector<const Unit*> units_to_trace(const std::string& words, const Machine& machine);

/// The waveforms requested by a job, trace.vcd, written into the run's folder during the simulation; the file gets its
/// name only when complete (AtomicFile, AtomicSet). Without finish() nothing remains.
class Traces {
  public:
    /// Construct before the simulation runs. The folder must exist.
    Traces(const Job& job, const std::filesystem::path& folder, Simulation& simulation,
           const std::vector<const Unit*>& units);
    ~Traces();

    /// Throws the error of writing, as AtomicFile does, that stopped the simulation.
    void check() const;

    /// Call after the simulation has ended, for whatever reason. Throws like check().
    void finish();

    /// For the summary: the file and its cycles.
    std::string text() const;

  private:
    struct Files;
    std::unique_ptr<Files> files_;
    Simulation& simulation_;
    TraceWindow window_;
};

/// Converts trace.vcd, which is in the set of files, to trace.fst and adds it. Returns an error message for the user;
/// empty on success.
std::string make_fst(const std::filesystem::path& folder, AtomicSet& files);

}  // namespace tessera
