#pragma once
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "modules/datapath/curvature.h"
#include "modules/datapath/mipmap.h"
#include "modules/datapath/rank_test.h"
#include "modules/datapath/summed_height.h"

namespace tessera::datapath {

/// The classes of this folder, in the order of HeightTest. Each has its parts in the testbench: host_part(), check_part().
// clang-format off
#define TESSERA_FOR_EACH_HEIGHT_TEST(TEST) \
    TEST(SummedHeightTest) \
    TEST(RankTest) \
    TEST(CurvatureTest) \
    TEST(MipmapTest)
// clang-format on

template <class Test>
inline const Test the_test{};

#define TESSERA_THE_TEST(Test) &the_test<Test>,
inline constexpr const HeightTestFunctions* first_height_tests[] = {TESSERA_FOR_EACH_HEIGHT_TEST(TESSERA_THE_TEST)};
#undef TESSERA_THE_TEST

/// One for each HeightTest, in its order. `added`: for add_height_test().
inline const std::vector<const HeightTestFunctions*>& height_tests(const HeightTestFunctions* added = nullptr) {
    static std::vector<const HeightTestFunctions*> all(std::begin(first_height_tests), std::end(first_height_tests));
    if (added != nullptr)
        all.push_back(added);
    return all;
}

/// What is wrong with the declarations of a test to be added, with the limit; empty if nothing is.
inline std::string declaration_fault(const HeightTestFunctions& test) {
    using Its = HeightTestFunctions;
    constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz", more = "abcdefghijklmnopqrstuvwxyz0123456789_";
    // Of other tests, and of what splits a triangle.
    constexpr std::string_view taken = " base, both, generation, highlight, normal, tex_coord, view";
    const std::string_view name = test.name == nullptr ? "" : test.name;
    if (name.empty() || letters.find(name[0]) == letters.npos || name.find_first_not_of(more) != name.npos ||
        (std::string(taken) + ",").find(" " + std::string(name) + ",") != taken.npos)
        return "a height test is called \"" + std::string(name) +
               "\": choose a name of lower-case letters, digits and _, other than" + std::string(taken);
    for (const Its* const other : height_tests())
        if (name == other->name)
            return "there is another height test " + std::string(name) + ": choose another name";

    const std::string its = "height test " + std::string(name) + ": ";
    const auto out_of_range = [&](const std::string& what, long long value, long long least, long long most) {
        return its + what + " = " + std::to_string(value) + ", but the range is " + std::to_string(least) + " to " +
               std::to_string(most);
    };
    struct Number {
        const char* name;
        long long value, least, most;
    };
    const Formats formats;
    const auto& values = test.values;
    const auto unused =
        std::find_if(values.begin(), values.end(), [](const Its::Value& value) { return value.name == nullptr; });
    for (const Number& number : {Number{"latency", test.latency, 1, Its::most_latency},
                                 Number{"requests", test.requests, 0, Reads::most_requests},
                                 Number{"codes", test.codes, 0, most_rectangle_entries},
                                 Number{"compared", test.compared, -1, unused - values.begin() - 1},
                                 Number{"entry_bits()", test.entry_bits(formats), 1, 64}})
        if (number.value < number.least || number.value > number.most)
            return out_of_range(number.name, number.value, number.least, number.most);
    for (const Its::Value& value : values)
        if (value.name != nullptr && (value.bits < 1 || value.bits > 64))
            return out_of_range("bits of the value " + std::string(value.name), value.bits, 1, 64);
    for (const Its::Threshold& threshold : test.thresholds(formats))
        if (threshold.name != nullptr && (threshold.bits < 0 || threshold.bits > 63))
            return out_of_range("bits of the threshold " + std::string(threshold.name), threshold.bits, 0, 63);
    if (test.feature >= 0) {
        if (test.feature < Its::first_free_feature || test.feature > Its::last_feature)
            return out_of_range("feature", test.feature, Its::first_free_feature, Its::last_feature);
        for (const Its* const other : height_tests())
            if (other->feature == test.feature)
                return its + "feature = " + std::to_string(test.feature) + " is that of the height test " + other->name;
    }
    return {};
}

/// Adds a test for the rest of the program, which must call it first. Throws std::invalid_argument if its declarations
/// are wrong.
inline HeightTest add_height_test(const HeightTestFunctions& test) {
    if (const std::string fault = declaration_fault(test); !fault.empty())
        throw std::invalid_argument(fault);
    return static_cast<HeightTest>(height_tests(&test).size() - 1);
}

/// Whether it is one of those added: what goes wrong may be its fault.
inline bool is_added(HeightTest test) {
    return static_cast<std::size_t>(test) >= std::size(first_height_tests);
}

/// Of a test of this folder.
template <class Test>
HeightTest number_of() {
    const auto found = std::find(height_tests().begin(), height_tests().end(), &the_test<Test>);
    return static_cast<HeightTest>(found - height_tests().begin());
}

inline const HeightTestFunctions& functions_of(HeightTest test) {
    return *height_tests()[static_cast<std::size_t>(test)];
}

/// Bits of an entry of the height test's table.
inline int height_entry_bits(const Formats& formats) {
    return functions_of(formats.height_test).entry_bits(formats);
}

}  // namespace tessera::datapath
