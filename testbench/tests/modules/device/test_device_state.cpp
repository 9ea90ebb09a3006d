#include "testbench/tests/modules/device/bench.h"
#include "testbench/tests/support/case_table.h"

// The device's registers over time: a reset while idle, the time of accesses, the error that is kept, status, counters,
// interrupts; and a bus that does not answer.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;
using sc_core::SC_MS;
using sc_core::SC_NS;
using sc_core::sc_time;
using sc_core::SC_US;

namespace {

/// A bench with one device, and the driver's calls in it.
struct OneDevice {
    MachineSetup setup;
    Bench bench;
    FramePlaces places;

    explicit OneDevice(bool timed, std::uint32_t ring_size = 5000, unsigned answer_cycles = 1'000'000)
        : setup(setup_of(small_job(timed))),
          bench({formats_of(setup)}, limited(design_of(setup), answer_cycles)),
          places(bench.place(setup, ring_size)) {}

    std::uint32_t word(std::uint32_t offset) {
        std::uint32_t value = 0;
        REQUIRE(bench.cpu.read32(Router::registers + offset, value) == 0);
        return value;
    }
    void set_word(std::uint32_t offset, std::uint32_t value) {
        REQUIRE(bench.cpu.write32(Router::registers + offset, value) == 0);
    }
    bool interrupt() {
        bench.cpu.pass(sc_time(1, SC_NS));
        return bench.interrupts[0]->read();
    }
    /// A frame that is refused.
    void start_without_ring() {
        set_word(offset::ring_size, 0);
        set_word(offset::control, control_start);
    }

  private:
    static DeviceDesign limited(DeviceDesign design, unsigned answer_cycles) {
        design.machine.answer_cycles = answer_cycles;
        return design;
    }
};

const BenchMode functional{"functional", false};
const BenchMode timed{"timed", true};

const CaseTable<BenchMode> idle_resets{
    "a reset of an idle device takes effect at once, and keeps its tables: ",
    {functional, timed, {"functional, by the input", false, "input"}, {"timed, by the input", true, "input"}},
    [](const BenchMode& mode) {
        OneDevice its(mode.timed);
        Bench& bench = its.bench;
        bench.cpu.program = [&](Processor& cpu) {
            tessera_driver& driver = bench.init();
            for (const bool after_error : {false, true}) {
                INFO("after an error: " << after_error);
                set_frame(driver, its.setup, its.places);
                REQUIRE(tessera_enable_interrupts(&driver, 3) == TESSERA_OK);
                const LitKeys found = run_frame(driver);
                if (after_error)
                    its.start_without_ring();
                CHECK(its.word(offset::status) == (after_error ? status_error : status_done));
                CHECK(its.word(offset::interrupt) == (after_error ? 3u : interrupt_done));
                CHECK(its.interrupt());
                if (mode.settings.empty()) {
                    its.set_word(offset::control, control_reset);
                } else {
                    bench.reset.write(true);
                    cpu.pass(sc_time(1, SC_NS));
                }
                expect_reset(driver, formats_of(its.setup), bench.reset.read());
                CHECK_FALSE(its.interrupt());
                bench.reset.write(false);
                cpu.pass(sc_time(1, SC_NS));
                expect_reset(driver, formats_of(its.setup));
                set_frame(driver, its.setup, its.places);
                REQUIRE(tessera_fetch_tables(&driver, 0) == TESSERA_OK);
                expect_same(run_frame(driver), found);
            }
        };
        bench.run();
    }};

}  // namespace

