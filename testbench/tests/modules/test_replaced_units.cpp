#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <typeinfo>
#include <utility>
#include <vector>

#include "modules/sockets/packed_item.h"
#include "modules/stage/stage_steps.h"
#include "modules/units/family/tessellation.h"
#include "testbench/tests/modules/named_machine.h"
#include "testbench/tests/modules/rtl_displace_vertex.h"
#include "testbench/tests/modules/unit_behind.h"
#include "testbench/tests/support/timed_checks.h"
#include "testbench/tests/support/timed_modules.h"

// Units replaced from outside modules/ (modules/README.md, "How to replace a unit"): by another formula, by a model
// that uses only packed items, by the same unit in another context.

using namespace tessera;
using namespace tessera::testing;

namespace {

/// Compares half the difference: a comparator one bit narrower. The machine's own test decides the same with twice the
/// threshold plus one.
class HalvedHeightTest : public datapath::SummedHeightTest {
  public:
    void decide(const datapath::HeightEdge& edge, const Entries& entries, const datapath::Registers& registers,
                datapath::HeightDecision& decision) const override {
        SummedHeightTest::decide(edge, entries, registers, decision);
        const std::uint64_t difference = decision.values[static_cast<std::size_t>(compared)];
        decision.asks = difference / 2 > limit(weight(decision), registers.tests);
    }
};

class HalvedHeights : public UnitFactory {
  public:
    std::vector<const HeightTestUnit*> halved;

    HalvedHeights() {
        replace<HeightTestUnit>([this](Name name, const UnitContext& context) {
            static const HalvedHeightTest test{};
            auto unit = std::make_unique<HeightTestUnit>(name, context, test);
            halved.push_back(unit.get());
            return unit;
        });
    }
};

/// Displace Vertex as in another language: items as bits, cycle by cycle.
class PackedDisplaceVertex : public DisplaceVertex {
  public:
    PackedDisplaceVertex(const sc_core::sc_module_name& name, const UnitContext& context)
        : DisplaceVertex(name, context),
          tag_bits_(tag_bits_in_use(context.design)),
          rtl_(context.registers, tag_bits_, timing_.latency,
               register_stages(timing_, 1, context.timing().displacement_map.latency)) {}

    std::string describe_contents() const override {
        return count_of(rtl_.items() + from_calculate_new_p.size(), "item");
    }

  protected:
    // Functional mode.
    void reads(const BasePoint& point, Reads& reads) const override {
        if (const auto address = rtl_.address(wires_of(point)))
            reads.add(*address);
    }
    DisplacedPoint process(const BasePoint& point, const Entries& codes) override {
        return item_of(rtl_.result(wires_of(point), codes[0]), point.tag.origin);
    }

    // Timed mode. May be called several times in a cycle; the model's clock ticks once.
    void step() override {
        const std::uint64_t cycle = clock_.last_cycle();
        if (cycle != edge_)
            rtl_.clock_edge();
        edge_ = cycle;
        while (displacement_map.answered()) {
            rtl_.answer(displacement_map.entry(0));
            displacement_map.pop_answer();
        }
        while (rtl_.valid() && deliver()) {
            rtl_.take();
            origins_.pop_front();
            activity_.item_out(cycle);
        }
        while (!from_calculate_new_p.empty() && rtl_.ready() && displacement_map.may_request()) {
            origins_.push_back(from_calculate_new_p.front().tag.origin);
            if (const auto address = rtl_.put(wires_of(from_calculate_new_p.front())))
                displacement_map.request(*address);
            from_calculate_new_p.pop();
            activity_.item_in(cycle);
        }
        if (rtl_.valid())
            activity_.set(cycle, State::blocked, to_transform.consumer());
        else if (rtl_.first_lacks_its_code())
            activity_.set(cycle, State::waiting_for_memory, displacement_map.memory());
        else if (rtl_.items() > 0 || !from_calculate_new_p.empty())
            activity_.set(cycle, State::busy);
        else
            activity_.set(cycle, State::starved);
        if (rtl_.counts())
            wake_at(cycle + 1);
    }

