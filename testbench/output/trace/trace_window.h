#pragma once
#include <cstdint>

namespace tessera {

/// First and last clock cycle of a trace, inclusive; all cycles by default, none if last is before first.
struct TraceWindow {
    std::uint64_t first = 0;
    std::uint64_t last = UINT64_MAX;
};

}  // namespace tessera
