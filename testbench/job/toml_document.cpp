#include "testbench/job/toml_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <fstream>

#include "testbench/common/error.h"
#include "testbench/job/toml_text.h"

namespace tessera {

namespace {

constexpr std::ptrdiff_t most_dots = 64;

/// The largest number of dots in a key of this line. Numbers in an array have a dot each, but are no keys: a comma ends
/// a key unless it is quoted, so a line without quotes is counted from comma to comma.
std::ptrdiff_t dots_of_a_key(std::string_view row) {
    const bool quotes = row.find_first_of("\"'") != std::string_view::npos;
    std::ptrdiff_t most = 0, dots = 0;
    for (const char c : row) {
        dots = c == ',' && !quotes ? 0 : dots + (c == '.' ? 1 : 0);
        most = std::max(most, dots);
    }
    return most;
}

}  // namespace

void refuse_deep_keys(std::string_view text, const std::string& name) {
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::string_view row = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(row.size() + 1, text.size()));
        const std::size_t first = row.find_first_not_of(" \t");
        const bool comment = first != std::string_view::npos && row[first] == '#';
        const std::ptrdiff_t dots = dots_of_a_key(row);
        if (!comment && dots > most_dots) {
            throw InputError(fmt::format("{}:{}:1: {} dots in one line; the limit is {}, a key has at most one", name,
                                         line, dots, most_dots));
        }
    }
}

std::string read_toml_text(const std::filesystem::path& path, std::string_view kind) {
    const std::string name = path.string();
    std::error_code failed;
    const std::filesystem::file_status status = std::filesystem::status(path, failed);
    if (status.type() == std::filesystem::file_type::not_found)
        throw InputError(fmt::format("{}: no such {}", name, kind));
    if (status.type() == std::filesystem::file_type::directory)
        throw InputError(fmt::format("{}: is a folder, not a {}", name, kind));
    if (status.type() != std::filesystem::file_type::regular)
        throw InputError(fmt::format("{}: is not a file that can be read as a {}", name, kind));
    std::ifstream file(path, std::ios::binary);
    std::string text(largest_toml_file + 1, '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!file.is_open() || file.bad())
        throw InputError(fmt::format("{}: cannot be read; check its permissions", name));
    text.resize(static_cast<std::size_t>(file.gcount()));
    return text;
}

toml::table parse_toml(std::string_view text, const std::string& name, std::string_view kind) {
    if (text.size() > largest_toml_file)
        throw InputError(fmt::format("{}: over {} bytes; {} has at most that many", name, largest_toml_file, kind));
    refuse_deep_keys(text, name);
    try {
        return toml::parse(text);
    } catch (const toml::parse_error& error) {
        throw InputError(fmt::format("{}:{}:{}: not TOML: {}", name, error.source().begin.line,
                                     error.source().begin.column, fit_to_print(error.description())));
    }
}

std::string found_text(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::table: return "a table";
        case toml::node_type::array: return fmt::format("an array of {}", node.as_array()->size());
        case toml::node_type::string: return printable(toml_string(node.as_string()->get())) + ", a string";
        case toml::node_type::integer: return fmt::format("{}, an integer", node.as_integer()->get());
        case toml::node_type::floating_point:
            return toml_number(node.as_floating_point()->get()) + ", a floating-point number";
        case toml::node_type::boolean: return node.as_boolean()->get() ? "true" : "false";
        case toml::node_type::date: return "a date";
        case toml::node_type::time: return "a time";
        case toml::node_type::date_time: return "a date and time";
        case toml::node_type::none: break;
    }
    return "nothing";
}

std::optional<double> to_number(const toml::node& node) {
    if (const auto* number = node.as_floating_point())
        return number->get();
    if (const auto* integer = node.as_integer())
        return static_cast<double>(integer->get());
    return {};
}

}  // namespace tessera
