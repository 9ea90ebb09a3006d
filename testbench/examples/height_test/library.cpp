#include "check.h"
#include "host.h"
#include "range_test.h"
#include "testbench/commands/own_height_tests.h"

namespace {

const range_test::RangeTest functions;
const range_test::RangeHost host;
const range_test::RangeCheck check;

}  // namespace

TESSERA_HEIGHT_TEST(functions, host, check)
