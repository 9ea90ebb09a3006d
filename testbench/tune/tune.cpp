#include "testbench/tune/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>
#include <utility>

#include "testbench/common/error.h"
#include "testbench/common/parallel.h"
#include "testbench/input/mesh/obj_reader.h"
#include "testbench/machine/inputs.h"
#include "testbench/tune/rank_search.h"
#include "testbench/tune/refinement_forest.h"
#include "testbench/tune/texel_error.h"
#include "testbench/tune/tuned_figures.h"

namespace tessera {

namespace {

constexpr std::size_t most_refined = 3;

/// One base mesh, prepared: all its evaluations share the setup.
struct Ground {
    Job job;
    MachineSetup setup;
    TexelError errors;

    Ground(const TuneRequest& request, const BaseChoice& base, const HeightMap& map)
        : job(job_with_base(request.job, base, request.goal)),
          setup(make_setup(job, base_mesh_of(job, base, map), map)),
          errors(setup, map, DisplacementOf::from(job, map)) {}
};

/// The result of exploring one base mesh.
struct Explored {
    ThresholdSearch::Found found;
    std::size_t base_triangles = 0;
    Outcome finest;          // all thresholds searched at 0; incomplete if it has more triangles than the budget
    bool too_large = false;  // the base mesh alone
};

/// Combines the progress of several threads.
class SharedProgress {
  public:
    SharedProgress(std::size_t parts, const std::function<void(const std::string&, double)>& show)
        : parts_(parts, 0.0), show_(show) {}

    void set(std::size_t part, double done, const std::string& what, double from, double to) {
        const std::lock_guard<std::mutex> lock(mutex_);
        parts_[part] = done;
        const double all = std::accumulate(parts_.begin(), parts_.end(), 0.0);
        show_(what, from + (to - from) * all / static_cast<double>(parts_.size()));
    }