TEST_CASE("a register access takes register_cycles for each word, a refused or ignored one for one word") {
    const MachineSetup setup = setup_of(small_job(false));
    for (const unsigned cycles : {1u, 3u}) {
        // a child process for each, since SystemC elaborates once
        const ChildEnd end = run_in_child([&]() -> std::string {
            DeviceDesign design = design_of(setup);
            design.register_cycles = cycles;
            Bench bench({formats_of(setup)}, design, true);
            std::string wrong;
            bench.cpu.program = [&](Processor& cpu) {
                for (const bool approximately : {false, true}) {
                    cpu.approximately_timed = approximately;
                    std::array<unsigned char, 32> data{};
                    const auto check = [&](tlm::tlm_command command, std::uint32_t address, unsigned words,
                                           unsigned counted) {
                        const sc_time before = sc_core::sc_time_stamp();
                        cpu.access(command, address, data.data(), 4 * words);
                        if (sc_core::sc_time_stamp() - before != sc_time(5 * cycles * counted, SC_NS))
                            wrong += std::to_string(words) + " words took " +
                                     (sc_core::sc_time_stamp() - before).to_string() + "; ";
                    };
                    for (const unsigned words : {1u, 2u, 7u, 8u}) {
                        check(tlm::TLM_READ_COMMAND, offset::displacement_map_address, words, words);
                        check(tlm::TLM_WRITE_COMMAND, offset::displacement_map_address, words, words);
                        check(tlm::TLM_WRITE_COMMAND, offset::id, words, 1);
                        check(tlm::TLM_READ_COMMAND, register_bytes, words, 1);
                        check(tlm::TLM_IGNORE_COMMAND, offset::displacement_map_address, words, 1);
                    }
                }
            };
            sc_core::sc_start();
            return wrong.empty() && bench.cpu.finished ? "right" : wrong;
        });
        CAPTURE(cycles);
        CHECK(end.failure.empty());
        CHECK(end.told == "right");
    }
}

