#pragma once
#include <cstdint>

#include "testbench/prove/random_machines/random_case.h"

namespace tessera {

/// A random case (random_case.h) turned into a design that has a schedule, with the timing of every unit and memory
/// drawn from the seed.
RandomCase make_scheduled_case(std::uint64_t seed);

}  // namespace tessera
