#pragma once
#include <cstdint>

namespace tessera {

/// The clock cycles a trace shows, both included; all of them by default, none if last is before first.
struct TraceWindow {
    std::uint64_t first = 0;
    std::uint64_t last = UINT64_MAX;
};

}  // namespace tessera
