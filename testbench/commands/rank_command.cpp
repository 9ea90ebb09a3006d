#include "testbench/commands/rank_command.h"

#include <fmt/format.h>

#include "testbench/commands/progress.h"
#include "testbench/commands/run_files.h"
#include "testbench/commands/summary.h"
#include "testbench/common/atomic_file.h"
#include "testbench/common/atomic_set.h"
#include "testbench/job/read_job.h"
#include "testbench/machine/inputs.h"
#include "testbench/tune/rank_curve.h"

namespace tessera {

namespace fs = std::filesystem;

ExitCode rank_command(const RankOrder& order, const fs::path& data_folder) {
    Job job = load_job(order.job_file, order.settings, data_folder);
    RankSearch::refuse_view(job);
    job.hardware.height_test = HeightTest::rank;
    job.hardware.triangulation = Triangulation::greatest_rank;
    job.tests.summed_height = true;
    job.map.heights = MapHeights::given;  // fitted heights would suit one mesh, and there are many
    if (order.output.empty())
        throw InputError("--output is empty: name a folder");
    const fs::path folder = order.output;
    check_output_folder(folder, "--output");
    const fs::path bytes = folder / "rank_table.bin", json = folder / "rank_table.json",
                   csv = folder / "thresholds.csv";
    require_inputs_kept(order.output, {bytes, json, csv}, order.job_file, job);

    Progress progress;
    progress.show("reading mesh and map", 0);
    const Inputs inputs = load_inputs(job);
    job = inputs.resolved.job;
    progress.show("making the table", 0.05);
    MachineSetup setup = make_setup(job, inputs.mesh, inputs.map);
    const TexelError errors(setup, inputs.map, DisplacementOf::from(job, inputs.map));
    const std::vector<RankPoint> curve =
        rank_curve(setup, job, errors, static_cast<std::uint64_t>(job.limits.triangles),
                   [&](double part) { progress.show("measuring meshes", 0.1 + 0.9 * part); });
    progress.clear();

    const ErrorUnit unit = error_unit(job, inputs.mesh, inputs.map);
    const datapath::TableLayout& layout = setup.registers.height_table;
    AtomicSet files;
    files.make_folder(folder, "--output");
    write_file(bytes, rank_table_bytes(setup));
    write_file(json, rank_table_json(setup, unit));
    write_file(csv, rank_curve_csv(curve, unit));
    files.commit();
    fmt::print("tessera rank: {} x {} entries of {} bits in {} bytes each, {} base triangles\n{}", layout.columns,
               layout.rows, setup.registers.formats.rank_bits + setup.registers.formats.bound_bits, layout.entry_bytes,
               setup.base_triangles.size(), rank_curve_text(curve, unit));
    fmt::print("{}", notes_text(repairs_of(inputs.mesh, inputs.map), setup.remarks));
    fmt::print("  written: {}, {}, {}\n", bytes.string(), json.string(), csv.string());
    return ExitCode::fine;
}

}  // namespace tessera
