#pragma once
#include <cstdint>  // toml++ needs it included before

// toml++ takes long to compile: include this header in as few files as possible, and toml++ only through it. The parser
// is the compiled library's.
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace tessera {

// Shared by the TOML files that we read: jobs and surfaces.

constexpr std::size_t largest_toml_file = std::size_t{1} << 20;  ///< bytes

/// A file's text, at most one byte more than largest_toml_file. `kind`: the expected kind, as in "job file". Throws
/// InputError if it cannot be read or is not a regular file.
std::string read_toml_text(const std::filesystem::path& path, std::string_view kind);

/// Throws InputError, "NAME:LINE:COLUMN: ...", for text that is not TOML, is too large or would crash toml++
/// (refuse_deep_keys). `kind` as in "a job file".
toml::table parse_toml(std::string_view text, const std::string& name, std::string_view kind);

/// toml++ builds one nested table per dot of a key, without limit, and frees them recursively: a line of 500,000 dots
/// overflows the stack. It limits brackets itself, to 256. Throws InputError for a line that may
/// have a key of more than 64 dots.
void refuse_deep_keys(std::string_view text, const std::string& name);

/// The value found, for messages: "\"three\", a string".
std::string found_text(const toml::node& node);

/// The value of an integer or a floating-point number.
std::optional<double> to_number(const toml::node& node);

}  // namespace tessera
