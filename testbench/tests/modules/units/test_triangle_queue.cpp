#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <vector>

#include "modules/datapath/pack_triangle.h"
#include "modules/memories/off_chip_memory.h"
#include "modules/units/triangle_queue.h"
#include "testbench/tests/support/timed_modules.h"

// The Triangle Queue alone, spilling: everything that enters leaves, and first in first out in that order.

using namespace tessera;
using namespace tessera::testing;

namespace {

constexpr unsigned triangles = 600;

/// A queue of a few places between a driver that pauses and a sink that stalls.
struct Bench {
    Design all;
    Sink<datapath::Triangle> sink;
    Sink<QueueLevel> level;
    OffChipMemory memory;
    TriangleQueue queue;
    Driver<datapath::Triangle> driver;

    Bench(const std::string& name, CycleScheduler& clock, const datapath::Registers& registers,
          const QueueDesign& design, std::uint64_t seed, const StallParameters& sink_stalls,
          const StallParameters& level_stalls = {})
        : all(with(design)),
          sink(("sink_" + name).c_str(), clock, sink_stalls),
          level(("level_" + name).c_str(), clock, level_stalls),
          memory(("memory_" + name).c_str(), clock, OffChipTiming{}, {}, std::uint64_t{1} << 20,
                 datapath::packed_triangle_tag_bytes),
          queue(("queue_" + name).c_str(), {clock, registers, all}),
          driver(("driver_" + name).c_str(), clock,
                 sink_stalls.per_mille == 0 ? StallParameters{} : StallParameters{seed + 1, 250, 120}) {
        clock.attach(memory);
        clock.attach(queue);
        driver.out.bind(queue.from_tessellation);
        queue.to_get_triangle.bind(sink.in);
        queue.level.bind(level.in);
        queue.off_chip_memory.bind(memory);
        for (unsigned k = 0; k < triangles; ++k) {
            datapath::Triangle triangle;
            triangle.base = k;
            driver.items.push_back(triangle);
        }
    }

    static Design with(const QueueDesign& queue) {
        Design design;
        design.queue = queue;
        return design;
    }

    std::vector<std::uint32_t> came() const {
        std::vector<std::uint32_t> tags;
        for (const datapath::Triangle& triangle : sink.items)
            tags.push_back(triangle.base);
        return tags;
    }
};

std::vector<std::uint32_t> in_order() {
    std::vector<std::uint32_t> tags;
    for (std::uint32_t k = 0; k < triangles; ++k)
        tags.push_back(k);
    return tags;
}

/// Eight queues with drivers and sinks of different seeds. spills: with 1 to 4 places on
/// chip.
std::vector<std::unique_ptr<Bench>> eight_benches(CycleScheduler& clock, const datapath::Registers& registers,
                                                  QueueDesign design, bool spills, unsigned level_stalls_per_mille) {
    std::vector<std::unique_ptr<Bench>> benches;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        design.capacity = spills ? 1 + seed % 4 : 0;
        benches.push_back(std::make_unique<Bench>(std::to_string(seed), clock, registers, design, 3 * seed,
                                                  StallParameters{3 * seed, 500, 12},
                                                  StallParameters{3 * seed + 2, level_stalls_per_mille, 100}));
    }
    return benches;
}

}  // namespace

TEST_CASE("triangle queue: first in first out, through off-chip memory and back") {
    CycleScheduler clock("clock", sc_core::sc_time(5, sc_core::SC_NS));
    const datapath::Registers registers;
    const auto benches = eight_benches(clock, registers, {}, true, 0);
    sc_core::sc_start();
    for (const auto& bench : benches) {
        INFO(bench->queue.name());
        CHECK(bench->queue.spilled() > 0);
        CHECK(bench->queue.spilled() < triangles);  // the off-chip part was empty now and then
        CHECK(bench->queue.spilled() == bench->queue.refilled());
        CHECK(bench->queue.on_chip_high_water_mark() == bench->all.queue.capacity + 1);  // and one on its way out
        CHECK(bench->came() == in_order());
    }
}

TEST_CASE("triangle queue: last in first out, through off-chip memory and back, no triangle is lost or duplicated") {
    CycleScheduler clock("clock", sc_core::sc_time(5, sc_core::SC_NS));
    const datapath::Registers registers;
    QueueDesign design;
    design.order = TriangleOrder::lifo;
    const auto benches = eight_benches(clock, registers, design, true, 0);
    sc_core::sc_start();
    for (const auto& bench : benches) {
        INFO(bench->queue.name());
        CHECK(bench->queue.spilled() > 0);
        std::vector<std::uint32_t> tags = bench->came();
        CHECK(tags != in_order());
        std::sort(tags.begin(), tags.end());
        CHECK(tags == in_order());
    }
}

