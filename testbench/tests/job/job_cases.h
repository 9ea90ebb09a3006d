#pragma once
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "testbench/job/job_keys.h"
#include "testbench/job/read_job.h"
#include "testbench/tests/support/refusals.h"
#include "testbench/tests/support/test_folder.h"

/// Job files, values for their keys, and the expected messages, for the job's tests.
namespace tessera::testing {

inline std::string parse_error_of(const std::string& text) {
    return input_error_of([&] { parse_job(text, "job.toml"); });
}

inline std::vector<Key> all_keys() {
    std::vector<Key> keys;
    for (const KeyTable& table : job_tables())
        keys.insert(keys.end(), table.keys.begin(), table.keys.end());
    return keys;
}

/// A job file with one key.
inline std::string one_key(const Key& key, const std::string& value) {
    const std::size_t dot = key.name.find('.');
    const std::string table = dot == std::string::npos ? "" : "[" + key.name.substr(0, dot) + "]\n";
    return table + std::string(key.leaf()) + " = " + value + "\n";
}

inline double bits_to_double(std::uint64_t bits) {
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

inline double random_number(const KeyRange& range) {
    const double any = bits_to_double(*rc::gen::arbitrary<std::uint64_t>());
    if (any >= range.low && any <= range.high)
        return any;
    const double part = static_cast<double>(*rc::gen::inRange<std::int64_t>(0, 1000001)) / 1000000.0;
    return std::min(range.high, range.low + part * (range.high - range.low));
}

inline std::string random_text() {
    const std::vector<std::string> pieces{"a",
                                          "Z",
                                          "0",
                                          "\"",
                                          "\\",
                                          "'",
                                          "#",
                                          "=",
                                          "\n",
                                          "\r",
                                          "\t",
                                          " ",
                                          ".",
                                          "\x01",
                                          "\x7f",
                                          "\xc3\xa4",
                                          "]",
                                          "{",
                                          "\\u0",
                                          ",",
                                          "/",
                                          "\xe2\x82\xac",
                                          "\xf0\x9f\x98\x80",
                                          "data:"};
    std::string text;
    for (const std::size_t i :
         *rc::gen::container<std::vector<std::size_t>>(rc::gen::inRange<std::size_t>(0, pieces.size())))
        text += pieces[i];
    return text;
}

inline JobValue random_value(const Key& key) {
    switch (key.kind) {
        case KeyKind::flag: return *rc::gen::arbitrary<bool>();
        case KeyKind::integer:
            return *rc::gen::inRange(static_cast<std::int64_t>(key.range.low),
                                     static_cast<std::int64_t>(key.range.high) + 1);
        case KeyKind::number: return random_number(key.range);
        case KeyKind::vector:
            return std::array<double, 3>{random_number(key.range), random_number(key.range), random_number(key.range)};
        case KeyKind::span: {
            const double a = random_number(key.range), b = random_number(key.range);
            return a < b ? std::array<double, 2>{a, b} : std::array<double, 2>{key.range.low, key.range.high};
        }
        case KeyKind::numbers:
            return std::vector<double>(*rc::gen::inRange<std::size_t>(0, 4), random_number({-1e40, 1e40}));
        case KeyKind::choice: return std::string(*rc::gen::elementOf(key.choices));
        case KeyKind::text:
        case KeyKind::file: return random_text();
        case KeyKind::folder: return "f" + random_text();
    }
    return false;
}

}  // namespace tessera::testing
