#include "testbench/machine/design_remarks.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>

#include "modules/datapath/height_tests.h"
#include "modules/memories/line_cache.h"
#include "modules/timing/height_test_timing.h"
#include "testbench/job/design_preset.h"
#include "testbench/job/job_keys.h"
#include "testbench/job/toml_text.h"
#include "testbench/setup/height_tests/height_test_host.h"

namespace tessera {

namespace {

struct SizedTable {
    std::string name;
    const MemoryTiming& timing;
    const datapath::TableLayout& layout;
};

std::vector<SizedTable> sized_tables(const MachineSetup& setup) {
    const Timing& t = setup.design.timing;
    const datapath::Registers& r = setup.registers;
    return {{"displacement_map", t.displacement_map, r.displacement_map},
            {"normal_map", t.normal_map, r.normal_map},
            {height_table_spec(r.formats).name, height_table_timing(t, r.formats), r.height_table}};
}

std::string cache_remark(const SizedTable& table) {
    const CacheTiming& asked = table.timing.cache;
    if (asked.bytes == 0)
        return {};
    const CacheShape built(asked, table.layout);
    if (built.whole_table)
        return asked.bytes <= built.bytes()
                   ? ""
                   : fmt::format(
                         "timing.{0}_cache_bytes = {1}: the table has {2} bytes, and a cache of {3} holds it; "
                         "timing.{0}_cache_bytes = {3} builds the same",
                         table.name, asked.bytes, table.layout.bytes(), built.bytes());
    if (built.bytes() == asked.bytes && built.ways == asked.ways && built.line_bytes == asked.line_bytes)
        return {};
    std::string text = fmt::format(
        "timing.{0}_cache_bytes = {1}, timing.{0}_line_bytes = {2}, timing.{0}_cache_ways = {3}: the cache is built with "
        "{4} bytes, {5} {6} of {7} {8} of {9} bytes",
        table.name, asked.bytes, asked.line_bytes, asked.ways, built.bytes(), built.sets,
        built.sets == 1 ? "set" : "sets", built.ways, built.ways == 1 ? "line" : "lines", built.line_bytes);
    // With these values nothing is rounded.
    const auto values = [&](std::uint64_t sets) {
        std::string keys = fmt::format("timing.{}_cache_bytes = {}", table.name, sets * built.ways * built.line_bytes);
        if (built.line_bytes != asked.line_bytes)
            keys += fmt::format(", timing.{}_line_bytes = {}", table.name, built.line_bytes);
        if (built.ways != asked.ways)
            keys += fmt::format(", timing.{}_cache_ways = {}", table.name, built.ways);
        return keys;
    };
    text += "; the same: " + values(built.sets);
    if (built.bytes() != asked.bytes)
        text += "; the next larger: " + values(built.sets + 1);
    return text;
}

std::string width_remark(const SizedTable& table) {
    const unsigned entry = table.layout.entry_bytes, width = table.timing.width;
    if (width == 0)
        return {};
    const unsigned cycles = (entry + width - 1) / width, same = (entry + cycles - 1) / cycles;
    return same == width ? ""
                         : fmt::format(
                               "timing.{0}_width = {1}: an entry of {2} bytes takes {3} {4} of a port, as with "
                               "timing.{0}_width = {5}",
                               table.name, width, entry, cycles, cycles == 1 ? "cycle" : "cycles", same);
}

/// Keys that have no effect, by name or as `beginning*`, and why.
struct Idle {
    std::vector<std::string> keys;
    std::string because;

