#include "testbench/commands/tune_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string_view>

#include "modules/datapath/height_tests.h"
#include "testbench/commands/option_values.h"
#include "testbench/commands/progress.h"
#include "testbench/commands/run_files.h"
#include "testbench/commands/summary.h"
#include "testbench/common/atomic_file.h"
#include "testbench/common/atomic_set.h"
#include "testbench/job/dump_job.h"
#include "testbench/job/job_choices.h"
#include "testbench/job/job_paths.h"
#include "testbench/job/read_job.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/fingerprint.h"
#include "testbench/machine/inputs.h"
#include "testbench/machine/simulation.h"
#include "testbench/setup/height_tests/height_test_host.h"
#include "testbench/tune/rank_search.h"
#include "testbench/tune/tune.h"
#include "testbench/tune/tune_report.h"

namespace tessera {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t largest_base_for_error = 2048;
constexpr int most_rounds = 20;

/// The tests searched: the paper's, a Rank or Bound Test, or one after the other.
struct Searched {
    bool paper = true, ranks = false;
};

void add_own_base(const Searched& tests, std::vector<BaseChoice>& bases) {
    if (tests.paper)
        bases.emplace_back();
    if (tests.ranks)
        bases.emplace_back().ranks = true;
}

void add_grid(const std::string& grid, const TuneRequest& request, const Searched& tests, const HeightMap& map,
              std::vector<BaseChoice>& bases) {
    const auto refuse = [&](const std::string& why) { throw InputError(fmt::format("--grid {}: {}", grid, why)); };
    if (request.job.mesh.source != MeshSource::plane && request.job.mesh.source != MeshSource::lattice)
        refuse("applies to a plane (mesh.source = \"plane\" or \"lattice\") only; omit --grid");
    const auto add = [&](const std::vector<BaseChoice>& more) { bases.insert(bases.end(), more.begin(), more.end()); };
    const auto most = std::numeric_limits<std::uint64_t>::max();
    if (grid == "auto") {
        add_own_base(tests, bases);
        const std::uint64_t largest = request.goal.triangles > 0
                                          ? std::max<std::uint64_t>(2, request.goal.triangles / 10 * 9)
                                          : largest_base_for_error;
        if (tests.paper)
            add(usual_bases(request.job.mesh, map.width, map.height, largest));
        if (tests.ranks)
            add(rank_lattices(request.job, map.width, map.height, largest));
        return;
    }
    const std::string lattice = "lattice";
    if (grid.rfind(lattice, 0) == 0) {
        const std::int64_t spacing = parse_number(grid.substr(lattice.size()));
        if (spacing < 1 || (spacing & (spacing - 1)) != 0 || spacing > std::min(map.width, map.height))
            refuse(fmt::format("a lattice's spacing is a power of two of at most {} texels, as in lattice32",
                               std::min(map.width, map.height)));
        for (const bool alternate : {false, true})
            if (tests.paper)
                bases.push_back(lattice_choice(spacing, alternate, map.width, map.height));
        std::vector<BaseChoice> choices = rank_lattices(request.job, map.width, map.height, most);
        choices.erase(std::remove_if(choices.begin(), choices.end(),
                                     [&](const BaseChoice& choice) { return choice.spacing != spacing; }),
                      choices.end());
        if (tests.ranks && choices.empty())
            refuse(
                "a lattice for ranks has a spacing of 2 to 128 texels, which divides the width of a map that repeats");
        if (tests.ranks)
            add(choices);
        return;
    }
    const std::size_t x = grid.find('x');
    BaseChoice plane;
    plane.kind = BaseChoice::Kind::plane;
    if (x != std::string::npos) {
        plane.columns = parse_number(grid.substr(0, x));
        plane.rows = parse_number(grid.substr(x + 1));
    }
    if (plane.columns < 1 || plane.rows < 1)
        refuse("expected auto, COLUMNSxROWS as in 16x22, or latticeSPACING as in lattice32");
    if (!tests.paper)
        refuse("ranks need a lattice: auto, or latticeSPACING as in lattice32");
    bases.push_back(plane);
}

Searched choose_tests(const TuneOrder& order, TuneRequest& request) {
    Job::Tests& tests = request.job.tests;
    Job::Hardware& hardware = request.job.hardware;
    const auto listed = [&](std::string_view name) {
        return std::find(order.tests.begin(), order.tests.end(), name) != order.tests.end();
    };
    const bool by_job = order.tests.empty();
    Searched searched;
    searched.ranks = by_job ? hardware.height_test == HeightTest::rank : listed("rank");
    std::optional<HeightTest> of_heights;
    for (std::size_t k = 0; k < datapath::height_tests().size(); ++k) {
        const auto test = static_cast<HeightTest>(k);
        if (host_of(test).searched() == nullptr || !listed(name_of(test)))
            continue;
        if (of_heights)
            throw InputError(fmt::format("--tests: {} and {} exclude each other; tune with one of them",
                                         name_of(*of_heights), name_of(test)));
        of_heights = test;
    }
    searched.paper = by_job ? !searched.ranks : listed("normal") || of_heights || listed("view");
    if (hardware.height_test == HeightTest::rank) {
        hardware.height_test = HeightTest::summed_height;
        hardware.triangulation = Job::Hardware{}.triangulation;
    }
    hardware.height_test = of_heights.value_or(hardware.height_test);
    if (tests.summed_height && host_of(hardware.height_test).searched() == nullptr)
        throw InputError(
            fmt::format("hardware.height_test = \"{}\" has no threshold to search: name others with --tests, "
                        "such as --tests {}",
                        name_of(hardware.height_test), searched_height_tests().front()));
    request.space = order.vary;
    request.space.normal = by_job ? tests.normal : listed("normal");
    request.space.summed_height = by_job ? tests.summed_height : of_heights.has_value();
    request.space.view = by_job ? tests.view : listed("view");
    // searching a test's threshold enables the test
    tests.normal = tests.normal || request.space.normal;
    tests.summed_height = tests.summed_height || request.space.summed_height;
    tests.view = tests.view || request.space.view;
    if (searched.paper && !tests.normal && !tests.summed_height)
        throw InputError(
            "tests.normal and tests.summed_height are both off: no edge is ever split; switch one on, or "
            "name it "
            "with --tests");
    if (!tests.generation && !tests.tex_coord)
        throw InputError(
            "tests.generation and tests.tex_coord are both off: low thresholds would split without end; "
            "switch "
            "one on");
    if (tests.highlight)
        throw InputError(
            "tests.highlight = true: the search does not consider highlights; tune with --set "
            "tests.highlight=false and set it in the tuned job, which then has more triangles");
    if (request.job.map.heights == MapHeights::fitted)
        throw InputError(std::string("map.heights = \"fitted\" suits one mesh: tune with --set map.heights=given") +
                         (order.largest ? "; in the tuned job, too, since fitted heights keep no largest error"
                                        : " and set it in the tuned job"));
    if (request.job.hardware.culling != Culling::none)
        throw InputError(
            "hardware.culling = \"back\": culled triangles cannot be measured; tune with --set "
            "hardware.culling=none and set it in the tuned job");
    if (searched.ranks)
        RankSearch::refuse_view(request.job);
    return searched;
}

TuneRequest request_of(const TuneOrder& order, const fs::path& data_folder, Searched& searched) {
    TuneRequest request;
    request.job = load_job(order.job_file, order.settings, data_folder);
    record_fingerprints(request.job);  // the figures hold for these files
    request.threads = order.jobs;
    searched = choose_tests(order, request);
    request.goal.triangles = order.triangles;
    request.goal.largest = order.largest;
    request.goal.most_triangles =
        std::min(most_tuned_triangles, static_cast<std::uint64_t>(request.job.limits.triangles));
    if (order.triangles > request.goal.most_triangles)
        throw InputError(fmt::format("--triangles {}: at most {} can be tuned for (2^22 and limits.triangles)",
                                     order.triangles, request.goal.most_triangles));
    return request;
}

/// Checks before the search that a file can be written after it.
void check_output(const std::string& option, const fs::path& file) {
    check_folder_of(file, option);
    std::error_code error;
    if (fs::is_directory(file, error))
        throw InputError(fmt::format("{} {}: is a folder; name a file", option, file.string()));
}

std::string own_run_folder(const fs::path& job_file) {
    return (fs::path("runs") / job_file.stem()).generic_string();
}

/// No output may overwrite an input, another output, or an OBJ file not written by tessera tune.
void check_places(const TuneOrder& order, const Job& job, const std::vector<fs::path>& written,
                  const fs::path& obj_file) {
    require_inputs_kept(order.output, written, order.job_file, job);
    for (std::size_t k = 0; k < written.size(); ++k)
        for (std::size_t other = 0; other < k; ++other)
            if (place_of_name(written[k]) == place_of_name(written[other]))
                throw InputError(
                    fmt::format("--tried {}: the tuned job's files include this name; choose another", order.tried));
    std::ifstream mesh(obj_file);
    std::string first;
    if (!order.grids.empty() && std::getline(mesh, first) && first.rfind("# tessera tune:", 0) != 0)
        throw InputError(
            fmt::format("--output {}: a lattice would overwrite {}, which tessera tune did not write; choose "
                        "another name",
                        order.output, obj_file.string()));
    Job tuned = job;
    tuned.output.folder = own_run_folder(order.output);
    require_inputs_stay(tuned);
}

/// The job to be written: its lattice is beside it, and it has a run folder of its own.
Job finished_job(const TuneResult& result, const fs::path& job_file, const fs::path& obj_file) {
    Job job = result.job;
    if (!result.base_obj.empty()) {
        job.mesh.file = rebase_path(obj_file.filename().string(), job_file.parent_path(), job.folder);
        job.mesh.fingerprint = fingerprint_of_bytes(result.base_obj);
    }
    job.output.folder = own_run_folder(job_file);
    return job;
}

}  // namespace