namespace {

struct TwoErrors {
    std::string name;
    bool timed;
    int triangle_us;  ///< when the read of base triangle 1 fails, after its begin
    int ring_us;      ///< when the write of the first record fails, after its begin
    int reset_us = 0;
    DeviceError kept;
};

const CaseTable<TwoErrors> two_errors{
    "of two errors in a frame the first is kept: ",
    {
        {"functional, the triangle's", false, 100, 1000, 0, DeviceError::triangle_read},
        {"functional, the ring's", false, 1000, 100, 0, DeviceError::ring_write},
        {"functional, neither after a reset", false, 200, 100, 50, DeviceError::none},
        {"timed, the triangle's", true, 100, 1000, 0, DeviceError::triangle_read},
        {"timed, the ring's", true, 1000, 100, 0, DeviceError::ring_write},
        {"timed, neither after a reset", true, 100, 200, 50, DeviceError::none},
    },
    [](const TwoErrors& row) {
        OneDevice its(row.timed);
        Bench& bench = its.bench;
        unsigned failures = 0;
        bench.cpu.program = [&](Processor& cpu) {
            tessera_driver& driver = bench.init();
            set_frame(driver, its.setup, its.places);
            LitKeys expected = run_frame(driver);
            REQUIRE(tessera_acknowledge(&driver, &failures) == TESSERA_OK);
            failures = 0;
            const std::uint64_t triangle = its.places.triangles + base_triangle_bytes;
            bench.memory.fails_after = [&](const tlm::tlm_generic_payload& payload) {
                const std::uint64_t first = payload.get_address(), end = first + payload.get_data_length();
                const bool read = payload.is_read() && first <= triangle && end > triangle;
                const bool written = payload.is_write() && first == its.places.ring;
                failures += read || written ? 1u : 0u;
                return read      ? sc_time(row.triangle_us, SC_US)
                       : written ? sc_time(row.ring_us, SC_US)
                                 : sc_core::SC_ZERO_TIME;
            };
            REQUIRE(tessera_start(&driver) == TESSERA_OK);
            if (row.reset_us > 0) {
                cpu.pass(sc_time(row.reset_us, SC_US));
                its.set_word(offset::control, control_reset);
                CHECK(its.word(offset::status) == (status_busy | status_resetting));
            }
            CHECK(tessera_wait(&driver, 100'000) ==
                  (row.kept == DeviceError::none ? TESSERA_NO_FRAME : static_cast<int>(row.kept)));
            CHECK(failures == 2);
            std::uint64_t address = 0;
            CHECK(tessera_last_error(&driver, &address) == static_cast<int>(row.kept));
            const std::uint64_t at = row.kept == DeviceError::triangle_read ? triangle
                                     : row.kept == DeviceError::ring_write  ? its.places.ring
                                                                            : 0;
            CHECK((address <= at && at - address < bench.memory.burst_bytes));
            CHECK(its.word(offset::interrupt) == (row.kept == DeviceError::none ? 0 : interrupt_error));
            CHECK(its.word(offset::ring_write_index) == 0);
            bench.memory.fails_after = nullptr;
            set_frame(driver, its.setup, its.places);
            expect_same(run_frame(driver), expected);
            CHECK(its.word(offset::error) == 0);
            CHECK(its.word(offset::error_address) == 0);
        };
        bench.run();
    }};

const CaseTable<BenchMode> status_and_counters{
    "status has one bit at a time, and the counters are those of the frame: ",
    {functional, timed},
    [](const BenchMode& mode) {
        OneDevice its(mode.timed);
        Bench& bench = its.bench;
        bench.cpu.program = [&](Processor&) {
            tessera_driver& driver = bench.init();
            CHECK(its.word(offset::status) == 0);
            for (const std::uint32_t triangles : {its.places.triangle_count, 3u, 1u}) {
                set_frame(driver, its.setup, its.places);
                REQUIRE(tessera_set_triangles(&driver, its.places.triangles, triangles) == TESSERA_OK);
                REQUIRE(tessera_start(&driver) == TESSERA_OK);
                CHECK(its.word(offset::status) == status_busy);
                CHECK(its.word(offset::triangles_finished) == 0);
                CHECK(its.word(offset::ring_write_index) == 0);
                REQUIRE(tessera_wait(&driver, 1'000'000) == TESSERA_OK);
                CHECK(its.word(offset::status) == status_done);
                CHECK(its.word(offset::triangles_sent) == triangles);
                CHECK(its.word(offset::triangles_finished) == its.word(offset::ring_write_index));
                CHECK(its.word(offset::triangles_finished) >= triangles);
                its.start_without_ring();
                CHECK(its.word(offset::status) == status_error);
                CHECK(its.word(offset::triangles_sent) == triangles);  // a refused frame changes nothing else
            }
        };
        bench.run();
    }};

const CaseTable<BenchMode> interrupts{
    "interrupts are pending until they are acknowledged, masked or not: ",
    {functional, timed},
    [](const BenchMode& mode) {
        OneDevice its(mode.timed);
        Bench& bench = its.bench;
        bench.cpu.program = [&](Processor&) {
            tessera_driver& driver = bench.init();
            set_frame(driver, its.setup, its.places);
            run_frame(driver);
            CHECK(its.word(offset::interrupt) == interrupt_done);  // none is enabled
            CHECK_FALSE(its.interrupt());
            its.start_without_ring();
            CHECK(its.word(offset::interrupt) == (interrupt_done | interrupt_error));
            for (const std::uint32_t enabled : {1u, 2u, 3u, 0u}) {
                its.set_word(offset::interrupt_enable, enabled);
                CHECK(its.interrupt() == (enabled != 0));
                CHECK(its.word(offset::interrupt) == (interrupt_done | interrupt_error));
            }
            its.set_word(offset::interrupt_enable, interrupt_done);
            its.set_word(offset::interrupt, 0);
            CHECK(its.word(offset::interrupt) == (interrupt_done | interrupt_error));
            its.set_word(offset::interrupt, interrupt_error);
            CHECK(its.word(offset::interrupt) == interrupt_done);
            CHECK(its.interrupt());
            set_frame(driver, its.setup, its.places);
            REQUIRE(tessera_start(&driver) == TESSERA_OK);
            CHECK(its.word(offset::interrupt) == interrupt_done);  // of the frame before
            its.set_word(offset::interrupt, ~0u);
            CHECK_FALSE(its.interrupt());
            REQUIRE(tessera_wait(&driver, 1'000'000) == TESSERA_OK);
            CHECK(its.word(offset::interrupt) == interrupt_done);
            CHECK(its.interrupt());
            std::array<unsigned char, 4> ones{0xff, 0xff, 0xff, 0xff};
            CHECK(bench.cpu.access(tlm::TLM_IGNORE_COMMAND, Router::registers + offset::interrupt, ones.data(), 4) ==
                  tlm::TLM_OK_RESPONSE);
            CHECK(its.word(offset::interrupt) == interrupt_done);
        };
        bench.run();
    }};

/// The platform's functions, with an event between the driver's read of `interrupt` and what follows.
struct EventAfterRead {
    tessera_platform platform;
    std::function<void()> event;

    tessera_platform with_event() {
        return {this,
                [](void* self, std::uint32_t offset, std::uint32_t* value) {
                    auto* me = static_cast<EventAfterRead*>(self);
                    const int result = me->platform.read32(me->platform.context, offset, value);
                    if (offset == offset::interrupt && me->event)
                        std::exchange(me->event, nullptr)();
                    return result;
                },
                [](void* self, std::uint32_t offset, std::uint32_t value) {
                    auto* me = static_cast<EventAfterRead*>(self);
                    return me->platform.write32(me->platform.context, offset, value);
                },
                nullptr, nullptr};
    }
};

}  // namespace

TEST_CASE("the driver acknowledges only the interrupts that it has seen") {
    OneDevice its(false);
    Bench& bench = its.bench;
    bench.cpu.program = [&](Processor&) {
        tessera_driver& driver = bench.init();
        set_frame(driver, its.setup, its.places);
        REQUIRE(tessera_enable_interrupts(&driver, 3) == TESSERA_OK);
        run_frame(driver);
        EventAfterRead its_event{bench.contexts[0].platform(), [&] { its.start_without_ring(); }};
        const tessera_platform platform = its_event.with_event();
        tessera_driver acknowledging;
        REQUIRE(tessera_init(&acknowledging, &platform) == TESSERA_OK);
        std::uint32_t seen = 0;
        CHECK(tessera_acknowledge(&acknowledging, &seen) == TESSERA_OK);
        CHECK(seen == interrupt_done);
        CHECK(its.word(offset::interrupt) == interrupt_error);
        CHECK(its.interrupt());
        CHECK(tessera_acknowledge(&acknowledging, &seen) == TESSERA_OK);
        CHECK(seen == interrupt_error);
        CHECK(its.word(offset::interrupt) == 0);
        CHECK_FALSE(its.interrupt());
    };
    bench.run();
}

namespace {

const CaseTable<BenchMode> driver_calls{
    "the driver says what went wrong, and keeps its place in the ring: ",
    {functional, timed},
    [](const BenchMode& mode) {
        OneDevice its(mode.timed);
        Bench& bench = its.bench;
        const FramePlaces other = bench.place(its.setup, 4000);
        bench.cpu.program = [&](Processor& cpu) {
            tessera_driver& driver = bench.init();
            tessera_finished_triangle triangle;
            std::uint32_t all = 0, count = 0;
            const auto waiting = [&] {
                REQUIRE(tessera_ring_count(&driver, &count) == TESSERA_OK);
                return count;
            };
            CHECK(tessera_wait(&driver, 1) == TESSERA_NO_FRAME);
            CHECK(tessera_ring_pop(&driver, &triangle) == TESSERA_EMPTY);
            CHECK(waiting() == 0);
            set_frame(driver, its.setup, its.places);
            REQUIRE(tessera_start(&driver) == TESSERA_OK);
            REQUIRE(tessera_wait(&driver, ~0u) == TESSERA_OK);
            all = waiting();
            REQUIRE(all > 100);
            LitKeys found;
            const auto pop = [&](unsigned number) {
                for (; number > 0; --number) {
                    REQUIRE(tessera_ring_pop(&driver, &triangle) == TESSERA_OK);
                    found.insert(key_of(triangle));
                }
            };
            pop(10);
            INFO("a frame that is refused, a ring for the next, and a second driver leave the records where they are");
            REQUIRE(tessera_set(&driver, TESSERA_REGISTER_LIGHT_AMBIENT, 300) == TESSERA_OK);
            CHECK(tessera_start(&driver) == TESSERA_ERROR_BAD_VALUE);
            CHECK(waiting() == all - 10);
            pop(10);
            bench.init();
            CHECK(waiting() == all - 20);
            REQUIRE(tessera_set_ring(&driver, other.ring, other.ring_size) == TESSERA_OK);
            pop(all - 20);
            CHECK(waiting() == 0);
            CHECK(tessera_ring_pop(&driver, &triangle) == TESSERA_EMPTY);
            CHECK(waiting() == 0);
            set_machine(driver, its.setup.registers);
            expect_same(run_frame(driver), found);
            INFO("values that do not fit");
            for (const auto& [number, value] : {std::pair{TESSERA_REGISTER_RING_SIZE, std::int64_t{0x80000005}},
                                                {TESSERA_REGISTER_LIGHT_AMBIENT, 522},
                                                {TESSERA_REGISTER_MAP_WIDTH, 8256},
                                                {TESSERA_REGISTER_DISPLACEMENT_SCALE, std::int64_t{1} << 31}}) {
                std::int64_t before = 0, after = 0;
                REQUIRE(tessera_get(&driver, number, &before) == TESSERA_OK);
                CHECK(tessera_set(&driver, number, value) == TESSERA_BAD_VALUE);
                REQUIRE(tessera_get(&driver, number, &after) == TESSERA_OK);
                CHECK(after == before);
            }
            INFO("the reset input");
            REQUIRE(tessera_start(&driver) == TESSERA_OK);
            bench.reset.write(true);
            cpu.pass(sc_time(100, SC_US));
            CHECK(tessera_set(&driver, TESSERA_REGISTER_MAP_WIDTH, 8) == TESSERA_BUSY);
            CHECK(its.word(offset::status) == (status_busy | status_resetting));
            bench.reset.write(false);
            CHECK(tessera_wait(&driver, ~0u) == TESSERA_NO_FRAME);
            CHECK(waiting() == 0);
        };
        bench.run();
    }};

const CaseTable<BenchMode> unfilled_tables{
    "a frame that would read a table that was not fetched whole, in its size, is refused: ",
    {functional, timed},
    [](const BenchMode& mode) {
        OneDevice its(mode.timed);
        Bench& bench = its.bench;
        bench.cpu.program = [&](Processor& cpu) {
            tessera_driver& driver = bench.init();
            const auto start = [&](std::uint32_t fetched) {
                set_frame(driver, its.setup, its.places);
                REQUIRE(tessera_fetch_tables(&driver, fetched) == TESSERA_OK);
                int result = tessera_start(&driver);
                if (result == TESSERA_OK)
                    result = tessera_wait(&driver, ~0u);
                return result;
            };
            CHECK(start(0) == TESSERA_ERROR_NO_TABLE);
            CHECK(start(5) == TESSERA_ERROR_NO_TABLE);
            CHECK(start(7) == TESSERA_OK);
            CHECK(start(0) == TESSERA_OK);
            INFO("a fetch that fails, or is reset, leaves none");
            REQUIRE(tessera_set_tables(&driver, its.places.displacement_map, 0, its.places.summed_height_table) == 0);
            REQUIRE(tessera_fetch_tables(&driver, 2) == TESSERA_OK);
            REQUIRE(tessera_start(&driver) == TESSERA_OK);
            CHECK(tessera_wait(&driver, ~0u) == TESSERA_ERROR_TABLE_READ);
            CHECK(start(5) == TESSERA_ERROR_NO_TABLE);
            CHECK(start(2) == TESSERA_OK);
            set_frame(driver, its.setup, its.places);
            REQUIRE(tessera_fetch_tables(&driver, 1) == TESSERA_OK);
            REQUIRE(tessera_start(&driver) == TESSERA_OK);
            REQUIRE(tessera_reset(&driver, ~0u) == TESSERA_OK);
            CHECK(start(6) == TESSERA_ERROR_NO_TABLE);
            INFO("another size");
            CHECK(start(1) == TESSERA_OK);
            REQUIRE(tessera_set(&driver, TESSERA_REGISTER_MAP_WIDTH, its.setup.registers.map.width / 2) == TESSERA_OK);
            REQUIRE(tessera_fetch_tables(&driver, 3) == TESSERA_OK);
            CHECK(tessera_start(&driver) == TESSERA_ERROR_NO_TABLE);
            INFO("without a height test its table is not read");
            REQUIRE(tessera_set(&driver, TESSERA_REGISTER_TESTS_SUMMED_HEIGHT_TEST, 0) == TESSERA_OK);
            CHECK(tessera_start(&driver) == TESSERA_OK);
            CHECK(tessera_wait(&driver, ~0u) == TESSERA_OK);
            cpu.pass(sc_core::SC_ZERO_TIME);
        };
        bench.run();
    }};

struct Silence {
    std::string name;
    bool timed;
    int part;  ///< of the frame's places: 0 a table, 1 a triangle, 2 the ring
    std::string says;
};

const CaseTable<Silence> silent_bus{
    "a bus that does not answer a DMA transfer is an error that names the device's socket and the address: ",
    {
        {"functional, a table", false, 0, "read of address"},
        {"functional, a triangle", false, 1, "read of address"},
        {"functional, the ring", false, 2, "write to address"},
        {"timed, a table", true, 0, "read of address"},
        {"timed, a triangle", true, 1, "read of address"},
        {"timed, the ring", true, 2, "write to address"},
    },
    [](const Silence& row) {
        OneDevice its(row.timed, 5000, 2000);
        Bench& bench = its.bench;
        const std::uint64_t silent = row.part == 0   ? its.places.normal_map
                                     : row.part == 1 ? its.places.triangles
                                                     : its.places.ring;
        std::uint64_t asked = 0;
        sc_time when;
        bench.memory.fails_after = [&](const tlm::tlm_generic_payload& payload) {
            if (payload.get_address() > silent || payload.get_address() + payload.get_data_length() <= silent ||
                payload.is_write() != (row.part == 2))
                return sc_core::SC_ZERO_TIME;
            asked = payload.get_address();
            when = sc_core::sc_time_stamp();
            return sc_time(1, sc_core::SC_SEC);
        };
        bench.cpu.program = [&](Processor&) {
            tessera_driver& driver = bench.init();
            set_frame(driver, its.setup, its.places);
            REQUIRE(tessera_start(&driver) == TESSERA_OK);
            tessera_wait(&driver, ~0u);
        };
        const std::string error = error_of([] { sc_core::sc_start(); });
        std::ostringstream address;
        address << std::hex << asked;
        CHECK_THAT(error, Contains("device_0.bus: ") && Contains(row.says + " 0x" + address.str() + " ") &&
                              Contains("since " + when.to_string()) && Contains("10 us") && Contains("answer_cycles"));
        CHECK(sc_core::sc_time_stamp() < when + sc_time(20, SC_US) + sc_time(1, SC_MS));
    }};

const CaseTable<BenchMode> slow_bus{
    "a bus that is slower than usual, within the limit, is none: ", {functional, timed}, [](const BenchMode& mode) {
        OneDevice its(mode.timed, 5000, 2000);
        its.bench.memory.waits = true;
        its.bench.memory.latency = sc_time(9, SC_US);
        its.bench.cpu.program = [&](Processor&) {
            tessera_driver& driver = its.bench.init();
            set_frame(driver, its.setup, its.places);
            CHECK(run_frame(driver).size() > 100);
        };
        its.bench.run();
    }};

}  // namespace
