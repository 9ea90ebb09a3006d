#include "testbench/tests/modules/device/bench.h"

#include "testbench/tests/support/case_table.h"

// Frames in sequence: with other registers, other maps, a reset in the middle, two devices, interrupts.

using namespace tessera;
using namespace tessera::testing;

namespace {

const BenchMode functional{"functional", false};
const BenchMode timed{"timed", true};

/// Set-ups, the testbench's triangles for them, and a bench of devices.
struct Frames {
    std::vector<MachineSetup> setups;
    std::vector<std::unique_ptr<Reference>> references;
    std::unique_ptr<Bench> bench;
    std::vector<FramePlaces> places;

    Frames(const BenchMode& mode, const std::vector<std::string>& settings, std::size_t devices = 1,
           std::uint32_t ring_size = 50) {
        for (const std::string& its : settings)
            setups.push_back(setup_of(small_job(mode.timed, mode.settings + ' ' + its)));
        for (std::size_t k = 0; k < setups.size(); ++k)
            references.push_back(std::make_unique<Reference>("reference_" + std::to_string(k), setups[k]));
        const datapath::Registers initial = formats_of(setups[0]);
        bench = std::make_unique<Bench>(std::vector(devices, initial), design_of(setups[0]));
        for (const MachineSetup& setup : setups)
            places.push_back(bench->place(setup, ring_size));
    }
    void set(tessera_driver& driver, std::size_t frame) { set_frame(driver, setups[frame], places[frame]); }
};

const std::vector<std::string> several{
    "",
    "tests.normal_threshold=0.3 tests.view_threshold=9",
    "displacement.scale=0.05",
    "displacement.scale=0.3 tests.summed_height_threshold=0.5",
    "map.source=noise map.width=64 map.height=64 map.address_u=repeat camera.field_of_view=30",
    "map.source=noise map.width=9 map.height=5 tests.normal=false tests.generation_limit=4",
    ""};

const CaseTable<BenchMode> frames_in_a_row{
    "several frames in a row, with different thresholds, scales, maps and cameras: ",
    {functional,
     timed,
     {"timed, tables behind caches", true,
      "timing.summed_height_table_cache_bytes=512 timing.normal_map_cache_bytes=512 "
      "timing.displacement_map_cache_bytes=512"},
     {"timed, modern design", true, "hardware.design=modern"}},
    [](const BenchMode& mode) {
        Frames frames(mode, several);
        std::vector<LitKeys> found(several.size());
        frames.bench->cpu.program = [&](Processor&) {
            tessera_driver& driver = frames.bench->init();
            for (std::size_t k = 0; k < several.size(); ++k) {
                frames.set(driver, k);
                found[k] = run_frame(driver);
            }
        };
        frames.bench->run();
        for (std::size_t k = 0; k < several.size(); ++k) {
            INFO("frame " << k);
            CHECK(found[k].size() > 20);
            expect_same(found[k], frames.references[k]->keys);
        }
        CHECK(found[0] != found[1]);
        CHECK(found[1] != found[2]);
    }};

const CaseTable<BenchMode> without_fetch{
    "a frame that does not fetch tables uses those of the frame before: ",
    {functional, timed},
    [](const BenchMode& mode) {
        Frames frames(mode, {"", "tests.normal_threshold=0.3"});
        LitKeys found;
        unsigned reads = 0, reads_again = 0;
        frames.bench->cpu.program = [&](Processor& cpu) {
            tessera_driver& driver = frames.bench->init();
            frames.set(driver, 0);
            run_frame(driver);
            cpu.pass(sc_core::SC_ZERO_TIME);
            reads = frames.bench->memory.reads;
            set_machine(driver, frames.setups[1].registers);
            REQUIRE(tessera_set_tables(&driver, 1, 2, 3) == TESSERA_OK);  // neither aligned nor used
            REQUIRE(tessera_fetch_tables(&driver, 0) == TESSERA_OK);
            found = run_frame(driver);
            reads_again = frames.bench->memory.reads - reads;
        };
        frames.bench->run();
        expect_same(found, frames.references[1]->keys);
        CHECK(reads_again + 100 < reads);
    }};

const CaseTable<BenchMode> resets{"after a reset at any moment of a frame, the next frame is correct: ",
                                  {functional,
                                   timed,
                                   {"timed, spilling", true, "hardware.queue_capacity=8"},
                                   {"timed, modern design", true, "hardware.design=modern"}},
                                  [](const BenchMode& mode) {
                                      Frames frames(mode, {""}, 1, 20);
                                      Bench& bench = *frames.bench;
                                      const datapath::Registers initial = formats_of(frames.setups[0]);
                                      std::vector<LitKeys> found;
                                      bench.cpu.program = [&](Processor& cpu) {
                                          tessera_driver& driver = bench.init();
                                          for (unsigned k = 0; k < 24; ++k) {
                                              INFO("reset " << k);
                                              frames.set(driver, 0);
                                              // the ring is not read, so that the frame does not end by itself
                                              REQUIRE(tessera_start(&driver) == TESSERA_OK);
                                              cpu.pass(sc_core::sc_time(40 << (k / 2), sc_core::SC_NS));
                                              std::uint32_t status = 0;
                                              REQUIRE(tessera_status(&driver, &status) == TESSERA_OK);
                                              CHECK(status == status_busy);
                                              if (k % 2 == 0) {
                                                  CHECK(tessera_reset(&driver, 10000) == TESSERA_OK);
                                              } else {
                                                  bench.reset.write(true);
                                                  cpu.pass(sc_core::sc_time(10, sc_core::SC_US));
                                                  CHECK(tessera_start(&driver) < TESSERA_OK);  // held
                                                  bench.reset.write(false);
                                                  CHECK(tessera_wait(&driver, 10000) == TESSERA_NO_FRAME);
                                              }
                                              const unsigned writes = bench.memory.writes;
                                              expect_reset(driver, initial);
                                              CHECK(bench.memory.writes == writes);
                                              if (k % 6 < 2) {
                                                  frames.set(driver, 0);
                                                  found.push_back(run_frame(driver));
                                              }
                                          }
                                      };
                                      bench.run();
                                      CHECK(found.size() == 8);
                                      for (const LitKeys& keys : found)
                                          expect_same(keys, frames.references[0]->keys);
                                  }};

const CaseTable<BenchMode> two{
    "two devices on one bus, at the same time: ", {functional, timed}, [](const BenchMode& mode) {
        Frames frames(mode, {"", "map.source=noise displacement.scale=0.1"}, 2, 30);
        std::array<LitKeys, 2> found;
        frames.bench->cpu.program = [&](Processor&) {
            std::array<bool, 2> busy{true, true};
            for (std::size_t k = 0; k < 2; ++k)
                frames.set(frames.bench->init(k), k);
            for (std::size_t k = 0; k < 2; ++k)
                REQUIRE(tessera_start(&frames.bench->drivers[k]) == TESSERA_OK);
            CHECK((frames.bench->devices[0]->busy() && frames.bench->devices[1]->busy()));
            while (busy[0] || busy[1]) {
                for (std::size_t k = 0; k < 2; ++k) {
                    const int result = tessera_wait(&frames.bench->drivers[k], 1);
                    REQUIRE((result == TESSERA_OK || result == TESSERA_TIMEOUT));
                    busy[k] = result == TESSERA_TIMEOUT;
                    pop_all(frames.bench->drivers[k], found[k]);
                }
            }
        };
        frames.bench->run();
        for (std::size_t k = 0; k < 2; ++k)
            expect_same(found[k], frames.references[k]->keys);
    }};

const CaseTable<BenchMode> interrupts{
    "the interrupt is high from a frame's end until it is acknowledged: ",
    {functional, timed},
    [](const BenchMode& mode) {
        Frames frames(mode, {""}, 1, 5000);
        Bench& bench = *frames.bench;
        LitKeys found;
        bench.cpu.program = [&](Processor& cpu) {
            tessera_driver& driver = bench.init();
            const auto level = [&] {
                cpu.pass(sc_core::sc_time(1, sc_core::SC_NS));
                return bench.interrupts[0]->read();
            };
            std::uint32_t pending = 0;
            frames.set(driver, 0);
            REQUIRE(tessera_enable_interrupts(&driver, TESSERA_INTERRUPT_DONE) == TESSERA_OK);
            REQUIRE(tessera_start(&driver) == TESSERA_OK);
            CHECK_FALSE(level());
            cpu.wait_for_interrupt();
            CHECK_FALSE(bench.devices[0]->busy());
            CHECK(tessera_wait(&driver, 1) == TESSERA_OK);
            pop_all(driver, found);
            REQUIRE(tessera_enable_interrupts(&driver, TESSERA_INTERRUPT_ERROR) == TESSERA_OK);
            CHECK_FALSE(level());
            REQUIRE(tessera_enable_interrupts(&driver, TESSERA_INTERRUPT_DONE) == TESSERA_OK);
            CHECK(level());
            REQUIRE(tessera_acknowledge(&driver, &pending) == TESSERA_OK);
            CHECK(pending == TESSERA_INTERRUPT_DONE);
            CHECK_FALSE(level());
            REQUIRE(tessera_set_ring(&driver, 0, 0) == TESSERA_OK);
            REQUIRE(tessera_enable_interrupts(&driver, 3) == TESSERA_OK);
            CHECK(tessera_start(&driver) == static_cast<int>(DeviceError::bad_ring_size));
            CHECK(level());
            REQUIRE(tessera_acknowledge(&driver, &pending) == TESSERA_OK);
            CHECK(pending == TESSERA_INTERRUPT_ERROR);
        };
        bench.run();
        expect_same(found, frames.references[0]->keys);
    }};

const CaseTable<BenchMode> empty_frame{
    "a frame without triangles is done at once: ", {functional, timed}, [](const BenchMode& mode) {
        Frames frames(mode, {""});
        frames.bench->cpu.program = [&](Processor&) {
            tessera_driver& driver = frames.bench->init();
            frames.set(driver, 0);
            REQUIRE(tessera_set_triangles(&driver, 1, 0) == TESSERA_OK);
            CHECK(run_frame(driver).empty());
        };
        frames.bench->run();
    }};

}  // namespace

