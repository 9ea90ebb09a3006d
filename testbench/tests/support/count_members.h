#pragma once
#include <cstddef>
#include <tuple>
#include <type_traits>

namespace tessera::testing {

/// Converts to any member, to count an aggregate's members.
struct Anything {
    template <typename T>
    operator T() const;
};

template <typename Aggregate, typename Members, typename = void>
struct CanHold : std::false_type {};
template <typename Aggregate, typename... Members>
struct CanHold<Aggregate, std::tuple<Members...>, std::void_t<decltype(Aggregate{Members{}...})>> : std::true_type {};

/// How many members an aggregate has; an array is one.
template <typename Aggregate, typename... Members>
constexpr std::size_t count_members() {
    if constexpr (CanHold<Aggregate, std::tuple<Members..., Anything>>::value)
        return count_members<Aggregate, Members..., Anything>();
    else
        return sizeof...(Members);
}

}  // namespace tessera::testing
