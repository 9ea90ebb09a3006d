#include "testbench/job/read_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>

#include "testbench/common/error.h"
#include "testbench/job/design_preset.h"
#include "testbench/job/job_keys.h"
#include "testbench/job/job_paths.h"
#include "testbench/job/nearest_name.h"
#include "testbench/job/toml_document.h"
#include "testbench/job/toml_text.h"
#include "testbench/job/validate_job.h"

namespace tessera {

namespace {

constexpr std::size_t most_faults = 20;
constexpr std::string_view design_key = "hardware.design";

struct Fault {
    std::uint32_t line;
    std::uint32_t column;
    std::string text;
    std::string unknown_name;  // its suggestion is found when the fault is printed
};

Fault fault_at(const toml::source_region& where, std::string text, std::string unknown_name = {}) {
    return {where.begin.line, where.begin.column, std::move(text), std::move(unknown_name)};
}

std::vector<std::string> all_names() {
    std::vector<std::string> names;
    for (const KeyTable& table : job_tables()) {
        if (!table.name.empty())
            names.push_back(table.name);
        for (const Key& key : table.keys)
            names.push_back(key.name);
    }
    return names;
}

std::string keys_text(const KeyTable& table) {
    std::string text;
    for (const Key& key : table.keys)
        text += fmt::format("{}{}", text.empty() ? "" : ", ", key.leaf());
    return text;
}

std::string suggestion(std::string_view unknown_name) {
    const std::string near = nearest_name(unknown_name, all_names());
    const bool threshold = unknown_name.rfind("tests.", 0) == 0 && unknown_name.find("_threshold") != unknown_name.npos;
    const std::string hint = threshold ? own_height_test_hint() : "";
    if (near.empty())
        return "; `tessera keys` lists them all" + hint;
    const KeyTable* group = find_table(near);
    const bool within_another = unknown_name.find('.') != std::string_view::npos;
    return group != nullptr && within_another
               ? fmt::format(
                     "; did you mean the group `{0}`? It is a top-level table: write [{0}], then its keys ({1})", near,
                     keys_text(*group))
               : fmt::format("; did you mean `{}`?{}", near, hint);
}

template <std::size_t Size>
std::optional<std::array<double, Size>> to_numbers(const toml::node& node) {
    const toml::array* array = node.as_array();
    std::array<double, Size> vector{};
    if (array == nullptr || array->size() != vector.size())
        return {};
    for (std::size_t i = 0; i < vector.size(); ++i) {
        const std::optional<double> number = to_number((*array)[i]);
        if (!number)
            return {};
        vector[i] = *number;
    }
    return vector;
}

/// A number alone is a list of one.
std::optional<std::vector<double>> to_list(const toml::node& node) {
    if (const std::optional<double> number = to_number(node))
        return std::vector<double>{*number};
    const toml::array* array = node.as_array();
    std::vector<double> list;
    for (std::size_t i = 0; array != nullptr && i < array->size(); ++i) {
        const std::optional<double> number = to_number((*array)[i]);
        if (!number)
            return {};
        list.push_back(*number);
    }
    return array == nullptr ? std::nullopt : std::optional(list);
}

template <typename T>
std::optional<JobValue> optional_value(const std::optional<T>& value) {
    return value ? std::optional<JobValue>(JobValue(*value)) : std::nullopt;
}

/// Nothing if the node's type does not fit the key's kind.
std::optional<JobValue> to_value(const toml::node& node, const Key& key) {
    const std::optional<std::string> word = node.value_exact<std::string>();
    if (word && (key.kind == KeyKind::span || (key.range.or_auto && *word == auto_word)))
        return *word;
    switch (key.kind) {
        case KeyKind::flag: return optional_value(node.value_exact<bool>());
        case KeyKind::integer: return optional_value(node.value_exact<std::int64_t>());
        case KeyKind::number: return optional_value(to_number(node));
        case KeyKind::vector: return optional_value(to_numbers<3>(node));
        case KeyKind::span: return optional_value(to_numbers<2>(node));
        case KeyKind::numbers: return optional_value(to_list(node));
        case KeyKind::choice:
        case KeyKind::text:
        case KeyKind::file:
        case KeyKind::folder: return optional_value(word);
    }
    return {};
}

/// Sets the key from the node; returns what is wrong, empty if nothing.
std::string set_from_node(Job& job, const Key& key, const toml::node& node) {
    const std::optional<JobValue> value = to_value(node, key);
    if (!value)
        return fmt::format("`{}` is {}; expected {}", key.name, found_text(node), wanted_text(key));
    std::string fault = complaint(key, *value);
    if (fault.empty())
        key.set(job, *value);
    return fault;
}

/// A key as it would be written: quoted if necessary, so that "mesh.rows" as one key shows.
std::string written_key(std::string_view key) {
    const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
    return bare ? printable(key) : printable(toml_string(key));
}

/// A file named without a source is an OBJ file, or an image.
void choose_source(Job& job, std::string_view table) {
    if (table == "mesh" && !job.mesh.file.empty())
        job.mesh.source = MeshSource::file;
    else if (table == "map" && !job.map.file.empty())
        job.map.source = MapSource::file;
}

class TableReader {
  public:
    void read_top_level(const toml::table& table) {
        // A preset is applied first: the keys it sets may follow it in any order.
        if (const auto preset = table["hardware"]["design"]; preset) {
            set_from_node(job_, *find_key(design_key), *preset.node());
            apply_design(job_);
        }
        for (const auto& [name, node] : table) {
            const KeyTable* inner = name.str().empty() ? nullptr : find_table(name.str());
            if (inner == nullptr) {
                read_key("", name, node);
            } else if (const toml::table* keys = node.as_table()) {
                for (const auto& [inner_name, inner_node] : *keys)
                    read_key(inner->name + '.', inner_name, inner_node);
                if (!keys->contains("source"))
                    choose_source(job_, inner->name);
            } else {
                faults_.push_back(fault_at(name.source(), fmt::format("`{0}` is {1}; `{0}` is a table of keys: "
                                                                      "write [{0}], then its keys",
                                                                      inner->name, found_text(node))));
            }
        }
    }