  private:
    std::mutex mutex_;
    std::vector<double> parts_;
    const std::function<void(const std::string&, double)>& show_;
};

/// What makes the base mesh coarser, in parentheses.
const char* density_of(const TuneRequest& request) {
    if (request.bases.front().kind != BaseChoice::Kind::job)
        return " (--grid)";
    switch (request.job.mesh.source) {
        case MeshSource::plane:
        case MeshSource::cylinder:
        case MeshSource::sphere: return " (mesh.columns, mesh.rows)";
        case MeshSource::lattice: return " (mesh.spacing)";
        case MeshSource::file:
        case MeshSource::run: break;
    }
    return "";
}

[[noreturn]] void refuse_budget(const TuneRequest& request, const std::vector<Explored>& explored) {
    std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
    for (const Explored& e : explored)
        least = std::min<std::uint64_t>(least, e.base_triangles);
    if (least > request.goal.triangles)
        throw InputError(fmt::format(
            "--triangles {}: the base mesh has {} triangles before any is split: use at least that many, or a "
            "coarser base mesh{}",
            request.goal.triangles, least, density_of(request)));
    throw InputError(
        fmt::format("--triangles {}: with the job's other tests the mesh has more at any of the "
                    "thresholds searched: search more of them (--tests), or change the others under [tests]",
                    request.goal.triangles));
}

void refuse_beyond_finest(const TuneRequest& request, const std::vector<Explored>& explored, const HeightMap& map) {
    std::uint64_t most = 0;
    const auto [low, high] = map.extremes();
    for (const Explored& e : explored) {
        if (e.too_large || !e.finest.complete || e.finest.triangles == request.goal.triangles)
            return;
        most = std::max(most, e.finest.triangles);
    }
    throw InputError(fmt::format(
        "--triangles {}: with every threshold at 0 there are {}, the most possible: {}; use at most {}",
        request.goal.triangles, most,
        low == high || request.job.displacement.scale == 0
            ? "the map has no relief, so that no edge requests a split"
            : fmt::format("the Tex Coord Test (the map's resolution), tests.generation_limit = {} or a test "
                          "that is not searched stops every edge",
                          request.job.tests.generation_limit),
        most));
}

/// To the six digits that are printed, not below the value.
double rounded_up(double value) {
    const double step = std::pow(10.0, std::floor(std::log10(value)) - 5);
    return (std::floor(value / step) + 1) * step;
}

[[noreturn]] void refuse_error(const TuneRequest& request, const std::vector<Explored>& explored, double unit,
                               const std::string& unit_name) {
    const Outcome* least = nullptr;
    for (const Explored& e : explored)
        if (e.found.least_error &&
            (least == nullptr || request.goal.error_of(*e.found.least_error) < request.goal.error_of(*least)))
            least = &*e.found.least_error;
    if (least == nullptr)
        throw InputError(
            fmt::format("--error {:.6g}: no mesh has at most {} triangles, and larger ones are not searched: use a "
                        "coarser base mesh, or raise limits.triangles",
                        request.goal.error / unit, request.goal.most_triangles));
    throw InputError(
        fmt::format("--error {:.6g}: the least {} error found is {:.6g} {}, with {} triangles: allow "
                    "at least that",
                    request.goal.error / unit, request.goal.largest ? "largest" : "RMS",
                    rounded_up(request.goal.error_of(*least) / unit), unit_name, least->triangles));
}

}  // namespace

Job job_with_base(const Job& job, const BaseChoice& base, const TuneGoal& goal) {
    Job result = base.ranks ? RankSearch::job_for(job, goal) : job;
    if (base.kind == BaseChoice::Kind::job)
        return result;
    const bool lattice = base.kind == BaseChoice::Kind::lattice;
    result.mesh.source = base.ranks ? MeshSource::lattice : lattice ? MeshSource::file : MeshSource::plane;
    result.mesh.spacing = base.ranks ? base.spacing : job.mesh.spacing;
    result.mesh.file.clear();
    result.mesh.path.clear();
    result.mesh.fingerprint.clear();
    result.mesh.columns = lattice ? 0 : base.columns;
    result.mesh.rows = lattice ? 0 : base.rows;
    return result;
}

BaseMesh base_mesh_of(const Job& job, const BaseChoice& base, const HeightMap& map) {
    if (base.kind == BaseChoice::Kind::lattice && !base.ranks)
        return parse_obj(lattice_obj(base, job.mesh, map.width, map.height), "lattice");
    return load_mesh(job);
}

TuneResult tune(const TuneRequest& request, const HeightMap& map,
                const std::function<void(const std::string&, double)>& on_progress) {
    const TuneGoal& goal = request.goal;
    const std::size_t bases = request.bases.size();
    std::vector<Explored> explored(bases);
    SharedProgress exploring(bases, on_progress);
    parallel_for(bases, request.threads, [&](std::size_t k) {
        Explored& e = explored[k];
        Ground ground(request, request.bases[k], map);
        e.base_triangles = ground.setup.base_triangles.size();
        e.too_large = goal.triangles > 0 && e.base_triangles > goal.triangles;
        if (e.too_large)
            return;
        if (request.bases[k].ranks) {
            RankSearch search(ground.setup, ground.job, ground.errors, goal);
            if (goal.triangles > 0)
                e.finest = search.outcome(0, goal.triangles, false);
            e.found = search.search();
            return;
        }
        RefinementForest forest(ground.setup, &ground.errors);
        ThresholdSearch search(forest, ground.setup, ground.job, goal, request.space, [&](double done) {
            exploring.set(k, done, fmt::format("exploring {} base meshes", bases), 0, 0.5);
        });
        const datapath::Triangulation triangulation = ground.setup.registers.triangulation;
        if (goal.triangles > 0)
            e.finest = forest.count(search.finest(), triangulation, goal.triangles);
        search.explore();
        e.found = search.found();
    });
    if (goal.triangles > 0)
        refuse_beyond_finest(request, explored, map);

    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < bases; ++k)
        if (explored[k].found.best)
            order.push_back(k);
    if (order.empty()) {
        if (goal.triangles > 0)
            refuse_budget(request, explored);
        const Job job = job_with_base(request.job, request.bases.front(), goal);
        const ErrorUnit unit = error_unit(job, base_mesh_of(job, request.bases.front(), map), map);
        refuse_error(request, explored, unit.model_units, unit.map_units ? "map units" : "model units");
    }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return better(explored[a].found.best->point, explored[b].found.best->point, goal);
    });
    order.resize(std::min(order.size(), most_refined));
    SharedProgress refining(order.size(), on_progress);
    std::vector<ThresholdSearch::Found> refined(order.size());
    parallel_for(order.size(), request.threads, [&](std::size_t k) {
        refined[k] = explored[order[k]].found;
        if (request.bases[order[k]].ranks)
            return;
        Ground ground(request, request.bases[order[k]], map);
        RefinementForest forest(ground.setup, &ground.errors);
        ThresholdSearch search(forest, ground.setup, ground.job, goal, request.space, [&](double done) {
            refining.set(k, done, fmt::format("refining the best {}", order.size()), 0.5, 1);
        });
        search.start_from(refined[k]);
        search.refine();
        refined[k] = search.found();
    });
    for (std::size_t k = 0; k < order.size(); ++k)
        explored[order[k]].found = std::move(refined[k]);

    TuneResult result;
    for (std::size_t k = 0; k < bases; ++k) {
        for (const ThresholdSearch::Candidate& candidate : explored[k].found.tried)
            result.tried.push_back({k, candidate.point});
        result.evaluations += explored[k].found.evaluations;
    }
    result.base = order.front();
    for (const std::size_t k : order)
        if (better(explored[k].found.best->point, explored[result.base].found.best->point, goal))
            result.base = k;
    result.point = explored[result.base].found.best->point;
    const BaseChoice& base = request.bases[result.base];
    result.job = job_with_base(request.job, base, goal);
    result.job.tests = result.point.tests;
    result.job.hardware.triangulation = result.point.triangulation;
    if (base.kind == BaseChoice::Kind::lattice && !base.ranks)
        result.base_obj = lattice_obj(base, request.job.mesh, map.width, map.height);
    return result;
}

}  // namespace tessera
