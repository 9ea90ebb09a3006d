#pragma once
#include "testbench/common/random.h"

namespace tessera::testing {

using tessera::Random;

}  // namespace tessera::testing
