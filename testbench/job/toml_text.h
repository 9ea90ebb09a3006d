#pragma once
#include <string>
#include <string_view>

#include "testbench/job/job_keys.h"

namespace tessera {

/// The shortest TOML float that reads back to exactly this double.
std::string toml_number(double value);

/// A TOML basic string, with quotes and escapes.
std::string toml_string(std::string_view text);

std::string toml_value(const JobValue& value);

/// For messages: control characters and bytes that are not UTF-8 are escaped, so that no file can control
/// the terminal.
std::string fit_to_print(std::string_view text);

/// The same, cut after about 60 bytes.
std::string printable(std::string_view text);

bool is_utf8(std::string_view text);

}  // namespace tessera
