#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include "testbench/tests/support/catch_runner.h"

int run_cases(int argc, char** argv) {
    return Catch::Session().run(argc, argv);
}
