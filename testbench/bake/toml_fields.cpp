#include "testbench/bake/toml_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "testbench/common/error.h"
#include "testbench/job/nearest_name.h"
#include "testbench/job/toml_text.h"

namespace tessera {

TomlFields::TomlFields(const toml::table& table, std::string name, std::string file)
    : table_(table), name_(std::move(name)), file_(std::move(file)) {}

bool TomlFields::has(const char* key) {
    asked_.insert(key);
    return table_.contains(key);
}

double TomlFields::number(const char* key, const Range& range) {
    return number_of(wanted(key, "a number"), key, range);
}

std::int64_t TomlFields::integer(const char* key, std::int64_t low, std::int64_t high) {
    const toml::node& node = wanted(key, "an integer");
    const auto* const value = node.as_integer();
    if (value == nullptr || value->get() < low || value->get() > high)
        fail(key, fmt::format("`{}` is {}; expected an integer, {} .. {}", key, found_text(node), low, high));
    return value->get();
}

std::string TomlFields::choice(const char* key, const std::vector<std::string>& choices) {
    const toml::node& node = wanted(key, "a word");
    const auto* const value = node.as_string();
    if (value == nullptr || std::find(choices.begin(), choices.end(), value->get()) == choices.end()) {
        const std::string near = value == nullptr ? "" : nearest_name(value->get(), choices);
        fail(key, fmt::format("`{}` is {}; expected one of {}{}", key, found_text(node), fmt::join(choices, ", "),
                              near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
    }
    return value->get();
}

std::vector<double> TomlFields::numbers(const char* key, std::size_t count, const Range& range) {
    const toml::node& node = wanted(key, "a list of numbers");
    const toml::array* const array = node.as_array();
    if (array == nullptr || array->empty() || (count > 0 && array->size() != count))
        fail(key, fmt::format("`{}` is {}; expected a list of {} number(s)", key, found_text(node),
                              count > 0 ? std::to_string(count) : "1 or more"));
    std::vector<double> numbers;
    for (const toml::node& element : *array)
        numbers.push_back(number_of(element, key, range));
    return numbers;
}

TomlFields::Rows TomlFields::rows(const char* key, const Range& range) {
    const toml::node& node = wanted(key, "a list of rows");
    const toml::array* const array = node.as_array();
    if (array == nullptr || array->empty())
        fail(key, fmt::format("`{}` is {}; expected a list of rows, each a list of numbers", key, found_text(node)));
    Rows rows;
    for (const toml::node& element : *array) {
        const toml::array* const row = element.as_array();
        if (row == nullptr || row->empty())
            fail_at(element.source(), fmt::format("row {} of `{}` is {}; expected a list of numbers", rows.rows + 1,
                                                  key, found_text(element)));
        if (rows.rows > 0 && row->size() != rows.columns)
            fail_at(element.source(), fmt::format("row {} of `{}` has {} number(s) and the first has {}: make them "
                                                  "alike",
                                                  rows.rows + 1, key, row->size(), rows.columns));
        rows.columns = row->size();
        ++rows.rows;
        for (const toml::node& value : *row)
            rows.values.push_back(number_of(value, key, range));
    }
    return rows;
}

std::string TomlFields::where() const {
    return fmt::format("{}:{}", file_, table_.source().begin.line);
}

void TomlFields::fail(const char* key, const std::string& what) const {
    const toml::node* const node = table_.get(key);
    fail_at(node == nullptr ? table_.source() : node->source(), what);
}

void TomlFields::fail(const char* key, std::size_t element, const std::string& what) const {
    fail_at(table_.get(key)->as_array()->get(element)->source(), what);
}

void TomlFields::finish() const {
    for (const auto& [key, node] : table_) {
        const std::string name(key.str());
        if (asked_.count(name) > 0)
            continue;
        const std::string near = nearest_name(name, {asked_.begin(), asked_.end()});
        fail_at(key.source(), fmt::format("unknown {} `{}`{}; {}", node.is_table() ? "table" : "key", printable(name),
                                          name_.empty() ? "" : fmt::format(" of [{}]", name_),
                                          near.empty() ? fmt::format("the keys are {}", fmt::join(asked_, ", "))
                                                       : fmt::format("did you mean `{}`?", near)));
    }
}

const toml::node& TomlFields::wanted(const char* key, const char* what) {
    asked_.insert(key);
    const toml::node* const node = table_.get(key);
    if (node == nullptr)
        fail_at(table_.source(), fmt::format("[{}] has no `{}`, which must be {}", name_, key, what));
    return *node;
}

void TomlFields::fail_at(const toml::source_region& place, const std::string& what) const {
    throw InputError(fmt::format("{}:{}:{}: {}", file_, place.begin.line, place.begin.column, what));
}

double TomlFields::number_of(const toml::node& node, const char* key, const Range& range) const {
    const std::optional<double> number = to_number(node);
    if (!number || !(*number >= range.low && *number <= range.high))
        fail_at(node.source(), fmt::format("{} in `{}`; expected a number, {:g} .. {:g}", found_text(node), key,
                                           range.low, range.high));
    return *number;
}

}  // namespace tessera
