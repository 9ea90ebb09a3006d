#include "testbench/job/toml_text.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>

namespace tessera {

namespace {

/// Bytes of the UTF-8 character at the beginning of the text; 0 if it is invalid.
std::size_t utf8_sequence(std::string_view text) {
    const auto lead = static_cast<unsigned char>(text[0]);
    const std::size_t length = lead < 0x80   ? 1
                               : lead < 0xc2 ? 0
                               : lead < 0xe0 ? 2
                               : lead < 0xf0 ? 3
                               : lead < 0xf5 ? 4
                                             : 0;
    if (length == 0 || text.size() < length)
        return 0;
    char32_t code = length == 1 ? lead : lead & (0xffu >> (length + 1));
    for (std::size_t k = 1; k < length; ++k) {
        const auto byte = static_cast<unsigned char>(text[k]);
        if ((byte & 0xc0) != 0x80)
            return 0;
        code = (code << 6) | (byte & 0x3fu);
    }
    const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
    return overlong || code > 0x10ffff || (code >= 0xd800 && code < 0xe000) ? 0 : length;
}

std::string escaped(std::string_view text, bool quotes) {
    std::string out;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '\n') {
            out += "\\n";
        } else if (c == '\t') {
            out += "\\t";
        } else if (c == '\r') {
            out += "\\r";
        } else if (quotes && (c == '"' || c == '\\')) {
            out += '\\';
            out += c;
        } else if (byte < 0x20 || byte == 0x7f) {
            out += fmt::format("\\u{:04X}", byte);
        } else {
            out += c;
        }
    }
    return out;
}

struct ToToml {
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(std::int64_t value) const { return std::to_string(value); }
    std::string operator()(double value) const { return toml_number(value); }
    template <typename Numbers>
    std::string operator()(const Numbers& values) const {
        std::string text;
        for (const double value : values)
            text += (text.empty() ? "" : ", ") + toml_number(value);
        return '[' + text + ']';
    }
    std::string operator()(const std::string& value) const { return toml_string(value); }
};

}  // namespace

std::string toml_number(double value) {
    if (std::isnan(value))
        return "nan";
    if (std::isinf(value))
        return value < 0 ? "-inf" : "inf";
    std::string text = fmt::format("{}", value);
    // Without a point TOML would read an integer, and -0 would lose its sign.
    if (text.find_first_of(".e") == std::string::npos)
        text += ".0";
    return text;
}

std::string toml_string(std::string_view text) {
    return '"' + escaped(text, true) + '"';
}

std::string toml_value(const JobValue& value) {
    return std::visit(ToToml{}, value);
}

std::string fit_to_print(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        std::size_t length = utf8_sequence(text);
        // U+0080 to U+009F are controls as well.
        if (length == 2 && text[0] == '\xc2' && static_cast<unsigned char>(text[1]) < 0xa0)
            length = 0;
        out += length == 0 ? fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]))
                           : escaped(text.substr(0, length), false);
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return out;
}

std::string printable(std::string_view text) {
    constexpr std::size_t limit = 60;
    if (text.size() <= limit)
        return fit_to_print(text);
    std::size_t cut = limit;
    while (cut > limit - 4 && (static_cast<unsigned char>(text[cut]) & 0xc0) == 0x80)
        --cut;  // not inside a UTF-8 sequence
    return fit_to_print(text.substr(0, cut)) + "...";
}

bool is_utf8(std::string_view text) {
    while (!text.empty()) {
        const std::size_t length = utf8_sequence(text);
        if (length == 0)
            return false;
        text.remove_prefix(length);
    }
    return true;
}

}  // namespace tessera
