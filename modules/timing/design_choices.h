#pragma once
#include <cstddef>
#include <string_view>

#include "modules/datapath/height_tests.h"
#include "modules/timing/timing.h"
#include "modules/timing/work.h"

namespace tessera {

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

// The enumerators' names in job files. One switch per enumeration, so that the compiler refuses an enumerator without a
// name.

/// Empty if there is no such test.
inline std::string_view name_of(datapath::HeightTest value) {
    const auto number = static_cast<std::size_t>(value);
    return number < datapath::height_tests().size() ? datapath::height_tests()[number]->name : std::string_view{};
}

constexpr std::string_view name_of(TriangleOrder value) {
    switch (value) {
        case TriangleOrder::fifo: return "fifo";
        case TriangleOrder::lifo: return "lifo";
    }
    return {};
}

constexpr std::string_view name_of(QueueOverflow value) {
    switch (value) {
        case QueueOverflow::spill: return "spill";
        case QueueOverflow::stall: return "stall";
        case QueueOverflow::error: return "error";
    }
    return {};
}

constexpr std::string_view name_of(Work value) {
    switch (value) {
        case Work::triangle: return "triangle";
        case Work::family: return "family";
    }
    return {};
}

constexpr std::string_view name_of(TestOrder value) {
    switch (value) {
        case TestOrder::parallel: return "parallel";
        case TestOrder::cheap_first: return "cheap_first";
    }
    return {};
}

constexpr std::string_view name_of(Interleave value) {
    switch (value) {
        case Interleave::entry: return "entry";
        case Interleave::exclusive_or: return "xor";
    }
    return {};
}

}  // namespace tessera
