#include "testbench/job/validate_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "modules/datapath/format.h"
#include "modules/timing/design_keys.h"
#include "modules/timing/design_rules.h"
#include "testbench/job/job_choices.h"
#include "testbench/job/job_keys.h"
#include "testbench/job/toml_text.h"
#include "testbench/setup/check_settings.h"
#include "testbench/setup/faults.h"

namespace tessera {

namespace {

void check_ranges(const Job& job, Faults& faults) {
    for (const KeyTable& table : job_tables()) {
        for (const Key& key : table.keys) {
            const std::string fault = complaint(key, key.get(job));
            faults.unless(fault.empty(), "{}", fault);
        }
    }
}

void check_file(const std::string& table, bool wanted, const std::string& file, std::string_view source,
                Faults& faults) {
    faults.unless(!wanted || !file.empty(),
                  "`{0}.file` is empty, but `{0}.source` = \"{1}\": name the {2}, or choose "
                  "a built-in source",
                  table, source, source == name_of(MeshSource::run) ? "folder of a run" : "file");
    faults.unless(wanted || file.empty(),
                  "`{0}.file` = {1}, but `{0}.source` = \"{2}\" reads no file: set "
                  "{0}.source = \"file\", or {0}.file = \"\"",
                  table, printable(toml_string(file)), source);
}

void check_fingerprint(const std::string& table, const std::string& fingerprint, const std::string& file,
                       Faults& faults) {
    const bool is_one =
        fingerprint.size() == 16 && fingerprint.find_first_not_of("0123456789abcdef") == std::string::npos;
    faults.unless(fingerprint.empty() || is_one,
                  "`{}.fingerprint` = {}: expected 16 hexadecimal digits (0-9, a-f), as a run writes them into "
                  "its job.toml, or \"\"",
                  table, printable(toml_string(fingerprint)));
    faults.unless(fingerprint.empty() || !file.empty(),
                  "`{0}.fingerprint` = {1}, but `{0}.file` is empty: name the file, or set {0}.fingerprint = \"\"",
                  table, printable(toml_string(fingerprint)));
}

void check_mesh(const Job::Mesh& mesh, Faults& faults) {
    check_file("mesh", reads_file(mesh.source), mesh.file, name_of(mesh.source), faults);
    check_fingerprint("mesh", mesh.fingerprint, mesh.file, faults);
    faults.unless((mesh.spacing & (mesh.spacing - 1)) == 0,
                  "`mesh.spacing` = {}: a lattice needs a power of two, so that midpoints are at texel centres: set "
                  "mesh.spacing = {}",
                  mesh.spacing,
                  std::int64_t{1} << (datapath::bits_for(
                                          static_cast<std::uint64_t>(std::max<std::int64_t>(mesh.spacing, 0)) + 1) -
                                      1));
    const bool round = mesh.source == MeshSource::cylinder || mesh.source == MeshSource::sphere;
    faults.unless(!round || mesh.columns == 0 || mesh.columns >= 3,
                  "`mesh.columns` = {}, but a {} needs 3 or more to close: set mesh.columns = 3 or more", mesh.columns,
                  name_of(mesh.source));
    faults.unless(mesh.source != MeshSource::sphere || mesh.rows != 1,
                  "`mesh.rows` = {}, but a sphere needs 2 or more: set mesh.rows = 2 or more", mesh.rows);
}

void check_map(const Job& job, Faults& faults) {
    const Job::Map& map = job.map;
    check_file("map", map.source == MapSource::file, map.file, name_of(map.source), faults);
    check_fingerprint("map", map.fingerprint, map.file, faults);
    faults.unless(map.source != MapSource::text || !map.text.empty(),
                  "`map.text` is empty, but `map.source` = \"text\": set map.text");
    if (map.source != MapSource::file) {
        const std::int64_t most = std::int64_t{1} << job.formats.texture_integer;
        faults.unless(map.width <= most && map.height <= most,
                      "`map.width` = {} by `map.height` = {}, but `formats.texture_integer` = {} addresses at most {} "
                      "texels a side: set formats.texture_integer = {}, or map.width and map.height to at most {}",
                      map.width, map.height, job.formats.texture_integer, most,
                      datapath::bits_for(static_cast<std::uint64_t>(std::max(map.width, map.height))), most);
    }
}

/// Fitted heights belong to whole texels under vertices, and do not suit sums.
void check_heights(const Job& job, Faults& faults) {
    if (job.map.heights == MapHeights::given)
        return;
    faults.unless(
        job.hardware.displacement_filter == MapFilter::nearest,
        "`map.heights` = \"fitted\", but `hardware.displacement_filter` = \"{}\" interpolates between texels: set "
        "hardware.displacement_filter = \"nearest\"",
        name_of(job.hardware.displacement_filter));
    faults.unless(
        !job.hardware.one_texel_from_map || job.hardware.height_test != HeightTest::summed_height,
        "`map.heights` = \"fitted\", but with `hardware.one_texel_from_map` = true the Summed Height Test uses "
        "fitted heights instead of the map's: set hardware.one_texel_from_map = false");
}

void check_light(const Job::Hardware& hardware, Faults& faults) {
    faults.unless(hardware.light != std::array<double, 3>{},
                  "`hardware.light` = {} has no direction: set one, such as [0, 0, 1]", toml_value(hardware.light));
}

void check_rank_view(const Job& job, Faults& faults) {
    faults.unless(job.tests.rank_view == RankView::none || (job.hardware.height_test == HeightTest::rank &&
                                                            job.hardware.test_order == TestOrder::cheap_first),
                  "`tests.rank_view` = \"{}\" needs ranks, and distances that the View Test computes first: set "
                  "hardware.height_test = \"rank\" and hardware.test_order = \"cheap_first\"",
                  name_of(job.tests.rank_view));
}

void check_hardware(const Job::Hardware& hardware, Faults& faults) {
    faults.unless(hardware.triangulation != Triangulation::greatest_rank || hardware.height_test == HeightTest::rank,
                  "`hardware.triangulation` = \"greatest_rank\", but `hardware.height_test` = \"{}\" has no ranks: set "
                  "hardware.height_test = \"rank\"",
                  name_of(hardware.height_test));
}

/// What Machine refuses as well.
void check_design(const Job& job, Faults& faults) {
    const auto key_of = [](const std::string& member) -> const Key& {
        const std::string leaf = DesignName(member).key;
        const Key* const key = find_key("hardware." + leaf);
        return key != nullptr ? *key : *find_key("timing." + leaf);
    };
    for (const DesignRule* const rule : broken_rules(job.hardware, job.timing)) {
        const Key& broken = key_of(rule->member);
        const std::vector<DesignSetting> to = rule->remedy(job.hardware, job.timing);
        const std::string first = key_of(to.front().member).name, last = key_of(to.back().member).name;
        faults.unless(false, "`{}` = {}: {}: {}", broken.name, toml_value(broken.get(job)), rule->why,
                      to.size() == 1
                          ? fmt::format("set {} = {}", first, to.front().value)
                          : fmt::format("set {} = {} and {} = {}", first, to.front().value, last, to.back().value));
    }
}

void check_traces(const Job& job, Faults& faults) {
    const Job::Output& output = job.output;
    faults.unless(!output.vcd || job.mode == Mode::timed,
                  "`output.vcd` = true, but only timed mode has cycles to trace: set mode = \"timed\"");
    faults.unless(
        output.trace_from <= output.trace_to,
        "`output.trace_from` = {} comes after `output.trace_to` = {}: set output.trace_from = {}, or output.trace_to = {}",
        output.trace_from, output.trace_to, output.trace_to, output.trace_from);
}

}  // namespace

void validate(const Job& job) {
    Faults ranges;
    check_ranges(job, ranges);
    ranges.raise();  // the checks below rely on the ranges

    Faults faults;
    check_mesh(job.mesh, faults);
    check_map(job, faults);
    check_heights(job, faults);
    for (const std::string& fault : setting_faults(job.camera, job.formats, job.tests))
        faults.unless(false, "{}", fault);
    check_light(job.hardware, faults);
    check_hardware(job.hardware, faults);
    check_rank_view(job, faults);
    check_design(job, faults);
    check_traces(job, faults);
    faults.raise();
}

}  // namespace tessera
