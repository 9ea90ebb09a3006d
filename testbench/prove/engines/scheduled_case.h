#pragma once
#include <cstdint>

#include "testbench/prove/random_machines/random_case.h"

namespace tessera {

/// A random case (random_case.h), made into a design that has a schedule, with figures of every unit and memory that
/// follow from the seed.
RandomCase make_scheduled_case(std::uint64_t seed);

}  // namespace tessera