    Job take(const std::string& file) {
        if (faults_.empty())
            return job_;
        std::sort(faults_.begin(), faults_.end(), [](const Fault& a, const Fault& b) {
            return std::tie(a.line, a.column) < std::tie(b.line, b.column);
        });
        std::string message;
        for (std::size_t i = 0; i < std::min(faults_.size(), most_faults); ++i) {
            const Fault& fault = faults_[i];
            message += fmt::format("{}{}:{}:{}: {}{}", i == 0 ? "" : "\n", file, fault.line, fault.column, fault.text,
                                   fault.unknown_name.empty() ? "" : suggestion(fault.unknown_name));
        }
        if (faults_.size() > most_faults)
            message += fmt::format("\n{}: and {} more", file, faults_.size() - most_faults);
        throw InputError(message);
    }

  private:
    void read_key(const std::string& prefix, const toml::key& name, const toml::node& node) {
        // Quoted dots do not form a path: "mesh.rows" = 3 at the top level is not mesh.rows.
        const bool quoted_dots = name.str().find('.') != std::string_view::npos;
        const std::string full_name = prefix + std::string(name.str());
        const Key* key = quoted_dots ? nullptr : find_key(full_name);
        if (key == nullptr) {
            faults_.push_back(fault_at(
                name.source(),
                fmt::format("unknown {} `{}{}`", node.is_table() ? "table" : "key", prefix, written_key(name.str())),
                full_name));
        } else if (std::string fault = set_from_node(job_, *key, node); !fault.empty()) {
            faults_.push_back(fault_at(name.source(), std::move(fault)));
        }
    }

