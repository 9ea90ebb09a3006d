#include "testbench/commands/widths_command.h"

#include <fmt/format.h>

#include <system_error>

#include "testbench/commands/progress.h"
#include "testbench/commands/run_files.h"
#include "testbench/commands/summary.h"
#include "testbench/common/atomic_file.h"
#include "testbench/common/atomic_set.h"
#include "testbench/explore/widths/widths_report.h"
#include "testbench/job/job_choices.h"
#include "testbench/job/nearest_name.h"
#include "testbench/job/read_job.h"
#include "testbench/machine/inputs.h"

namespace tessera {

namespace {

namespace fs = std::filesystem;

/// The two output files.
struct Output {
    fs::path folder, csv, json;
};

Output output_of(const WidthsOrder& order) {
    const fs::path wanted = order.output;
    Output output;
    if (wanted.extension() != ".csv") {
        output.folder = wanted;
        output.csv = wanted / "widths.csv";
        output.json = wanted / "widths.json";
        check_output_folder(output.folder, "--output");
        return output;
    }
    output.folder = folder_of(wanted);
    output.csv = wanted;
    output.json = fs::path(wanted).replace_extension(".json");
    check_folder_of(wanted, "--output");
    std::error_code error;
    for (const fs::path& file : {output.csv, output.json})
        if (fs::is_directory(file, error))
            throw InputError(fmt::format("--output {}: {} is a folder; name a file", wanted.string(), file.string()));
    return output;
}

const Quantity& quantity_named(const std::string& name) {
    if (const Quantity* const found = find_quantity(name))
        return *found;
    std::vector<std::string> names;
    std::string list;
    for (const Quantity& quantity : quantities()) {
        names.emplace_back(quantity.name);
        list += fmt::format("{}{}", list.empty() ? "" : ", ", quantity.name);
    }
    const std::string near = nearest_name(name, names);
    throw InputError(fmt::format("--quantity {}: must be one of {}{}", name, list,
                                 near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

SweptQuantity swept_quantity(const Quantity& quantity, const WidthsOrder& order, const Job& job) {
    if (!order.bits)
        return {&quantity, usual_widths(quantity, job.formats)};
    const auto [from, to] = *order.bits;
    if (to < quantity.least || from > quantity.most)
        throw InputError(
            fmt::format("--bits {}..{}: {} has {} to {} bits", from, to, quantity.name, quantity.least, quantity.most));
    SweptQuantity swept{&quantity, {}};
    for (std::int64_t bits = to; bits >= from; --bits)
        swept.widths.push_back(bits);
    return swept;
}

WidthRequest request_of(const WidthsOrder& order, const fs::path& data_folder) {
    WidthRequest request;
    request.job = load_job(order.job_file, order.settings, data_folder);
    if (request.job.frames.count > 1)
        throw InputError(
            fmt::format("frames.count = {}: widths are swept for one frame; use --set frames.count=1, and --set "
                        "displacement.scale for the frame",
                        request.job.frames.count));
    // The exact model has the Summed Height Test and the map's own heights only.
    if (request.job.tests.summed_height && request.job.hardware.height_test != HeightTest::summed_height)
        throw InputError(
            fmt::format("hardware.height_test = \"{}\": widths compares with exact arithmetic, which is there for the "
                        "Summed Height Test only; use --set hardware.height_test=summed_height, or without a height "
                        "test --set tests.summed_height=false",
                        name_of(request.job.hardware.height_test)));
    if (request.job.map.heights == MapHeights::fitted)
        throw InputError(
            "map.heights = \"fitted\": widths compares with the map's own heights; use --set map.heights=given");
    request.threads = order.jobs;
    request.most_flips = order.most_flips;
    request.most_error = order.most_error;
    if (order.quantities.empty()) {
        for (const Quantity& quantity : quantities())
            request.swept.push_back(swept_quantity(quantity, order, request.job));
        return request;
    }
    for (const std::string& name : order.quantities) {
        const Quantity& quantity = quantity_named(name);
        for (const SweptQuantity& before : request.swept)
            if (before.quantity == &quantity)
                throw InputError(fmt::format("--quantity {}: is named twice", name));
        request.swept.push_back(swept_quantity(quantity, order, request.job));
    }
    return request;
}

/// The first design whose checks failed; empty if none.
std::string first_failure(const WidthSweep& sweep) {
    for (const WidthTable& table : sweep.tables)
        for (const WidthRow& row : table.rows)
            if (row.refused.empty() && (row.run.conformance.mismatches > 0 || !row.run.invariants.passed()))
                return fmt::format("{}, {} bits: {} mismatches with the golden model, {} invariants violated\n{}",
                                   table.swept.quantity->name, row.bits, row.run.conformance.mismatches,
                                   row.run.invariants.violations(),
                                   row.run.conformance.mismatches > 0 ? row.run.conformance.first_mismatch
                                                                      : row.run.invariants.first_violation);
    return {};
}

/// If every width of every quantity was refused, the reason for the widest; else empty.
std::string all_refused(const WidthSweep& sweep) {
    for (const WidthTable& table : sweep.tables)
        for (const WidthRow& row : table.rows)
            if (row.refused.empty())
                return {};
    const WidthTable& first = sweep.tables.front();
    return fmt::format("every width was refused, {} of {} bits because: {}", first.swept.quantity->name,
                       first.rows.front().bits, first.rows.front().refused);
}

}  // namespace

ExitCode widths_command(const WidthsOrder& order, const fs::path& data_folder) {
    WidthRequest request = request_of(order, data_folder);
    const Output output = output_of(order);
    require_inputs_kept(order.output, {output.csv, output.json}, order.job_file, request.job);

    Progress progress;
    progress.show("reading mesh and map", 0);
    const auto [mesh, map, resolved] = load_inputs(request.job);
    request.job = resolved.job;
    const WidthSweep sweep =
        sweep_widths(request, mesh, map, [&](const std::string& what, double part) { progress.show(what, part); });
    progress.clear();

    AtomicSet files;
    files.make_folder(output.folder, "--output");
    write_file(output.csv, widths_csv(sweep));
    write_file(output.json, widths_json(request, sweep));
    files.commit();
    fmt::print("{}\n  written in {} and {}\n{}", widths_text(request, sweep), output.csv.string(), output.json.string(),
               notes_text(repairs_of(mesh, map), make_setup(request.job, mesh, map).remarks));
    const std::string failure = first_failure(sweep);
    const std::string refusal = all_refused(sweep);
    if (failure.empty() && refusal.empty())
        return ExitCode::fine;
    std::fflush(stdout);
    fmt::print(stderr, "tessera: {}\n", failure.empty() ? refusal : failure);
    return failure.empty() ? ExitCode::bad_input : ExitCode::check_failed;
}

}  // namespace tessera
