#pragma once
#include <cstdint>

/// Calls of operator new so far in this program.
std::uint64_t allocations_so_far();
