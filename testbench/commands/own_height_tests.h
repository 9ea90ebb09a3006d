#pragma once
#include "modules/datapath/height_test.h"
#include "modules/version.h"
#include "testbench/check/conformance/height_test_check.h"
#include "testbench/setup/height_tests/height_test_host.h"

namespace tessera {

/// A height test from a folder of one's own, in a shared library (testbench/examples/height_test).
struct OwnHeightTest {
    const char* version;  ///< of the headers it is compiled with
    const datapath::HeightTestFunctions* functions;
    const HeightTestHost* host;
    const HeightTestCheck* check;
};

/// Loads the libraries that the environment variable TESSERA_HEIGHT_TESTS names, separated by colons, and adds their
/// tests to the program. Call it before any job is made. Throws InputError.
void load_own_height_tests();

}  // namespace tessera

/// Defines the function by which the program finds the library's test, from its three parts.
#define TESSERA_HEIGHT_TEST(functions, host, check)                                                        \
    extern "C" __attribute__((visibility("default"))) const tessera::OwnHeightTest* tessera_height_test(); \
    extern "C" const tessera::OwnHeightTest* tessera_height_test() {                                       \
        static const tessera::OwnHeightTest test{tessera::version, &(functions), &(host), &(check)};       \
        return &test;                                                                                      \
    }
