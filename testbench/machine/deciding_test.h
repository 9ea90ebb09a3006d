#pragma once
#include <algorithm>
#include <cstdint>
#include <string>

#include "modules/datapath/vertex.h"
#include "modules/timing/design_choices.h"

namespace tessera {

/// The tests that split a triangle's parent. NT and SHT, or its replacement, are bits as in split_by; highlight: only the Highlight Test
/// requested the split.
enum class DecidingTest : std::uint8_t { base = 0, normal = 1, summed_height = 2, both = 3, highlight = 4 };
inline constexpr unsigned deciding_tests = 5;

/// The height test's name in words, "summed height" for the Summed Height Test.
inline std::string words_of(datapath::HeightTest test) {
    std::string text(name_of(test));
    std::replace(text.begin(), text.end(), '_', ' ');
    return text;
}

/// From a triangle's split_by.
constexpr DecidingTest deciding_test_of(std::uint8_t split_by) {
    const unsigned tests = split_by & (datapath::normal_bit | datapath::summed_height_bit);
    if (tests == 0 && (split_by & datapath::highlight_bit) != 0)
        return DecidingTest::highlight;
    return static_cast<DecidingTest>(tests);
}

}  // namespace tessera
