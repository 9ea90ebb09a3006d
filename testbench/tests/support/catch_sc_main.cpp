#include <cstdlib>
#include <systemc>

#include "testbench/tests/support/catch_runner.h"

int sc_main(int argc, char** argv) {
    return run_cases(argc, argv);
}

int main(int argc, char** argv) {
    setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 0);
    return sc_core::sc_elab_and_sim(argc, argv);
}