ExitCode tune_command(const TuneOrder& order, const fs::path& data_folder) {
    Searched searched;
    TuneRequest request = request_of(order, data_folder, searched);
    const fs::path job_file = order.output;
    const auto beside = [&](const char* extension) { return fs::path(job_file).replace_extension(extension); };
    const fs::path json_file = beside(".json"), obj_file = beside(".obj");
    if (job_file.extension() != ".toml")
        throw InputError(
            fmt::format("--output {}: the tuned job's name must end in .toml, as in tuned.toml (figures and "
                        "a lattice are written beside it as .json and .obj)",
                        job_file.string()));
    check_output("--output", job_file);
    if (!order.tried.empty())
        check_output("--tried", order.tried);
    std::vector<fs::path> written{job_file, json_file, obj_file};
    if (!order.tried.empty())
        written.emplace_back(order.tried);
    check_places(order, request.job, written, obj_file);

    Progress progress;
    progress.show("reading mesh and map", 0);
    const Inputs inputs = load_inputs(request.job);
    const HeightMap& map = inputs.map;
    request.job = inputs.resolved.job;
    if (order.grids.empty())
        add_own_base(searched, request.bases);
    for (const std::string& grid : order.grids)
        add_grid(grid, request, searched, map, request.bases);

    // The search's error and the measured one differ by rounding; the bound applies to the measured one.
    TuneResult result;
    TunedFigures figures;
    ErrorUnit unit;
    double bound = 0;
    for (int round = 0; round < most_rounds; ++round) {
        if (order.error > 0 && round == 0) {
            const Job job = job_with_base(request.job, request.bases.front(), request.goal);
            unit = error_unit(job, base_mesh_of(job, request.bases.front(), map), map);
            bound = order.error * unit.model_units;
            request.goal.error = bound;
        }
        result = tune(request, map, [&](const std::string& what, double part) { progress.show(what, 0.95 * part); });
        const BaseMesh base = base_mesh_of(result.job, request.bases[result.base], map);
        unit = error_unit(result.job, base, map);
        const MachineSetup setup = make_setup(result.job, base, map);
        EmittedMesh mesh;
        BareRecursion(setup).run(mesh);
        mesh.sort();
        progress.show("measuring", 0.95);
        figures = measure_tuned(result.job, base, map, setup, mesh);
        const double measured = request.goal.largest ? figures.max_model : figures.rms_model;
        if (order.error == 0 || !unit.height_field || measured <= bound)
            break;
        // Excludes this mesh from the next round.
        request.goal.error = std::min(bound, request.goal.error_of(result.point.outcome)) * (1 - 1e-9);
        if (round + 1 == most_rounds)
            throw InputError(
                fmt::format("--error {}: the meshes found exceed it by rounding only, the last with {:.17g}: "
                            "give a slightly larger error",
                            order.error, measured / unit.model_units));
    }

    // The reported figures are those of functional mode's mesh, from the job to be written.
    progress.show("functional mode", 0.98);
    const Job job = finished_job(result, job_file, obj_file);
    Job functional = job;
    functional.mode = Mode::functional;
    const BaseMesh base = base_mesh_of(job, request.bases[result.base], map);
    const MachineSetup setup = make_setup(functional, base, map);
    Simulation simulation(setup, static_cast<std::uint64_t>(job.limits.triangles));
    if (const std::string stuck = simulation.run(); !stuck.empty())
        throw std::runtime_error("functional mode did not finish: " + stuck);
    EmittedMesh& mesh = simulation.monitor.mesh;
    mesh.sort();
    const std::uint64_t expected = figures.triangles;
    figures = measure_tuned(job, base, map, setup, mesh);
    if (figures.triangles != expected || figures.triangles != result.point.outcome.triangles)
        throw std::runtime_error(fmt::format(
            "functional mode's mesh has {} triangles, the search's {}: this is a bug in {}", figures.triangles,
            result.point.outcome.triangles,
            is_added(job.hardware.height_test)
                ? fmt::format("the height test {}, whose decide() depends on more than the edge, its entries "
                              "and the registers, or in tessera tune",
                              name_of(job.hardware.height_test))
                : "tessera tune"));
    progress.clear();

    request.goal.error = bound;  // as requested
    std::string names = job_file.string() + ", " + json_file.string();
    AtomicSet files;
    if (!order.tried.empty()) {
        write_file(order.tried, tried_csv(request, result, unit));
        names += ", " + order.tried;
    }
    if (!result.base_obj.empty()) {
        write_file(obj_file, result.base_obj);
        names += ", " + obj_file.string();
    }
    write_file(json_file, tune_json(request, result, figures, unit));
    write_file(job_file, tune_comment(request, result, figures, unit) + dump_job(job, job_file.parent_path()));
    files.commit();
    fmt::print("{}  {:<24}{}\n{}", tune_text(request, result, figures, unit), "written", names,
               notes_text(repairs_of(base, map), setup.remarks));
    return ExitCode::fine;
}

}  // namespace tessera
