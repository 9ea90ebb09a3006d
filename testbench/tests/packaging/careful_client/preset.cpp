#include <iostream>

#include "modules/cci/design_parameters.h"

// The example of modules/README.md: prints the preset latency.
int sc_main(int, char**) {
    cci_utils::broker global("global");
    cci::cci_register_broker(global);
    cci::cci_broker_handle broker = cci::cci_get_global_broker(cci::cci_originator("platform"));
    broker.set_preset_cci_value("device.mode", cci::cci_value("timed"));
    broker.set_preset_cci_value("device.timing.normal_test_latency", cci::cci_value(12));
    const tessera::DesignParameters parameters("device");
    std::cout << parameters.design().timing.normal_test.latency << '\n';
    return parameters.design().transport == tessera::Transport::non_blocking ? 0 : 1;
}
