#pragma once
#include <string_view>
#include <vector>

#include "modules/timing/design_choices.h"
#include "testbench/job/job.h"

namespace tessera {

// The names in a job file of the enumerators of job.h, besides those of modules/timing/design_choices.h. One switch per
// enumeration, so that the compiler reports an enumerator without a name.

constexpr std::string_view name_of(MeshSource value) {
    switch (value) {
        case MeshSource::plane: return "plane";
        case MeshSource::cylinder: return "cylinder";
        case MeshSource::sphere: return "sphere";
        case MeshSource::file: return "file";
        case MeshSource::run: return "run";
        case MeshSource::lattice: return "lattice";
    }
    return {};
}

constexpr std::string_view name_of(MapSource value) {
    switch (value) {
        case MapSource::half_donut: return "half_donut";
        case MapSource::text: return "text";
        case MapSource::noise: return "noise";
        case MapSource::constant: return "constant";
        case MapSource::ramp: return "ramp";
        case MapSource::file: return "file";
    }
    return {};
}

constexpr std::string_view name_of(MapHeights value) {
    switch (value) {
        case MapHeights::given: return "given";
        case MapHeights::fitted: return "fitted";
    }
    return {};
}

constexpr std::string_view name_of(Addressing value) {
    switch (value) {
        case Addressing::clamp: return "clamp";
        case Addressing::repeat: return "repeat";
    }
    return {};
}

constexpr std::string_view name_of(Triangulation value) {
    switch (value) {
        case Triangulation::shorter: return "shorter";
        case Triangulation::first: return "first";
        case Triangulation::second: return "second";
        case Triangulation::greatest_rank: return "greatest_rank";
    }
    return {};
}

constexpr std::string_view name_of(MapFilter value) {
    switch (value) {
        case MapFilter::nearest: return "nearest";
        case MapFilter::bilinear: return "bilinear";
    }
    return {};
}

constexpr std::string_view name_of(DesignPreset value) {
    switch (value) {
        case DesignPreset::paper: return "paper";
        case DesignPreset::modern: return "modern";
    }
    return {};
}

constexpr std::string_view name_of(Culling value) {
    switch (value) {
        case Culling::none: return "none";
        case Culling::back: return "back";
    }
    return {};
}

constexpr std::string_view name_of(RankView value) {
    switch (value) {
        case RankView::none: return "none";
        case RankView::per_point: return "per_point";
        case RankView::per_pixel: return "per_pixel";
    }
    return {};
}

constexpr std::string_view name_of(MipmapFilter value) {
    switch (value) {
        case MipmapFilter::mean: return "mean";
        case MipmapFilter::maximum: return "maximum";
    }
    return {};
}

constexpr std::string_view name_of(SummedHeightUnit value) {
    switch (value) {
        case SummedHeightUnit::sum: return "sum";
        case SummedHeightUnit::area: return "area";
    }
    return {};
}

constexpr std::string_view name_of(Mode value) {
    switch (value) {
        case Mode::functional: return "functional";
        case Mode::timed: return "timed";
    }
    return {};
}

/// All names of an enumeration, in the enumerators' order; enumerators count from 0 without gaps.
template <typename Enum>
std::vector<std::string_view> names_of() {
    std::vector<std::string_view> names;
    for (int i = 0; !name_of(static_cast<Enum>(i)).empty(); ++i)
        names.push_back(name_of(static_cast<Enum>(i)));
    return names;
}

}  // namespace tessera
