#include "testbench/tests/support/catch_runner.h"

int main(int argc, char** argv) {
    return run_cases(argc, argv);
}
