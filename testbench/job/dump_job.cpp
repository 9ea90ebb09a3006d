#include "testbench/job/dump_job.h"

#include <fmt/format.h>

#include "testbench/job/design_preset.h"
#include "testbench/job/job_keys.h"
#include "testbench/job/job_paths.h"
#include "testbench/job/toml_text.h"

namespace tessera {

namespace {

std::string facts(const Key& key) {
    const std::string unit = key.unit == "-" ? "" : key.unit + "; ";
    return fmt::format("{}{}; default {}", unit, range_text(key), toml_value(default_of(key)));
}

/// The job with its paths rewritten for another folder.
Job moved_to(const std::filesystem::path& folder, const Job& job) {
    Job moved = job;
    for (const KeyTable& table : job_tables()) {
        for (const Key& key : table.keys)
            if (key.kind == KeyKind::file)
                set_value(moved, key, rebase_path(std::get<std::string>(key.get(job)), job.folder, folder));
    }
    return moved;
}

}  // namespace

std::string dump_job(const Job& job) {
    std::string out = fmt::format("{}\n", dumped_job_heading);
    for (const KeyTable& table : job_tables()) {
        if (!table.name.empty())
            out += fmt::format("\n# {}\n[{}]\n", table.description, table.name);
        for (const Key& key : table.keys) {
            out += fmt::format("\n# {}\n# {}\n{} = {}\n", key.description, facts(key), key.leaf(),
                               toml_value(key.get(job)));
        }
    }
    return out;
}

std::string dump_job(const Job& job, const std::filesystem::path& run_folder) {
    return dump_job(moved_to(run_folder, job)).replace(0, dumped_job_heading.size(), run_job_heading);
}

std::string dump_short_job(const Job& job, const std::filesystem::path& folder, const std::string& heading) {
    const Job moved = moved_to(folder, job);
    Job preset;
    preset.hardware.design = job.hardware.design;
    apply_design(preset);
    std::string out = "# " + heading + "\n";
    for (const KeyTable& table : job_tables()) {
        std::string keys;
        for (const Key& key : table.keys) {
            const std::string value = toml_value(key.get(moved));
            const bool is_preset = key.name == "hardware.design";
            if (value != toml_value(is_preset ? default_of(key) : key.get(preset)))
                keys += fmt::format("{} = {}\n", key.leaf(), value);
        }
        if (!keys.empty())
            out += (table.name.empty() ? "" : fmt::format("\n[{}]\n", table.name)) + keys;
    }
    return out;
}

std::string document_keys() {
    std::string out;
    for (const KeyTable& table : job_tables()) {
        out += fmt::format(
            "{}### {}\n\n{}\n\n| key | default | range | unit | meaning |\n| --- | --- | --- | --- | --- |\n",
            out.empty() ? "" : "\n", table.name.empty() ? "Top level" : '`' + table.name + '`', table.description);
        for (const Key& key : table.keys) {
            out += fmt::format("| `{}` | `{}` | {} | {} | {} |\n", key.name, toml_value(default_of(key)),
                               range_text(key), key.unit, key.description);
        }
    }
    return out;
}

}  // namespace tessera
