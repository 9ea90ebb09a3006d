#pragma once
#include <set>
#include <string>
#include <vector>

#include "testbench/job/toml_document.h"

namespace tessera {

/// One table of a surface file. Each key is read with its expected type; finish() then refuses keys that were not read.
/// All errors are InputErrors with file, line and column.
class TomlFields {
  public:
    /// `name`: the table's, empty for the file's top level; `file`: for messages. The table must outlive this.
    TomlFields(const toml::table& table, std::string name, std::string file);

    bool has(const char* key);

    struct Range {
        double low, high;
    };
    double number(const char* key, const Range& range);
    std::int64_t integer(const char* key, std::int64_t low, std::int64_t high);
    std::string choice(const char* key, const std::vector<std::string>& choices);

    /// `count` 0: any number from 1.
    std::vector<double> numbers(const char* key, std::size_t count, const Range& range);

    /// A table of numbers, row by row; all rows have equal length.
    struct Rows {
        std::size_t columns = 0, rows = 0;
        std::vector<double> values;
    };
    Rows rows(const char* key, const Range& range);

    /// "FILE:LINE" of the table.
    std::string where() const;

    [[noreturn]] void fail(const char* key, const std::string& what) const;
    /// Reports an error at one element of an array.
    [[noreturn]] void fail(const char* key, std::size_t element, const std::string& what) const;

    /// Refuses keys that were not read.
    void finish() const;

  private:
    const toml::node& wanted(const char* key, const char* what);
    [[noreturn]] void fail_at(const toml::source_region& place, const std::string& what) const;
    double number_of(const toml::node& node, const char* key, const Range& range) const;

    const toml::table& table_;
    std::string name_, file_;
    std::set<std::string> asked_;
};

}  // namespace tessera