  private:
    /// An offered item stays where it is until it is taken.
    bool deliver() {
        if (!offered_)
            out_ = item_of(rtl_.out(), origins_.front());
        offered_ = !to_transform.deliver(out_);
        return !offered_;
    }
    Wires wires_of(const BasePoint& point) const {
        const datapath::Formats& formats = registers_.formats;
        PackedItem packed;
        if (!pack_item(point, formats, tag_bits_, packed))
            SC_REPORT_ERROR("tessera/packed_displace_vertex", name());
        std::vector<bool> bits(item_bits<BasePoint>(formats, tag_bits_));
        for (std::size_t k = 0; k < bits.size(); ++k)
            bits[k] = (packed.bytes[k / 8] >> k % 8 & 1) != 0;
        return Wires(std::move(bits));
    }
    DisplacedPoint item_of(const Wires& wires, const Origin& origin) {
        saturations_ = rtl_.saturations;
        PackedItem packed;
        for (std::size_t k = 0; k < wires.size(); ++k)
            packed.bytes[k / 8] |= static_cast<unsigned char>(wires[k] << k % 8);
        auto point = unpack_item<DisplacedPoint>(packed, registers_.formats, tag_bits_);
        point.tag.origin = origin;
        return point;
    }

    int tag_bits_;
    RtlDisplaceVertex rtl_;
    std::deque<Origin> origins_;  // those of the items in it, which have no wires
    std::uint64_t edge_ = 0;      // the cycle of the last clock edge
    DisplacedPoint out_;
    bool offered_ = false;
};

struct PackedDisplaceVertices : UnitFactory {
    PackedDisplaceVertices() { replace<DisplaceVertex, PackedDisplaceVertex>(); }
};

/// Stalls only the Summed Height Test.
struct StalledHeights : UnitFactory {
    StalledHeights() {
        replace<HeightTestUnit>([](Name name, const UnitContext& context) {
            Design design = context.design;
            design.timing.stalls = {7, 300, 100};
            return std::make_unique<HeightTestUnit>(name, context.with(design));
        });
    }
};

/// Changes the registers of the Summed Height Test only.
struct OtherThreshold : UnitFactory {
    explicit OtherThreshold(const datapath::Registers& registers) {
        replace<HeightTestUnit>([&registers](Name name, const UnitContext& context) {
            return std::make_unique<HeightTestUnit>(name, context.with(registers));
        });
    }
};

/// Changes the latency of Calculate New P only.
struct SlowCalculateNewP : UnitFactory {
    SlowCalculateNewP() {
        replace<CalculateNewP>([](Name name, const UnitContext& context) {
            Design design = context.design;
            design.timing.calculate_new_p.latency = 200;
            return std::make_unique<CalculateNewP>(name, context.with(design));
        });
    }
};

/// An additional unit: halves the light of every corner.
class HalfLight : public Stage<LitTriangle, LitTriangle> {
  public:
    static constexpr UnitTiming timing{3, 2, 4};  // latency, interval, buffer

    StreamInput<LitTriangle> input{"input"};
    StreamOutput<LitTriangle> output{"output"};

    HalfLight(const sc_core::sc_module_name& name, const UnitContext& context) : Stage(name, context, timing) {
        takes_from(context, input);
        delivers_to(context, output);
    }

