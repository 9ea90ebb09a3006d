#include "testbench/prove/engines/engine_run.h"

#include <fmt/core.h>

#include <cstdint>
#include <exception>
#include <memory>
#include <sstream>
#include <vector>

#include "testbench/check/transport/conservation.h"
#include "testbench/common/child_process.h"
#include "testbench/common/hash.h"
#include "testbench/machine/simulation.h"
#include "testbench/output/report/mesh_counts.h"
#include "testbench/output/report/statistics.h"
#include "testbench/output/report/timing_report.h"

namespace tessera {

namespace {

constexpr std::uint64_t most_triangles = 20'000'000, most_cycles_without_progress = 1'000'000;

/// Digests of the cycles in which items entered and left a unit.
class ItemTimes : public ActivityObserver, public schedule::ItemObserver {
  public:
    void stretch(State, const sc_core::sc_object*, std::uint64_t, std::uint64_t) override {}
    void item(std::uint64_t cycle, bool came) override {
        std::uint64_t& digest = came ? came_ : left_;
        digest = mix_hash(digest, cycle);
    }
    std::string text() const { return fmt::format("{:016x} {:016x}", came_, left_); }

  private:
    std::uint64_t came_ = 0, left_ = 0;
};

/// Hash of one machine's triangles in their order; the order between machines differs, and no result depends on it.
std::uint64_t digest_of(const EmittedMesh& mesh, std::size_t machine, std::size_t machines) {
    std::uint64_t digest = 0;
    for (const EmittedTriangle& triangle : mesh.triangles) {
        if (triangle.base % machines != machine)
            continue;
        digest = mix_hash(digest, triangle.base);
        for (const auto& corner : triangle.corners)
            digest = mix_hash(digest, hash_of(corner));
    }
    return digest;
}

std::string run(const Job& job, const BaseMesh& mesh, const HeightMap& map, bool scheduled) {
    MachineSetup setup = make_setup(job, mesh, map);
    setup.scheduled = scheduled;
    Simulation simulation(setup, most_triangles, most_cycles_without_progress);
    std::vector<std::pair<const Unit*, std::unique_ptr<ItemTimes>>> times;
    for (const auto& machine : simulation.machines) {
        for (Unit* unit : machine->pipeline.units()) {
            times.emplace_back(unit, std::make_unique<ItemTimes>());
            if (scheduled)
                machine->conductor->observe(*unit, times.back().second.get());
            else
                unit->activity().observe(times.back().second.get());
        }
    }
    std::string text = simulation.run();
    for (const Conservation& equation : conservation(simulation))
        text += fmt::format("{}: {}, {}\n", equation.name, equation.left, equation.right);
    for (std::size_t k = 0; k < setup.machines; ++k)
        text += fmt::format("mesh {:016x}\n", digest_of(simulation.monitor.mesh, k, setup.machines));
    for (const auto& [unit, its] : times)
        text += fmt::format("items of {}: {}\n", unit->name(), its->text());
    text += statistics_csv(collect_statistics(setup, simulation, count_mesh(simulation.monitor.mesh)));
    text += timing_text(simulation);
    for (const auto& machine : simulation.machines)
        text += queue_levels_csv(machine->pipeline.triangle_queue.history());
    return text;
}

}  // namespace

std::string engine_run(const Job& job, const BaseMesh& mesh, const HeightMap& map, bool scheduled) {
    const ChildEnd end = run_in_child([&]() -> std::string {
        try {
            return run(job, mesh, map, scheduled);
        } catch (const std::exception& error) {
            return error.what();
        }
    });
    return end.told + end.failure;
}

std::string first_difference(const std::string& clocked, const std::string& scheduled) {
    std::istringstream left(clocked), right(scheduled);
    std::string a, b;
    while (true) {
        const bool more_left = static_cast<bool>(std::getline(left, a)),
                   more_right = static_cast<bool>(std::getline(right, b));
        if (!more_left && !more_right)
            return {};
        if (more_left != more_right || a != b)
            return fmt::format("clocked:  {}\nschedule: {}", more_left ? a : "", more_right ? b : "");
    }
}

}  // namespace tessera
