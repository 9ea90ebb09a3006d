#include "testbench/explore/widths/width_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "modules/datapath/widths.h"
#include "testbench/common/error.h"
#include "testbench/common/parallel.h"
#include "testbench/job/validate_job.h"

namespace tessera {

namespace {

/// Default limits for the knee, relative to the widest width.
constexpr double flips_above_widest = 0.5;  // percent of the edges
constexpr double error_above_widest = 1.25;

std::string one_line(std::string text) {
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at))
        text.replace(at, 1, "; ");
    return text;
}

void measure(const Job& job, const BaseMesh& mesh, const HeightMap& map, const ExactModel& exact, WidthRow& row) {
    validate(job);
    const MachineSetup setup = make_setup(job, mesh, map);
    row.run = run_widths(setup, exact, static_cast<std::uint64_t>(job.limits.triangles));
    row.saturations = saturation_figures(setup, row.run.saturations);
    for (const SaturationFigure& figure : row.saturations)
        row.saturated += figure.count;
    const datapath::Widths widths = datapath::stream_widths(setup.registers.formats);
    row.base_vertex_bits = widths.base_vertex;
    row.queue_entry_bits = widths.triangle;
    row.displacement_map_bytes = setup.registers.displacement_map.bytes();
    row.normal_map_bytes = setup.registers.normal_map.bytes();
    row.summed_height_table_bytes = setup.registers.height_table.bytes();
}

WidthRow make_row(const Quantity& quantity, std::int64_t bits, const Job& job, const BaseMesh& mesh,
                  const HeightMap& map, const ExactModel& exact) {
    WidthRow row;
    Job changed = job;
    const std::string refusal = quantity.set(changed.formats, bits);
    row.bits = bits;
    row.fraction = quantity.fraction(changed.formats);
    row.of_the_job = bits == quantity.bits(job.formats);
    if (row.of_the_job)
        changed = job;
    if (!refusal.empty())
        row.fraction = 0;
    if (!refusal.empty() && refusal != by_the_job) {
        row.refused = refusal;
        return row;
    }
    try {
        measure(changed, mesh, map, exact, row);
    } catch (const InputError& error) {
        row.refused = one_line(error.what());
    } catch (const ResourceError& error) {
        row.refused = one_line(error.what());
    }
    return row;
}

WidthKnee find_knee(const WidthRequest& request, const std::vector<WidthRow>& rows) {
    WidthKnee knee;
    knee.flips_given = request.most_flips.has_value();
    knee.error_given = request.most_error.has_value();
    knee.most_local = request.job.check.allowed_flips;
    const auto widest = std::find_if(rows.begin(), rows.end(), [](const WidthRow& row) { return row.refused.empty(); });
    if (widest == rows.end())
        return knee;
    knee.most_flips = request.most_flips.value_or(widest->run.split_flips_percent() + flips_above_widest);
    knee.most_error = request.most_error.value_or(widest->run.position_rms * error_above_widest);
    for (auto row = widest; row != rows.end(); ++row) {
        if (!row->refused.empty() || row->run.split_flips_percent() > knee.most_flips ||
            row->run.position_rms > knee.most_error || !row->run.conformance.passed(knee.most_local) ||
            !row->run.invariants.passed())
            break;
        knee.row = static_cast<std::size_t>(row - rows.begin());
    }
    return knee;
}

const WidthRow* first_made(const WidthSweep& sweep) {
    for (const WidthTable& table : sweep.tables)
        for (const WidthRow& row : table.rows)
            if (row.refused.empty())
                return &row;
    return nullptr;
}

}  // namespace

WidthSweep sweep_widths(const WidthRequest& request, const BaseMesh& mesh, const HeightMap& map,
                        const std::function<void(const std::string&, double)>& on_progress) {
    struct Task {
        std::size_t table, row;
    };
    const ExactModel exact(request.job, mesh, map);
    WidthSweep result;
    std::vector<Task> tasks;
    for (const SweptQuantity& swept : request.swept) {
        for (std::size_t k = 0; k < swept.widths.size(); ++k)
            tasks.push_back({result.tables.size(), k});
        result.tables.push_back({swept, std::vector<WidthRow>(swept.widths.size()), {}});
    }
    result.exact_triangles = exact.triangles(4 * static_cast<std::uint64_t>(request.job.limits.triangles));

    std::size_t done = 0;
    std::mutex mutex;
    parallel_for(tasks.size(), request.threads, [&](std::size_t k) {
        WidthTable& table = result.tables[tasks[k].table];
        const Quantity& quantity = *table.swept.quantity;
        const std::int64_t bits = table.swept.widths[tasks[k].row];
        table.rows[tasks[k].row] = make_row(quantity, bits, request.job, mesh, map, exact);
        const std::lock_guard<std::mutex> lock(mutex);
        on_progress(fmt::format("{}, {} bits", quantity.name, bits),
                    static_cast<double>(++done) / static_cast<double>(tasks.size()));
    });
    for (WidthTable& table : result.tables)
        table.knee = find_knee(request, table.rows);
    if (const WidthRow* const first = first_made(result))
        result.texel_borders = texel_borders_warning(first->run.texel_borders, request.job, map.width, map.height);
    return result;
}

}  // namespace tessera
