#include "testbench/commands/compare_run.h"

#include <fmt/core.h>

#include "testbench/commands/progress.h"
#include "testbench/common/atomic_file.h"
#include "testbench/common/atomic_set.h"
#include "testbench/compare/measure_error.h"
#include "testbench/machine/inputs.h"
#include "testbench/output/report/error_report.h"
#include "testbench/output/report/figures_text.h"
#include "testbench/run_folder/read_run.h"

namespace tessera {

ExitCode compare_run(const std::filesystem::path& run_folder, const std::filesystem::path& data_folder) {
    Progress progress;
    progress.show("reading the run", 0);
    const RecordedRun run = read_run(run_folder, data_folder);
    const BaseMesh base = load_mesh(run.job);
    const HeightMap map = load_map(run.job);
    MeasureLimits limits;
    limits.progress = [&](double part) { progress.show("measuring distances", 0.1 + 0.9 * part); };
    const ErrorView view(run.job.camera);
    limits.view = &view;
    const MeshError error = measure_error(base, map, DisplacementOf::from(run.job, map), run.mesh, limits);
    progress.clear();

    const std::vector<Figure> figures = error_figures(run.job, run.mesh, error);
    AtomicSet files;
    write_file(run.folder / "error.json", statistics_json(figures));
    files.commit();
    fmt::print("{}\n  error.json in {}\n", figures_text(figures),
               std::filesystem::absolute(run.folder).lexically_normal().string());
    return ExitCode::fine;
}

}  // namespace tessera
