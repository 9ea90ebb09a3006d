#include "modules/units/tessellation_tests/view_test.h"

#include <algorithm>

#include "modules/datapath/edge_tests.h"

namespace tessera {

ViewTest::ViewTest(const sc_core::sc_module_name& name, const datapath::Registers& registers,
                   const Timing& timing)
    : sc_module(name), registers_(registers), latency_(timing.cycle * timing.view_test.latency) {
    input.register_b_transport(this, &ViewTest::b_transport);
    from_transform.register_b_transport(this, &ViewTest::b_transport_from_transform);
}

void ViewTest::b_transport_from_transform(datapath::TrianglePass& pass, sc_core::sc_time& delay) {
    on_screen_ = &pass;
    on_screen_delay_ = delay;
}

void ViewTest::b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay) {
    if (pass.new_vertices != 0) {
        if (on_screen_ != &pass)
            SC_REPORT_ERROR("tessera/view_test", "a base triangle's edges came before its screen positions");
        on_screen_ = nullptr;
        delay = std::max(delay, on_screen_delay_);
    }
    for (int k = 0; k < 3; ++k) {
        if (!registers_.tests.view_test ||
            view_test(pass.edge_begin(k).screen, pass.edge_end(k).screen, registers_.tests))
            pass.edges[static_cast<std::size_t>(k)].tests |= datapath::view_bit;
    }
    delay += latency_;
}

}  // namespace tessera