    Job job_;
    std::vector<Fault> faults_;
};

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos)
        return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

bool is_bare_word(const Key& key, std::string_view value) {
    switch (key.kind) {
        case KeyKind::choice:
        case KeyKind::text:
        case KeyKind::file:
        case KeyKind::folder: return value.empty() || (value.front() != '"' && value.front() != '\'');
        case KeyKind::span: return std::find(key.choices.begin(), key.choices.end(), value) != key.choices.end();
        case KeyKind::flag:
        case KeyKind::integer:
        case KeyKind::number:
        case KeyKind::vector:
        case KeyKind::numbers: break;
    }
    return key.range.or_auto && value == auto_word;
}

std::string table_of(const Key& key) {
    return key.name.substr(0, key.name.find('.'));
}

/// Sets the key from the text of one TOML value.
void set_from_text(Job& job, const Key& key, std::string_view text) {
    refuse_deep_keys(text, "value");
    toml::table table;
    try {
        table = toml::parse(fmt::format("value = {}", text));
    } catch (const toml::parse_error&) {
        throw InputError(fmt::format("`{}` cannot be {}; expected {}", key.name, printable(text), wanted_text(key)));
    }
    const toml::node* value = table.get("value");
    if (table.size() != 1 || value == nullptr)
        throw InputError(fmt::format("`{}`: one --set sets one key", key.name));
    if (const std::string fault = set_from_node(job, key, *value); !fault.empty())
        throw InputError(fault);
}

void set_key(Job& job, std::string_view name, std::string_view value) {
    const Key* key = find_key(name);
    const KeyTable* group = key == nullptr && !name.empty() ? find_table(name) : nullptr;
    if (group != nullptr) {
        throw InputError(
            fmt::format("`{0}` is a group of keys, but one --set sets one key, as in --set {1}=...; `{0}` "
                        "has {2}",
                        name, group->keys.front().name, keys_text(*group)));
    }
    if (key == nullptr)
        throw InputError(fmt::format("unknown key `{}`{}", printable(name), suggestion(name)));
    if (is_bare_word(*key, value))
        set_value(job, *key, std::string(value));
    else if (value.empty())
        throw InputError(fmt::format("`{}` has no value; expected {}", name, wanted_text(*key)));
    else
        set_from_text(job, *key, value);
    if (key->name == design_key)
        apply_design(job);
    if (key->kind == KeyKind::file) {
        set_value(job, *key, rebase_path(std::get<std::string>(key->get(job)), "", job.folder));
        if (const Key* source = find_key(table_of(*key) + ".source");
            source != nullptr && source->get(job) == default_of(*source))
            choose_source(job, table_of(*key));
    }
}

}  // namespace

Job parse_job(std::string_view text, const std::string& name) {
    TableReader reader;
    reader.read_top_level(parse_toml(text, name, "a job file"));
    return reader.take(name);
}

Job read_job(const std::filesystem::path& path) {
    Job job = parse_job(read_toml_text(path, "job file"), path.string());
    job.folder = path.parent_path().string();
    return job;
}

void apply_setting(Job& job, std::string_view setting) {
    const std::size_t equals = setting.find('=');
    try {
        if (equals == std::string_view::npos)
            throw InputError("expected table.key=value, for example mesh.columns=3");
        Job changed = job;
        set_key(changed, trimmed(setting.substr(0, equals)), trimmed(setting.substr(equals + 1)));
        job = std::move(changed);
    } catch (const InputError& error) {
        throw InputError(fmt::format("--set {}: {}", printable(setting), error.what()));
    }
}

void apply_settings(Job& job, const std::vector<std::string>& settings) {
    for (const bool presets : {true, false}) {
        for (const std::string& setting : settings)
            if ((trimmed(std::string_view(setting).substr(0, setting.find('='))) == design_key) == presets)
                apply_setting(job, setting);
    }
}

Job load_job(const std::string& file, const std::vector<std::string>& settings,
             const std::filesystem::path& data_folder) {
    Job job = file.empty() ? Job{} : read_job(file);
    apply_settings(job, settings);
    validate(job);
    resolve_paths(job, data_folder);
    return job;
}

}  // namespace tessera
