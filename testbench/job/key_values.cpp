#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "modules/datapath/height_tests.h"
#include "testbench/common/error.h"
#include "testbench/job/job_keys.h"
#include "testbench/job/nearest_name.h"
#include "testbench/job/toml_text.h"

// The values that a key may have, and their descriptions in messages.

namespace tessera {

namespace {

constexpr std::size_t longest_text = 4096;  // bytes; the limit of Linux for paths
constexpr std::size_t most_numbers = 16;    // each is compared with every texel

std::string range_numbers(const Key& key) {
    const std::string range = fmt::format("{} .. {}", key.range.low, key.range.high);
    return key.range.or_zero ? "0 or " + range : range;
}

std::string auto_text(const Key& key) {
    return key.range.or_auto ? "auto or " : "";
}

std::string joined(const std::vector<std::string_view>& names) {
    return fmt::format("{}", fmt::join(names, ", "));
}

struct WithUnit {
    const Key& key;
    std::string operator()(const std::string& range) const { return key.unit == "-" ? range : range + " " + key.unit; }
};

// Each overload returns the fault, as the end of the sentence "`key` = value ...".
struct FaultOf {
    const Key& key;

    std::string number(double value) const {
        if (!std::isfinite(value))
            return "is not a finite number; the range is " + WithUnit{key}(range_numbers(key));
        return key.range.holds(value) ? "" : "is out of range; the range is " + WithUnit{key}(range_numbers(key));
    }

    std::string text(const std::string& value) const {
        if (key.kind == KeyKind::choice || key.kind == KeyKind::span)
            return choice(value);
        if (value.size() > longest_text)
            return fmt::format("has {} bytes; the limit is {}", value.size(), longest_text);
        if (value.find('\0') != std::string::npos || !is_utf8(value))
            return "is not UTF-8 text without NUL";
        if (key.kind == KeyKind::folder && value.empty())
            return "is empty; name a folder";
        return "";
    }

    std::string choice(const std::string& value) const {
        if (std::find(key.choices.begin(), key.choices.end(), value) != key.choices.end())
            return "";
        const std::string near = nearest_name(value, {key.choices.begin(), key.choices.end()});
        return "is not a choice; the choices are " + joined(key.choices) +
               (key.kind == KeyKind::span ? ", or two numbers [low, high]" : "") +
               (near.empty() ? "" : "; did you mean \"" + near + "\"?") +
               (key.name == "hardware.height_test" ? own_height_test_hint() : "");
    }

    std::string operator()(bool) const { return key.kind == KeyKind::flag ? "" : wrong_kind(); }
    std::string operator()(std::int64_t value) const {
        return key.kind == KeyKind::integer ? number(static_cast<double>(value)) : wrong_kind();
    }
    std::string operator()(double value) const { return key.kind == KeyKind::number ? number(value) : wrong_kind(); }
    std::string operator()(const std::array<double, 2>& value) const {
        if (key.kind != KeyKind::span)
            return wrong_kind();
        for (const double end : value)
            if (std::string fault = number(end); !fault.empty())
                return fault;
        return value[0] < value[1]
                   ? ""
                   : "has a low end that is not below its high end: give two different numbers, the lower first";
    }
    std::string operator()(const std::array<double, 3>& value) const {
        if (key.kind != KeyKind::vector)
            return wrong_kind();
        for (const double component : value)
            if (std::string fault = number(component); !fault.empty())
                return fault;
        return "";
    }
    std::string operator()(const std::vector<double>& values) const {
        if (key.kind != KeyKind::numbers)
            return wrong_kind();
        if (values.size() > most_numbers)
            return fmt::format("has {} numbers; the limit is {}", values.size(), most_numbers);
        const bool finite =
            std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
        return finite
                   ? ""
                   : "has a number that is not finite: leave it out; NaN and infinite texels are missing data by themselves";
    }
    std::string operator()(const std::string& value) const {
        const bool textual = key.kind == KeyKind::choice || key.kind == KeyKind::span || key.kind == KeyKind::text ||
                             key.kind == KeyKind::file || key.kind == KeyKind::folder;
        if (key.range.or_auto && value == auto_word)
            return "";
        return textual ? text(value) : wrong_kind();
    }

    std::string wrong_kind() const { return "is of the wrong type; expected " + wanted_text(key); }
};

}  // namespace

std::string range_text(const Key& key) {
    switch (key.kind) {
        case KeyKind::flag: return "true, false";
        case KeyKind::integer:
        case KeyKind::number: return auto_text(key) + range_numbers(key);
        case KeyKind::vector: return auto_text(key) + "[x, y, z], each " + range_numbers(key);
        case KeyKind::span: return joined(key.choices) + " or [low, high], each " + range_numbers(key);
        case KeyKind::numbers: return fmt::format("a number, or [up to {} numbers]", most_numbers);
        case KeyKind::choice: return joined(key.choices);
        case KeyKind::text: return "text";
        case KeyKind::file: return "path from the job's folder, or data:path";
        case KeyKind::folder: return "path from the current directory";
    }
    return "";
}

std::string own_height_test_hint() {
    return datapath::height_tests().size() > std::size(datapath::first_height_tests)
               ? ""
               : "; a height test of one's own is known if the environment variable TESSERA_HEIGHT_TESTS names its library";
}

std::string wanted_text(const Key& key) {
    switch (key.kind) {
        case KeyKind::flag: return "true or false";
        case KeyKind::integer: return "an integer, " + WithUnit{key}(range_numbers(key));
        case KeyKind::number: return auto_text(key) + "a number, " + WithUnit{key}(range_numbers(key));
        case KeyKind::vector:
            return auto_text(key) + "three numbers, " + WithUnit{key}("[x, y, z], each " + range_numbers(key));
        case KeyKind::span:
            return "one of " + joined(key.choices) + ", or two numbers, " +
                   WithUnit{key}("[low, high], each " + range_numbers(key));
        case KeyKind::numbers: return WithUnit{key}(range_text(key));
        case KeyKind::choice: return "one of " + joined(key.choices);
        case KeyKind::text:
        case KeyKind::file:
        case KeyKind::folder: return "a string: " + range_text(key);
    }
    return "";
}

std::string complaint(const Key& key, const JobValue& value) {
    const std::string fault = std::visit(FaultOf{key}, value);
    return fault.empty() ? "" : fmt::format("`{}` = {} {}", key.name, printable(toml_value(value)), fault);
}

void set_value(Job& job, const Key& key, const JobValue& value) {
    if (const std::string fault = complaint(key, value); !fault.empty())
        throw InputError(fault);
    key.set(job, value);
}

}  // namespace tessera