    bool has(const std::string& key) const {
        return std::any_of(keys.begin(), keys.end(), [&](const std::string& its) {
            return its.back() == '*' ? key.compare(0, its.size() - 1, its, 0, its.size() - 1) == 0 : key == its;
        });
    }
};

/// Of the edge tests: a key belongs to the test that its name begins with, a threshold to that which declares it.
std::vector<Idle> idle_test_keys(const Job& job, const datapath::Formats& formats) {
    std::vector<Idle> idle;
    for (const Key& key : find_table("tests")->keys)
        if (const JobValue on = key.get(job); std::holds_alternative<bool>(on) && !std::get<bool>(on))
            idle.push_back({{key.name + "_*"}, key.name + " = false"});
    const datapath::HeightTestFunctions& chosen = datapath::functions_of(formats.height_test);
    const std::string because = fmt::format("hardware.height_test = \"{}\"", chosen.name);
    for (std::size_t k = 0; k < height_test_hosts().size(); ++k) {
        const datapath::HeightTestFunctions& test = *datapath::height_tests()[k];
        if (&test != &chosen)
            idle.push_back({{fmt::format("tests.{}_*", test.name)}, because});
        const auto registers = test.thresholds(formats);
        for (const HeightThresholdKey& key : height_test_hosts()[k]->thresholds()) {
            const bool compared = std::any_of(registers.begin(), registers.end(), [&](const auto& its) {
                return its.name != nullptr && its.name == std::string_view(key.name) && its.bits > 0;
            });
            const std::string name = std::string("tests.") + key.name;
            if (&test != &chosen)
                idle.push_back({{name}, because});
            else if (!job.tests.summed_height)
                idle.push_back({{name}, "tests.summed_height = false"});
            else if (!compared)
                idle.push_back({{name}, "the height test's table has no entries to compare with it"});
        }
    }
    return idle;
}

/// Of the mesh and the map: a key belongs to the sources that it declares.
std::vector<Idle> idle_source_keys(const Job& job) {
    std::vector<Idle> idle;
    for (const char* const table : {"mesh", "map"}) {
        const Key& source = *find_key(fmt::format("{}.source", table));
        const JobValue chosen = source.get(job);
        for (const Key& key : find_table(table)->keys) {
            const auto& users = key.sources;
            if (!users.empty() && std::find(users.begin(), users.end(), std::get<std::string>(chosen)) == users.end())
                idle.push_back({{key.name}, fmt::format("{} = {}", source.name, toml_value(chosen))});
        }
    }
    return idle;
}

std::vector<Idle> idle_keys(const Job& job, const MachineSetup& setup) {
    std::vector<Idle> idle = idle_test_keys(job, setup.registers.formats);
    for (Idle& keys : idle_source_keys(job))
        idle.push_back(std::move(keys));
    if (!job.output.vcd)
        idle.push_back({{"output.trace_*"}, "output.vcd = false"});
    const auto unless = [&](bool used, std::vector<std::string> keys, std::string because) {
        if (!used)
            idle.push_back({std::move(keys), std::move(because)});
    };
    unless(setup.registers.formats.height_test == datapath::HeightTest::rank,
           {"formats.rank_bits", "formats.bound_bits"}, "hardware.height_test is not \"rank\"");
    const std::string mode = fmt::format("mode = {}", toml_value(find_key("mode")->get(job)));
    for (const Key& key : find_table("hardware")->keys)
        unless(key.serves(job.mode), {key.name}, mode);
    unless(job.mode == Mode::timed, {"timing.*"}, mode);
    if (job.mode != Mode::timed)
        return idle;
    const datapath::HeightTest height_test = setup.registers.formats.height_test;
    const Design& design = setup.design;
    unless(functions_of(height_test).rectangles, {"timing.summed_height_table_*"},
           fmt::format("hardware.height_test = \"{}\"", name_of(height_test)));
    unless(!functions_of(height_test).rectangles, {"timing.height_table_*"},
           fmt::format("hardware.height_test = \"{}\"", name_of(height_test)));
    bool off_chip = design.queue.capacity > 0 && design.queue.overflow == QueueOverflow::spill;
    for (const SizedTable& table : sized_tables(setup)) {
        const bool cached = table.timing.cache.bytes > 0;
        off_chip |= cached;
        unless(table.timing.banks > 1, {"timing." + table.name + "_interleave"}, "timing." + table.name + "_banks = 1");
        unless(cached,
               {"timing." + table.name + "_line_bytes", "timing." + table.name + "_cache_ways",
                "timing." + table.name + "_cache_fills"},
               "timing." + table.name + "_cache_bytes = 0");
    }
    unless(off_chip, {"timing.off_chip_*"}, "nothing is off chip: no table has a cache, and the queue does not spill");
    unless(design.queue.capacity > 0, {"hardware.queue_overflow", "hardware.off_chip_triangles"},
           "hardware.queue_capacity = 0");
    unless(design.test_order == TestOrder::cheap_first, {"timing.edges_in_sequence"},
           "hardware.test_order = \"parallel\"");
    unless(setup.registers.tests.highlight_test, {"timing.highlight_test_latency"}, "tests.highlight = false");
    unless(job.timing.stalls.per_mille > 0, {"timing.stalls_*"}, "timing.stalls_per_mille = 0");
    return idle;
}

}  // namespace

std::vector<std::string> design_remarks(const Job& job, const MachineSetup& setup) {
    std::vector<std::string> remarks;
    if (job.mode == Mode::timed)
        for (const SizedTable& table : sized_tables(setup))
            for (std::string& remark : std::vector{cache_remark(table), width_remark(table)})
                if (!remark.empty())
                    remarks.push_back(std::move(remark));
    Job preset;
    preset.hardware.design = job.hardware.design;
    apply_design(preset);
    const std::vector<Idle> idle = idle_keys(job, setup);
    for (const char* const name : {"mesh", "map", "tests", "formats", "hardware", "timing", "output"})
        for (const Key& key : find_table(name)->keys) {
            const std::string value = toml_value(key.get(job)), setting = fmt::format("{} = {}", key.name, value);
            const auto why = std::find_if(idle.begin(), idle.end(), [&](const Idle& it) { return it.has(key.name); });
            const bool said = std::any_of(setup.remarks.begin(), setup.remarks.end(),
                                          [&](const std::string& remark) { return remark.rfind(setting, 0) == 0; });
            if (why != idle.end() && value != toml_value(key.get(preset)) && !said)
                remarks.push_back(fmt::format("{} has no effect: {}", setting, why->because));
        }
    if (const std::size_t base = setup.base_triangles.size(); setup.machines > base)
        remarks.push_back(fmt::format("hardware.machines = {}: only {} work, since the base mesh has {} triangle{}",
                                      setup.machines, base, base, base == 1 ? "" : "s"));
    return remarks;
}

}  // namespace tessera
