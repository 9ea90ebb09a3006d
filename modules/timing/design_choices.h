#pragma once
#include <array>
#include <cstddef>
#include <string_view>
#include <type_traits>

#include "modules/datapath/height_tests.h"
#include "modules/timing/timing.h"
#include "modules/timing/work.h"

namespace tessera {

/// The names in job files of an enumeration's enumerators, which count from 0 without gaps. Specialised for each.
template <typename Enum>
constexpr std::nullptr_t choice_names = nullptr;

/// Whether an enumerator has this value. The compiler writes any other as a cast, "(tessera::Work)2".
template <auto Value>
constexpr bool is_enumerator() {
    constexpr std::string_view before = "Value = ", text = __PRETTY_FUNCTION__;
    return text[text.find(before) + before.size()] != '(';
}

/// One name per enumerator.
template <typename Enum, typename... Names>
constexpr std::array<std::string_view, sizeof...(Names)> names_in_order(Names... names) {
    static_assert(is_enumerator<static_cast<Enum>(sizeof...(Names) - 1)>(), "more names than enumerators");
    static_assert(!is_enumerator<static_cast<Enum>(sizeof...(Names))>(), "an enumerator without a name");
    return {names...};
}

/// How units communicate.
enum class Transport {
    blocking,      ///< blocking transport: all results, no cycles (functional mode)
    non_blocking,  ///< non-blocking transport: the same results, cycle-accurate (timed mode)
};

/// The order in which the Triangle Queue outputs its triangles.
enum class TriangleOrder {
    fifo,  ///< the paper's: breadth first
    lifo,  ///< depth first: the queue stays short
};

/// The behaviour of a full queue (timed mode).
enum class QueueOverflow {
    spill,  ///< to off-chip memory
    stall,  ///< holds back the unit before it: deadlocks when the whole pipeline is full
    error,  ///< halts the clock
};

/// The order in which an edge's tests are evaluated.
enum class TestOrder {
    parallel,     ///< the paper's: all at once
    cheap_first,  ///< tests without a table first; the others only if the decision still depends on them
};

template <>
inline constexpr auto choice_names<TriangleOrder> = names_in_order<TriangleOrder>("fifo", "lifo");
template <>
inline constexpr auto choice_names<QueueOverflow> = names_in_order<QueueOverflow>("spill", "stall", "error");
template <>
inline constexpr auto choice_names<TestOrder> = names_in_order<TestOrder>("parallel", "cheap_first");
template <>
inline constexpr auto choice_names<Work> = names_in_order<Work>("triangle", "family");
template <>
inline constexpr auto choice_names<Interleave> = names_in_order<Interleave>("entry", "xor");

/// Empty if there is no such enumerator.
template <typename Enum, typename = std::enable_if_t<std::is_enum_v<Enum>>>
constexpr std::string_view name_of(Enum value) {
    const auto number = static_cast<std::size_t>(value);
    return number < choice_names<Enum>.size() ? choice_names<Enum>[number] : std::string_view{};
}
/// Empty if there is no such test.
inline std::string_view name_of(datapath::HeightTest value) {
    const auto number = static_cast<std::size_t>(value);
    return number < datapath::height_tests().size() ? datapath::height_tests()[number]->name : std::string_view{};
}

}  // namespace tessera