  private:
    LitTriangle process(const LitTriangle& triangle, const Entries&) override {
        LitTriangle half = triangle;
        for (LitTriangle::Corner& corner : half.corners)
            corner.intensity /= 2;
        return half;
    }
};

using HalfLitUnits = UnitBehind<Lighting, HalfLight>;

struct LitTriangles : tlm::tlm_analysis_if<LitTriangle> {
    std::vector<LitTriangle> all;
    void write(const LitTriangle& triangle) override { all.push_back(triangle); }
};

/// The objects below `root` with exactly this type.
template <class Type>
unsigned count_below(const sc_core::sc_object& root) {
    unsigned count = 0;
    for (const sc_core::sc_object* child : root.get_child_objects())
        count += (typeid(*child) == typeid(Type) ? 1 : 0) + count_below<Type>(*child);
    return count;
}

Job in_mode(Mode mode, Job job = {}) {
    job.mode = mode;
    return job;
}

/// Requires equal numbers of cycles in each state of each unit.
void expect_same_cycles(NamedMachine& left, NamedMachine& right) {
    CHECK(left.cycles() == right.cycles());
    for (std::size_t k = 0; k < left.machine.units().size(); ++k) {
        Unit& one = *left.machine.units()[k];
        Unit& other = *right.machine.units()[k];
        INFO(one.name());
        one.activity().finish(left.cycles());
        other.activity().finish(right.cycles());
        CHECK(one.activity().items_in() == other.activity().items_in());
        for (const State state : {State::starved, State::busy, State::waiting_for_memory, State::blocked})
            CHECK(one.activity().cycles_in(state) == other.activity().cycles_in(state));
    }
}

/// Registers with which the machine's own Summed Height Test decides as the halved one.
MachineSetup equal_to_halved(MachineSetup setup) {
    std::int64_t& threshold = setup.registers.tests.height_thresholds[0];
    threshold = 2 * threshold + 1;
    return setup;
}

/// Compares the halved test's machine with one of equivalent registers.
void expect_halved_test(const Job& job) {
    const MachineSetup setup = setup_of(job);
    const MachineSetup equal = equal_to_halved(setup);
    HalvedHeights units;
    NamedMachine halved("halved", setup, &units);
    NamedMachine own("own", equal);
    sc_core::sc_start();

    const unsigned tests_units = setup.design.tests_units;
    CHECK(units.halved.size() == tests_units);
    CHECK(count_below<HeightTestUnit>(halved) == tests_units);
    CHECK(count_below<HeightTestUnit>(own) == tests_units);
    const auto* const unit = sc_core::sc_find_object("halved.pipeline.tessellation_tests_0.summed_height_test");
    REQUIRE(unit != nullptr);
    CHECK(unit == units.halved[0]);
    CHECK(unit == &halved.machine.tessellation_tests[0].height_test);

    const EmittedMesh expected = bare_mesh(equal);
    CHECK(expected.triangles.size() < bare_mesh(setup).triangles.size());
    expect_mesh(halved, expected);
    expect_mesh(own, expected);
    if (job.mode == Mode::timed)
        expect_same_cycles(halved, own);
}

/// Returns the number of cycles in which the packed unit was blocked.
std::uint64_t expect_same_as_packed(const MachineSetup& setup) {
    PackedDisplaceVertices units;
    NamedMachine packed("packed", setup, &units);
    NamedMachine own("own", setup);
    sc_core::sc_start();
    CHECK(count_below<PackedDisplaceVertex>(packed) == 1);
    CHECK(count_below<DisplaceVertex>(packed) == 0);
    const EmittedMesh expected = bare_mesh(setup);
    expect_mesh(packed, expected);
    expect_mesh(own, expected);
    CHECK(packed.machine.displacement_map_reads() == own.machine.displacement_map_reads());
    if (setup.design.transport == Transport::non_blocking)
        expect_same_cycles(packed, own);
    return packed.machine.displace_vertex.activity().cycles_in(State::blocked);
}

/// Three Tessellation Tests units, a queue that spills, the Highlight Test.
Job packed_streams_job(Mode mode) {
    Job job = full_split_job(2, 3);
    job.mode = mode;
    job.hardware.tests_units = 3;
    job.hardware.queue.capacity = 8;
    job.tests.highlight = true;
    job.tests.highlight_angle = 60;
    return job;
}

void expect_same_through_packed_streams(Mode mode) {
    MachineSetup plain = setup_of(packed_streams_job(mode));
    plain.design.packed_streams = false;
    MachineSetup packed = plain;
    packed.design.packed_streams = true;
    NamedMachine plain_machine("plain", plain);
    NamedMachine packed_machine("packed", packed);
    sc_core::sc_start();
    const EmittedMesh expected = bare_mesh(plain);
    CHECK(expected.has_highlight_splits());
    expect_mesh(plain_machine, expected);
    expect_mesh(packed_machine, expected);
    if (mode == Mode::functional)
        return;
    expect_same_cycles(packed_machine, plain_machine);
    CHECK(packed_machine.machine.triangle_queue.spilled() > 0);
}

}  // namespace

TEST_CASE("a replaced unit that the design does not have is warned of") {
    struct OtherDesigns : UnitFactory {
        OtherDesigns() { replace<FamilyTessellation, FamilyTessellation>(); }
    } units;
    const auto warnings = [] { return sc_core::sc_report_handler::get_count(sc_core::SC_WARNING); };
    const auto before = warnings();
    const MachineSetup paper = setup_of(in_mode(Mode::timed));
    NamedMachine machine("machine", paper, &units);
    CHECK(warnings() == before + 1);
    MachineSetup modern = paper;
    modern.design.work = Work::family;
    modern.registers.formats.families = true;
    NamedMachine other("other", modern, &units);
    CHECK(warnings() == before + 1);
}

