#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

#include "modules/stage/stage_steps.h"
#include "testbench/tests/modules/named_machine.h"
#include "testbench/tests/modules/unit_behind.h"
#include "testbench/tests/support/timed_checks.h"
#include "testbench/tests/support/timed_modules.h"

// A unit that is not part of the machine, inserted into a stream from outside modules/, written only from
// modules/README.md.

using namespace tessera;
using namespace tessera::testing;

namespace {

/// A pass-through between Displace Vertex and Transform: forwards each item unchanged.
///
/// In:   DisplacedPoint. Out: the same.
/// Timing: one vertex, normal or edge per interval; latency 3, interval 1.
/// Waits for Displace Vertex; blocked by Transform.
class PassThrough : public Stage<DisplacedPoint, DisplacedPoint> {
  public:
    static constexpr UnitTiming timing{3, 1, 1};  // latency, interval, buffer

    StreamInput<DisplacedPoint> input{"input"};
    StreamOutput<DisplacedPoint> output{"output"};

    PassThrough(const sc_core::sc_module_name& name, const UnitContext& context) : Stage(name, context, timing) {
        takes_from(context, input);
        delivers_to(context, output);
    }

  protected:
    DisplacedPoint process(const DisplacedPoint& point, const Entries&) override { return point; }
};

using PassThroughUnits = UnitBehind<DisplaceVertex, PassThrough>;

}  // namespace

TEST_CASE("pass-through alone: items leave unchanged, three cycles later, one per cycle") {
    CycleScheduler clock("clock", sc_core::sc_time(5, sc_core::SC_NS));
    const datapath::Registers registers{};
    Design design;
    design.transport = Transport::non_blocking;
    design.packed_streams = false;
    Driver<DisplacedPoint> driver("driver", clock);
    PassThrough unit("pass_through", {clock, registers, design});
    clock.attach(unit);
    Sink<DisplacedPoint> sink("sink", clock);
    driver.out.bind(unit.input);
    unit.output.bind(sink.in);
    driver.items.resize(4);
    for (std::uint8_t k = 0; k < 4; ++k)
        driver.items[k].tag.part = k;
    sc_core::sc_start();
    CHECK(sink.cycles == std::vector<std::uint64_t>{3, 4, 5, 6});
    REQUIRE(sink.items.size() == 4);
    for (std::uint8_t k = 0; k < 4; ++k)
        CHECK(sink.items[k].tag.part == k);
}

// test_one_triangle.cpp's derivation with D + 3 instead of D: V = 34, W = S = 35, J = 35 + 11 + 1 + 3 = 50; the normals
// pass it once more: 38 + 3. Cycle 91. Nine parts, three cycles each.
TEST_CASE("pass-through: one triangle takes 92 cycles instead of 86") {
    const MachineSetup setup = one_triangle();
    PassThroughUnits units;
    NamedMachine own("own", setup);
    NamedMachine machine("machine", setup, &units);
    sc_core::sc_start();
    CHECK(own.cycles() == 86);
    CHECK(machine.cycles() == 92);
    const Activity& activity = units.inserted().activity();
    CHECK(activity.items_out() == 9);
    CHECK(activity.item_cycles() == 9 * PassThrough::timing.latency);
    CHECK(activity.cycles_in(State::blocked) == 0);
    expect_bare_mesh(machine);
}
