#include "testbench/job/dump_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "modules/timing/all_units.h"
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

std::string head_of(const KeyTable& table, const std::vector<std::string>& columns) {
    std::string text =
        fmt::format("### {}\n\n{}\n\n", table.name.empty() ? "Top level" : '`' + table.name + '`', table.description);
    std::string rule = "|";
    text += '|';
    for (const std::string& column : columns) {
        text += ' ' + column + " |";
        rule += " --- |";
    }
    return text + '\n' + rule + '\n';
}

/// The columns of a key in the summary, after its name.
std::string facts_of(const Key& key, const std::string& meaning) {
    return fmt::format("| `{}` | {}{} | {} |\n", toml_value(default_of(key)), range_text(key),
                       key.unit == "-" ? "" : " (" + key.unit + ")", meaning);
}

/// Keys that differ only in the unit or memory that they begin with.
struct KeyRow {
    const Key* key;
    std::string kind;                 ///< the name with * for the unit's; empty: of no unit
    std::string facts;                ///< the meaning without the unit
    std::vector<std::string> owners;  ///< names of the units
};

KeyRow row_of(const Key& key) {
    KeyRow row{&key, {}, {}, {}};
    const std::string leaf(key.leaf());
    const auto look_among = [&](const auto& specs) {
        for (const auto& spec : specs) {
            const std::string owner = spec.name;
            if (leaf.rfind(owner + '_', 0) != 0)
                continue;
            row.kind = '*' + leaf.substr(owner.size());
            row.facts = facts_of(key, key.description.substr(key.description.find(": ") + 2));
            row.owners = {owner};
        }
    };
    if (key.name.rfind("timing.", 0) == 0) {
        look_among(all_units);
        look_among(all_table_memories);
    }
    return row;
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
        out += (out.empty() ? "" : "\n") + head_of(table, {"key", "default", "range", "unit", "meaning"});
        for (const Key& key : table.keys) {
            out += fmt::format("| `{}` | `{}` | {} | {} | {} |\n", key.name, toml_value(default_of(key)),
                               range_text(key), key.unit, key.description);
        }
    }
    return out;
}

std::string summarise_keys() {
    std::string out;
    for (const KeyTable& table : job_tables()) {
        out += (out.empty() ? "" : "\n") + head_of(table, {"key", "default", "range (unit)", "meaning"});
        std::vector<KeyRow> rows;
        for (const Key& key : table.keys) {
            KeyRow row = row_of(key);
            const auto same = std::find_if(rows.begin(), rows.end(), [&](const KeyRow& other) {
                return !row.kind.empty() && other.kind == row.kind && other.facts == row.facts;
            });
            if (same == rows.end())
                rows.push_back(std::move(row));
            else
                same->owners.push_back(row.owners.front());
        }
        std::vector<std::string> before;
        for (const KeyRow& row : rows) {
            if (row.owners.size() < 2)
                out += fmt::format("| `{}` {}", row.key->leaf(), facts_of(*row.key, row.key->description));
            else if (row.owners == before)
                out += fmt::format("| `{}`: likewise {}", row.kind, row.facts);
            else
                out += fmt::format("| `{}`: `{}` {}", row.kind, fmt::join(row.owners, "`, `"), row.facts);
            before = row.owners;
        }
    }
    return out;
}

}  // namespace tessera
