#include "testbench/job/document_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "testbench/job/job_keys.h"
#include "testbench/job/toml_text.h"

namespace tessera {

namespace {

using Row = std::array<std::string, 5>;

std::string markdown_table(const std::vector<Row>& rows) {
    std::array<std::size_t, std::tuple_size_v<Row>> width{};
    for (const Row& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            width[i] = std::max(width[i], row[i].size());
        }
    }
    std::string out;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        for (std::size_t i = 0; i < width.size(); ++i) {
            out += fmt::format("| {:<{}} ", rows[r][i], width[i]);
        }
        out += "|\n";
        if (r == 0) {
            for (const std::size_t w : width) {
                out += fmt::format("| {:-<{}} ", "", w);
            }
            out += "|\n";
        }
    }
    return out;
}

}  // namespace

std::string document_keys() {
    std::string out;
    for (const KeyTable& table : job_tables()) {
        std::vector<Row> rows{{"Key", "Default", "Range", "Unit", "Meaning"}};
        for (const Key& key : table.keys) {
            rows.push_back({'`' + key.name + '`', '`' + toml_value(default_of(key)) + '`', range_text(key),
                            key.unit, key.description});
        }
        out += fmt::format("{}### {}\n\n{}\n\n{}", out.empty() ? "" : "\n",
                           table.name.empty() ? "Top level" : '`' + table.name + '`', table.description,
                           markdown_table(rows));
    }
    return out;
}

}  // namespace tessera
