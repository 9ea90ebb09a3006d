#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "testbench/job/job.h"
#include "testbench/setup/key_range.h"

namespace tessera {

/// `automatic` in a job file, in quotes.
inline constexpr std::string_view auto_word = "auto";

/// A key's value as in a job file; a choice is its name.
using JobValue = std::variant<bool, std::int64_t, double, std::array<double, 2>, std::array<double, 3>,
                              std::vector<double>, std::string>;

enum class KeyKind {
    flag,
    integer,
    number,
    vector,   ///< three numbers
    span,     ///< a choice, or two numbers, the first lower
    numbers,  ///< any number of them; a single one without brackets
    choice,
    text,
    file,    ///< a path read by the rules of job_paths.h
    folder,  ///< a path relative to the current directory
};

struct Key {
    std::string name;  ///< dotted: mesh.columns
    KeyKind kind;
    std::string unit;  ///< "-": has none
    KeyRange range;
    std::vector<std::string_view> choices;
    std::string description;
    std::vector<std::string_view> sources;  ///< choices of its table's `source` that use it; empty: all
    std::function<JobValue(const Job&)> get;
    std::function<void(Job&, const JobValue&)> set;  ///< for values without complaint(); see set_value

    std::string_view leaf() const;  ///< name without its table
    bool serves(Mode mode) const;   ///< unless its description begins with the other mode
};

/// A table of a job file; the one without a name has the top-level keys.
struct KeyTable {
    std::string name;
    std::string description;
    std::vector<Key> keys;
};

/// All keys, each declared once, in job_keys.cpp, testbench/setup/setting_keys.h and height_tests, and
/// modules/timing/design_keys.h.
/// Reading, --set, dumping and the key reference are derived from them.
const std::vector<KeyTable>& job_tables();

/// nullptr if there is no such key.
const Key* find_key(std::string_view name);
const KeyTable* find_table(std::string_view name);

JobValue default_of(const Key& key);

/// For an unknown threshold or height test: how the program gets to know one's own. Empty if it has loaded any.
std::string own_height_test_hint();

/// "1 .. 2048", "fifo, lifo", "true, false", ...
std::string range_text(const Key& key);

/// Describes the expected value: "an integer, 1 .. 2048 quads".
std::string wanted_text(const Key& key);

/// Why the key cannot have this value, in words; empty if it can.
std::string complaint(const Key& key, const JobValue& value);

/// Throws InputError with the complaint.
void set_value(Job& job, const Key& key, const JobValue& value);

/// The first key that is "auto"; empty if none is.
std::string automatic_key(const Job& job);

/// Equal in every key; doubles bit for bit.
bool same_settings(const Job& a, const Job& b);

}  // namespace tessera