// 40 triangles arrive, one per cycle, before the sink opens. Triangle 0 waits in the sink's input and 1 in the queue's
// output register; the newest are on chip, and all others off chip, the oldest of them written first. The newest leave,
// one per cycle from the opening on. As soon as half of the places are in use, or none, the newest triangle off chip is
// asked for, and another whenever one of capacity / 2 + 1 has left: 13 cycles of the channel for 197 bytes, 40 of latency.
TEST_CASE("triangle queue: last in first out, spilled triangles come back newest first, each in its cycle") {
    constexpr std::uint32_t all = 40;
    constexpr std::uint64_t opening = 2000, transfer = 13, round_trip = transfer + 40;
    CycleScheduler clock("clock", sc_core::sc_time(5, sc_core::SC_NS));
    const datapath::Registers registers;
    REQUIRE((datapath::packed_triangle_bytes(registers.formats) + 15) / 16 == transfer);
    std::vector<std::unique_ptr<Bench>> benches;
    for (const std::size_t capacity : {1U, 2U, 4U, 6U}) {
        QueueDesign design;
        design.order = TriangleOrder::lifo;
        design.capacity = capacity;
        benches.push_back(
            std::make_unique<Bench>(std::to_string(capacity), clock, registers, design, 0, StallParameters{}));
        benches.back()->driver.items.resize(all);
        benches.back()->sink.open_at(opening);
    }
    sc_core::sc_start();
    for (const auto& bench : benches) {
        const std::uint64_t capacity = bench->all.queue.capacity, spilled = all - 2 - capacity;
        CAPTURE(capacity);
        CHECK(bench->queue.spilled() == spilled);
        CHECK(bench->queue.refilled() == spilled);
        CHECK(bench->memory.bytes_written() == 197 * spilled);
        CHECK(bench->memory.bytes_read() == 197 * spilled);
        CHECK(bench->queue.on_chip_high_water_mark() == capacity + 1);
        CHECK(bench->queue.high_water_mark() == all - 1);
        std::vector<std::uint32_t> order{0, 1};
        std::vector<std::uint64_t> cycles{opening, opening};
        for (std::uint32_t k = all - 1; k > 1; --k)
            order.push_back(k);
        for (std::uint64_t k = 1; k <= capacity; ++k)
            cycles.push_back(opening + k);
        const std::uint64_t asked = opening + capacity - 1 - capacity / 2, under_way = capacity / 2 + 1;
        for (std::uint64_t k = 0; k < spilled; ++k)
            cycles.push_back(asked + round_trip + 1 + k / under_way * round_trip + k % under_way * transfer);
        CHECK(bench->came() == order);
        CHECK(bench->sink.cycles == cycles);
    }
}

TEST_CASE("triangle queue: a triangle that does not fit its record is an error, not another triangle") {
    CycleScheduler clock("clock", sc_core::sc_time(5, sc_core::SC_NS));
    const datapath::Registers registers;
    QueueDesign design;
    design.capacity = 1;
    Bench bench("spills", clock, registers, design, 0, StallParameters{1, 1000, 1000});
    for (datapath::Triangle& triangle : bench.driver.items)
        triangle.vertices[0].generation = 255;
    // In a debug build, which packs every item, its stream detects it first.
    CHECK_THAT(error_of([] { sc_core::sc_start(); }),
               Catch::Contains("a spilled triangle does not fit") ||
                   Catch::Contains("to_get_triangle: a value that does not fit its field"));
}

// The queue's output is not taken for far longer than the test runs.
TEST_CASE("triangle queue: the host may send while fewer triangles wait than the watermark") {
    CycleScheduler clock("clock", sc_core::sc_time(5, sc_core::SC_NS));
    const datapath::Registers registers;
    std::vector<std::unique_ptr<Bench>> benches;
    for (unsigned waiting = 0; waiting < 5; ++waiting) {
        QueueDesign design;
        design.watermark = 3;
        benches.push_back(std::make_unique<Bench>(std::to_string(waiting), clock, registers, design, 0,
                                                  StallParameters{1, 1000, 1'000'000}));
        benches.back()->driver.items.resize(waiting);
    }
    sc_core::sc_start(sc_core::sc_time(100 * triangles, sc_core::SC_NS));
    for (unsigned waiting = 0; waiting < 5; ++waiting) {
        const TriangleQueue& queue = benches[waiting]->queue;
        INFO(queue.name());
        REQUIRE(queue.waiting() == waiting);
        CHECK(queue.below_watermark() == (waiting < 3));
        CHECK(benches[waiting]->level.items.size() == (waiting < 3 ? 0 : 1));  // reported on each change
    }
}

// Get Triangle takes the level late: changes that it has not seen are not kept, but the last one is.
TEST_CASE("triangle queue: the last change of its level is reported, however late the earlier ones are taken") {
    CycleScheduler clock("clock", sc_core::sc_time(5, sc_core::SC_NS));
    const datapath::Registers registers;
    QueueDesign design;
    design.watermark = 2;
    const auto benches = eight_benches(clock, registers, design, false, 1000);
    sc_core::sc_start();
    for (const auto& bench : benches) {
        INFO(bench->queue.name());
        CHECK(bench->came() == in_order());
        const std::vector<QueueLevel>& levels = bench->level.items;
        REQUIRE(levels.size() > 2);
        CHECK(levels.back().below_watermark);
        for (std::size_t k = 1; k < levels.size(); ++k)
            CHECK(levels[k].below_watermark != levels[k - 1].below_watermark);
    }
}