namespace {

/// Runs a frame while the processor sleeps. Returns the longest delay of a call that the device made to the memory.
sc_core::sc_time longest_delay(const BenchMode& mode) {
    tlm::tlm_global_quantum::instance().set(sc_core::sc_time(500, sc_core::SC_NS));
    Frames frames(mode, {""}, 1, 5000);
    frames.bench->cpu.program = [&](Processor& cpu) {
        tessera_driver& driver = frames.bench->init();
        frames.set(driver, 0);
        REQUIRE(tessera_enable_interrupts(&driver, 1) == TESSERA_OK);
        REQUIRE(tessera_start(&driver) == TESSERA_OK);
        cpu.wait_for_interrupt();
    };
    frames.bench->run();
    CHECK(frames.bench->memory.reads > 100);
    CHECK(frames.bench->memory.writes > 100);
    return frames.bench->memory.longest_delay;
}

}  // namespace

TEST_CASE("functional mode runs ahead of simulated time by less than the global quantum") {
    const sc_core::sc_time longest = longest_delay(functional);
    CHECK(longest > sc_core::sc_time(100, sc_core::SC_NS));
    CHECK(longest < sc_core::sc_time(500, sc_core::SC_NS));
}

TEST_CASE("timed mode waits for each burst's delay, for any quantum") {
    CHECK(longest_delay(timed) == sc_core::SC_ZERO_TIME);
}
