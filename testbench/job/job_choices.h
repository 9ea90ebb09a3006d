#pragma once
#include <string_view>
#include <vector>

#include "modules/timing/design_choices.h"
#include "testbench/job/job.h"

namespace tessera {

// The enumerations of job.h, besides those of modules/timing/design_choices.h.
template <>
inline constexpr auto choice_names<MeshSource> = names_in_order<MeshSource>("plane", "cylinder", "sphere", "file",
                                                                            "run", "lattice");
template <>
inline constexpr auto choice_names<MapSource> = names_in_order<MapSource>("half_donut", "text", "noise", "constant",
                                                                          "ramp", "file");
template <>
inline constexpr auto choice_names<MapHeights> = names_in_order<MapHeights>("given", "fitted");
template <>
inline constexpr auto choice_names<Addressing> = names_in_order<Addressing>("clamp", "repeat");
template <>
inline constexpr auto choice_names<Triangulation> = names_in_order<Triangulation>("shorter", "first", "second",
                                                                                  "greatest_rank");
template <>
inline constexpr auto choice_names<MapFilter> = names_in_order<MapFilter>("nearest", "bilinear");
template <>
inline constexpr auto choice_names<DesignPreset> = names_in_order<DesignPreset>("paper", "modern");
template <>
inline constexpr auto choice_names<Culling> = names_in_order<Culling>("none", "back");
template <>
inline constexpr auto choice_names<RankView> = names_in_order<RankView>("none", "per_point", "per_pixel");
template <>
inline constexpr auto choice_names<MipmapFilter> = names_in_order<MipmapFilter>("mean", "maximum");
template <>
inline constexpr auto choice_names<SummedHeightUnit> = names_in_order<SummedHeightUnit>("sum", "area");
template <>
inline constexpr auto choice_names<Mode> = names_in_order<Mode>("functional", "timed");

/// All names of an enumeration, in the enumerators' order; enumerators count from 0 without gaps.
template <typename Enum>
std::vector<std::string_view> names_of() {
    std::vector<std::string_view> names;
    for (int i = 0; !name_of(static_cast<Enum>(i)).empty(); ++i)
        names.push_back(name_of(static_cast<Enum>(i)));
    return names;
}

}  // namespace tessera