TEST_CASE("replaced unit: a modified Summed Height Test, functional mode") {
    expect_halved_test(in_mode(Mode::functional));
}

TEST_CASE("replaced unit: a modified Summed Height Test in each of three Tessellation Tests units") {
    Job job = timed_job();
    job.hardware.tests_units = 3;
    expect_halved_test(job);
}

TEST_CASE("replaced unit: Displace Vertex on packed items, the same mesh and the same cycles") {
    expect_same_as_packed(setup_of(timed_job()));
}

TEST_CASE("replaced unit: Displace Vertex on packed items, functional mode") {
    expect_same_as_packed(setup_of(in_mode(Mode::functional, full_split_job(2, 3))));
}

TEST_CASE("replaced unit: Displace Vertex on packed items, other widths, a slow map, blocked by Transform") {
    Job job = full_split_job(2, 3);
    job.formats.position_bits = 27;
    job.formats.normal_bits = 13;
    job.formats.normal_fraction = 11;
    job.timing.displacement_map.latency = 5;
    MachineSetup setup = setup_of(job);
    setup.design.timing.displace_vertex.buffer = 3;
    setup.design.timing.transform = {20, 40, 1};
    CHECK(expect_same_as_packed(setup) > 0);
}

TEST_CASE("packed streams: the same mesh and the same cycles, timed mode") {
    expect_same_through_packed_streams(Mode::timed);
}

TEST_CASE("packed streams: the same mesh, functional mode") {
    expect_same_through_packed_streams(Mode::functional);
}

TEST_CASE("replaced unit: a standard unit, with registers of its own") {
    const MachineSetup setup = setup_of(in_mode(Mode::functional));
    const MachineSetup equal = equal_to_halved(setup);
    OtherThreshold units(equal.registers);
    NamedMachine machine("machine", setup, &units);
    sc_core::sc_start();
    expect_mesh(machine, bare_mesh(equal));
}

TEST_CASE("replaced unit: a standard unit, with stalls or a latency of its own") {
    const MachineSetup setup = setup_of(full_split_job(2, 3));
    StalledHeights stalled_units;
    SlowCalculateNewP slow_units;
    NamedMachine own("own", setup);
    NamedMachine stalled("stalled", setup, &stalled_units);
    NamedMachine slow("slow", setup, &slow_units);
    sc_core::sc_start();
    const EmittedMesh expected = bare_mesh(setup);
    for (const NamedMachine* machine : {&own, &stalled, &slow})
        expect_mesh(*machine, expected);
    CHECK(stalled.cycles() > own.cycles());
    CHECK(slow.cycles() > own.cycles());
}

TEST_CASE("a unit interposed on a stream: light is halved, the run is longer by its latency") {
    const MachineSetup timed_setup = setup_of(full_split_job(2, 2));
    const MachineSetup functional_setup = setup_of(in_mode(Mode::functional, full_split_job(2, 2)));
    HalfLitUnits timed_units, functional_units;
    NamedMachine own("own", timed_setup);
    NamedMachine timed("timed", timed_setup, &timed_units);
    NamedMachine functional("functional", functional_setup, &functional_units);
    LitTriangles full, half, functional_half;
    own.rasteriser.taken.bind(full);
    timed.rasteriser.taken.bind(half);
    functional.rasteriser.taken.bind(functional_half);
    sc_core::sc_start();
    for (const NamedMachine* machine : {&own, &timed, &functional})
        expect_mesh(*machine, bare_mesh(timed_setup));
    CHECK(timed.cycles() == own.cycles() + HalfLight::timing.latency);
    REQUIRE(half.all.size() == full.all.size());
    CHECK(functional_half.all.size() == full.all.size());
    std::uint64_t light = 0;
    for (std::size_t k = 0; k < full.all.size(); ++k)
        for (std::size_t c = 0; c < 3; ++c) {
            CHECK(half.all[k].corners[c].intensity == full.all[k].corners[c].intensity / 2);
            light += full.all[k].corners[c].intensity;
        }
    CHECK(light > 0);
}
