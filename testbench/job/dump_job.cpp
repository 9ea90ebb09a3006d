#include "testbench/job/dump_job.h"

#include <fmt/format.h>

#include "testbench/job/job_keys.h"
#include "testbench/job/job_paths.h"
#include "testbench/job/toml_text.h"

namespace tessera {

namespace {

std::string facts(const Key& key) {
    const std::string unit = key.unit == "-" ? "" : key.unit + "; ";
    return fmt::format("{}{}; default {}", unit, range_text(key), toml_value(default_of(key)));
}

}  // namespace

std::string dump_job(const Job& job) {
    std::string out = "# A tessera job: every key with its value.\n";
    for (const KeyTable& table : job_tables()) {
        if (!table.name.empty()) {
            out += fmt::format("\n# {}\n[{}]\n", table.description, table.name);
        }
        for (const Key& key : table.keys) {
            out += fmt::format("\n# {}\n# {}\n{} = {}\n", key.description, facts(key), key.leaf(),
                               toml_value(key.get(job)));
        }
    }
    return out;
}

std::string dump_job(const Job& job, const std::filesystem::path& run_folder) {
    Job moved = job;
    for (const KeyTable& table : job_tables()) {
        for (const Key& key : table.keys) {
            if (key.kind == KeyKind::file) {
                set_value(moved, key,
                          rebase_path(std::get<std::string>(key.get(job)), job.folder, run_folder));
            }
        }
    }
    return dump_job(moved);
}

}  // namespace tessera
