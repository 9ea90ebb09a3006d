#include "testbench/commands/summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string_view>

#include "modules/datapath/pack_triangle.h"
#include "testbench/common/grouped_digits.h"
#include "testbench/machine/deciding_test.h"
#include "testbench/machine/totals.h"
#include "testbench/output/report/area.h"
#include "testbench/output/report/ratio.h"
#include "testbench/output/report/saturation_figures.h"
#include "testbench/output/report/timing_report.h"

namespace tessera {

namespace {

std::string row(const char* name, const std::string& value) {
    return fmt::format("  {:<26}{}\n", name, value);
}

std::string count(std::uint64_t value) {
    return grouped_digits(value);
}

double percent(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

/// A check's row, marked if it failed.
template <class Result>
std::string check_row(const char* name, const Result& result, bool passed, const std::string& value) {
    return row(name, (passed ? "" : "FAILED: ") + value + (result.empty() ? "; nothing was compared" : ""));
}
template <class Result>
std::string check_row(const char* name, const Result& result, const std::string& value) {
    return check_row(name, result, result.passed(), value);
}

std::string checks_rows(const Checks& checks) {
    std::string text;
    if (checks.setup)
        text += check_row("set-up", *checks.setup,
                          fmt::format("{} values of registers, base vertices and tables compared, {} wrong",
                                      count(checks.setup->compared()), count(checks.setup->wrong())));
    if (checks.conformance) {
        const ConformanceResult& c = *checks.conformance;
        std::string verdict;
        if (c.flips_percent() > checks.allowed_flips)
            verdict = fmt::format(", more than the {} % that check.allowed_flips allows", checks.allowed_flips);
        text += check_row("golden model", c, c.passed(checks.allowed_flips),
                          fmt::format("{} edges compared, {} mismatches, {} allowed flips ({:.3f} %){}", count(c.edges),
                                      count(c.mismatches), count(c.flipped_edges), c.flips_percent(), verdict));
    }
    if (checks.end_to_end) {
        const EndToEndResult& e = *checks.end_to_end;
        text += check_row(
            "golden mesh", e,
            e.bound_hit
                ? fmt::format("more than {} triangles; its run was stopped there", count(e.bound))
                : fmt::format("{} triangles ({:+.2f} %, allowed {}); {:.2f} % of the points farther apart than "
                              "rounding explains (allowed {:.3g} %), at most {:.3g} model units, RMS {:.3g} (allowed "
                              "{:.3g})",
                              count(e.golden_triangles), e.more_triangles(),
                              std::isinf(e.allowed.triangles) ? std::string("any, since values saturated")
                                                              : fmt::format("{} %", e.allowed.triangles),
                              e.farther(), e.allowed_farther(), e.max_model(), e.rms_model(), e.allowed_rms_model()));
        const double unseen = std::max(e.hardware_to_golden.unseen, e.golden_to_hardware.unseen);
        if (unseen > 0)
            text += row("", fmt::format("at {} of {} points; with {} % confidence at most {:.2g} % lie farther apart",
                                        count(e.hardware_to_golden.measured + e.golden_to_hardware.measured),
                                        count(e.hardware_to_golden.points + e.golden_to_hardware.points),
                                        100 * EndToEndResult::confidence, 100 * unseen));
    }
    if (checks.invariants) {
        const InvariantResult& i = *checks.invariants;
        const std::string wrong =
            (i.wrong_triangles() == 0 ? "" : fmt::format(", {} triangles wrong", count(i.wrong_triangles()))) +
            (i.unfinished == 0 ? "" : ", the bare datapath's recursion does not end");
        text += check_row("invariants", i,
                          fmt::format("{} cracks, {} T-vertices{}; in texture space {} collapsed, {} turned over",
                                      i.cracks, i.t_vertices, wrong, i.collapsed, i.turned_over));
        if (i.open_crease_edges > 0)
            text +=
                row("creases",
                    fmt::format(
                        "{} edges open: the two sides of the base mesh have different normals there; give it smooth "
                        "ones{}",
                        count(i.open_crease_edges),
                        i.open_crease_edges_of_seams == 0
                            ? std::string()
                            : fmt::format(" (at {} the texture coordinates differ too: there the map must be alike on "
                                          "both sides as well)",
                                          count(i.open_crease_edges_of_seams))));
        if (i.open_texture_seam_edges > 0)
            text +=
                row("texture seams",
                    fmt::format(
                        "{} edges open: the map, or a table made from it, is not continuous across a seam of "
                        "this mesh's texture coordinates; make it alike on both sides, or unwrap the mesh without a "
                        "seam there",
                        count(i.open_texture_seam_edges)));
    }
    if (checks.work)
        text += check_row(
            "work conservation", *checks.work,
            fmt::format("{} triangles and {} unit counts checked, {} violations", count(checks.work->triangles),
                        count(checks.work->equations), count(checks.work->violations)));
    if (checks.reads)
        text += check_row(
            "reads", *checks.reads,
            fmt::format("{} entries compared, {} wrong{}", count(checks.reads->entries), count(checks.reads->wrong),
                        checks.reads->missed == 0
                            ? ""
                            : fmt::format(", {} read but not compared", count(checks.reads->missed))));
    if (checks.bound)
        text += check_row("bound", *checks.bound, checks.bound->text());
    return text;
}

std::string height_test_text(const MachineSetup& setup) {
    return words_of(setup.registers.formats.height_test);
}

/// Repeated work, compared with the minimum for this mesh.
std::string work_rows(const Simulation& simulation, const MeshCounts& mesh) {
    const Totals totals(simulation);
    const std::uint64_t edges = totals.counts.edges_tested;
    const double tests = ratio(edges, mesh.tested_edges());
    const Decisions::Evaluated& evaluated = totals.evaluated;
    const bool all = evaluated.normal == edges && evaluated.summed_height == edges;
    return (all ? ""
                : row("tests evaluated",
                      fmt::format("normal {}, {} {}", count(evaluated.normal), height_test_text(simulation.setup),
                                  count(evaluated.summed_height)))) +
           row("distinct edges",
               fmt::format("{}, each tested {:.1f} times on average", count(mesh.tested_edges()), tests)) +
           row("distinct vertices",
               fmt::format("{}; {} computed, {} of them discarded, and {} normals transformed", count(mesh.vertices),
                           count(totals.positions), count(totals.thrown_away_vertices()), count(totals.normals)));
}

std::string timing_rows(const Simulation& simulation) {
    const Totals totals(simulation);
    const auto per = [&](std::uint64_t count) {
        const double cycles = ratio(simulation.cycles(), count);
        return fmt::format("{:.{}f}", cycles, cycles < 10 ? 2 : 1);
    };
    const double period = simulation.setup.design.timing.cycle_picoseconds * 1e-12;
    std::string text =
        row("cycles", fmt::format("{}: {} per finished triangle, {} per pass, {} per edge; {:.3g} ms at {:.4g} MHz",
                                  count(simulation.cycles()), per(totals.counts.finished), per(totals.counts.passes),
                                  per(totals.counts.edges_tested),
                                  static_cast<double>(simulation.cycles()) * period * 1e3, 1e-6 / period));
    text += row("bottleneck", bottleneck_text(simulation.last_machine().machine, simulation.cycles()));
    const UnitArea area = total_area(area_of(simulation));
    text +=
        row("hardware",
            fmt::format("{} multipliers ({} bits of partial products), {} bits of registers, {} bits of memory with "
                        "{} table ports{}",
                        count(area.multiplier_count()), count(area.partial_product_bits()), count(area.register_bits),
                        count(area.memory_bits), count(area.ports),
                        simulation.setup.design.queue.capacity == 0 ? "; the unbounded queue is not counted" : ""));
    std::uint64_t fetched = 0;
    std::string rates;
    for (std::size_t k = 0; k < simulation.machine.caches().size(); ++k) {
        std::uint64_t hits = 0, read = 0;
        for (const auto& hosted : simulation.machines) {
            const TableCache& cache = *hosted->machine.caches()[k];
            fetched += cache.bytes_fetched();
            hits += cache.hits();
            read += cache.entries_read();
        }
        rates += fmt::format(", {} {:.1f} %", simulation.machine.caches()[k]->basename(), percent(hits, read));
    }
    if (!rates.empty())
        text +=
            row("fetched", fmt::format("{} bytes of tables, {:.1f} per finished triangle; hits of {}", count(fetched),
                                       static_cast<double>(fetched) /
                                           static_cast<double>(std::max<std::uint64_t>(1, totals.counts.finished)),
                                       rates.substr(2)));
    if (totals.spilled > 0)
        text += row("spilled", fmt::format("{} triangles, at most {} on chip, with those on their way out",
                                           count(totals.spilled), count(totals.most_queued_on_chip)));
    return text;
}

}  // namespace

std::string found_text(const std::vector<FoundValue>& found) {
    std::string text;
    for (const FoundValue& it : found)
        text += row(it.key.c_str(), fmt::format("{} ({})", it.value, it.rule));
    return text;
}

std::string notes_text(const std::vector<std::string>& repairs, const std::vector<std::string>& remarks) {
    std::string text;
    for (const auto* const sentences : {&repairs, &remarks})
        for (const std::string& sentence : *sentences)
            text += fmt::format("  note: {}\n", sentence);
    return text;
}

std::string summary(const MachineSetup& setup, const Simulation& simulation, const MeshCounts& mesh,
                    const Checks& checks, double seconds) {
    const Totals totals(simulation);
    const DecidingUnit::Counts& counts = totals.counts;
    const Decisions::Counts& decided = totals.decided;
    const std::uint64_t edges = counts.edges_tested;
    const std::uint64_t table_reads = totals.height_table_reads;
    const bool sums = setup.registers.formats.height_test == datapath::HeightTest::summed_height;

    std::string text;
    text += row("triangles",
                fmt::format("{} base -> {} finished{}", count(setup.base_triangles.size()), count(counts.finished),
                            counts.culled > 0 ? fmt::format(", {} culled", count(counts.culled)) : ""));
    text += row("edges", fmt::format("{} tested, {} split ({:.1f} %)", count(edges), count(counts.edges_split),
                                     percent(counts.edges_split, edges)));
    text += row("  split by", fmt::format("normal alone {}, {} alone {}, both {}{}", count(decided.split_by_normal),
                                          height_test_text(setup), count(decided.split_by_summed_height),
                                          count(decided.split_by_both),
                                          setup.registers.tests.highlight_test
                                              ? fmt::format(", highlight alone {}", count(decided.split_by_highlight))
                                              : ""));
    text += row("  requested, stopped by",
                fmt::format("view alone {}, tex coord{} alone {}, generation alone {}, several {}",
                            count(decided.stopped_by_view_alone),
                            std::array{"", " (half texels)", " (quarter texels)"}.at(
                                static_cast<std::size_t>(setup.registers.formats.tex_coord_fraction)),
                            count(decided.stopped_by_tex_coord_alone), count(decided.stopped_by_generation_alone),
                            count(decided.stopped_by_several)));
    text += work_rows(simulation, mesh);
    text += row("triangle queue",
                fmt::format("at most {} triangles waiting, {} bits each{}", count(totals.most_queued),
                            datapath::packed_triangle_bits(setup.registers.formats), one_after_another(setup)));
    text += row(
        (height_test_text(setup) + " table").c_str(),
        fmt::format("{} bytes, {} bit entries{}; {} reads, {:.1f} per edge",
                    count(setup.registers.height_table.bytes()), datapath::height_entry_bits(setup.registers.formats),
                    setup.summed_height_bits_chosen && sums ? " (chosen)" : "", count(table_reads),
                    ratio(table_reads, edges)));
    const std::vector<SaturationFigure> saturations = saturation_figures(setup, totals.saturations);
    text += row("saturations", saturations_text(saturations));
    text += checks_rows(checks);
    const bool timed = setup.design.transport == Transport::non_blocking;
    if (timed)
        text += timing_rows(simulation);
    text += row(timed ? "timed mode" : "functional mode",
                fmt::format("simulated in {:.2f} s, {:.2f} million edges a second{}", seconds,
                            static_cast<double>(edges) / seconds / 1e6,
                            checks.conformance || checks.work || checks.reads ? ", with the checks of each edge" : ""));
    for (const std::string& warning : saturation_warnings(saturations))
        text += fmt::format("  warning: {}\n", warning);
    for (const std::string& warning : checks.warnings)
        text += fmt::format("  warning: {}\n", warning);
    for (const std::string& note : saturation_notes(saturations))
        text += fmt::format("  note: {}\n", note);
    return text + notes_text({}, setup.remarks);
}

}  // namespace tessera
