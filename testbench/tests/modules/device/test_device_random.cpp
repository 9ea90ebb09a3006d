#include <cstdlib>

#include "testbench/common/random.h"
#include "testbench/tests/modules/device/bench.h"
#include "testbench/tests/support/case_table.h"

// Random accesses and random addresses: each ends with an error or a correct result, and no write leaves the ring.
// TESSERA_DEVICE_ACCESSES and TESSERA_DEVICE_FRAMES set their numbers, TESSERA_DEVICE_SEED the seed.

using namespace tessera;
using namespace tessera::testing;

namespace {

const char* const modern =
    "hardware.design=modern hardware.displacement_filter=bilinear hardware.one_texel_from_map=true formats.displacement_bits=5 formats.normal_bits=11 "
    "formats.normal_fraction=9 formats.position_bits=24 formats.position_fraction=12 tests.highlight=true";

std::uint64_t from_environment(const char* name, std::uint64_t value) {
    const char* const text = std::getenv(name);
    return text == nullptr ? value : std::strtoull(text, nullptr, 10);
}

class Dice : public Random {
  public:
    using Random::Random;
    std::uint64_t any() { return bits(); }
    std::uint64_t below(std::uint64_t limit) { return bits() % limit; }
    bool one_in(std::uint64_t times) { return below(times) == 0; }
};

MachineSetup limited_setup(const BenchMode& mode) {
    return setup_of(
        small_job(mode.timed, "hardware.queue_capacity=32 hardware.off_chip_triangles=2000 " + mode.settings));
}

/// Sends every item through its packed form: a value beyond its format would be an SC_ERROR.
DeviceDesign packed_design(const MachineSetup& setup) {
    DeviceDesign design = design_of(setup);
    design.machine.packed_streams = true;
    return design;
}

/// Words with mostly zeros, mostly ones, or random bits.
std::uint32_t random_word(Dice& dice) {
    const std::uint64_t word = dice.any();
    switch (dice.below(5)) {
        case 0: return static_cast<std::uint32_t>(word);
        case 1: return static_cast<std::uint32_t>(word % 4);
        case 2: return static_cast<std::uint32_t>(word % 64);
        case 3: return static_cast<std::uint32_t>(word) | 0xffffff00u;
        default: return static_cast<std::uint32_t>(1u << (word % 32));
    }
}

/// Before each write of the device sets the writable range to the ring in its registers.
void watch_ring(Bench& bench) {
    bench.memory.writable_now = [&bench] {
        std::vector<unsigned char> data(12);
        tlm::tlm_generic_payload payload;
        payload.set_command(tlm::TLM_READ_COMMAND);
        payload.set_address(offset::ring_address);
        payload.set_data_ptr(data.data());
        payload.set_data_length(12);
        if (bench.direct)
            bench.cpu.bus->transport_dbg(payload);
        else
            bench.router.to_devices[0]->transport_dbg(payload);
        const std::uint64_t first = datapath::load_word(&data[0]) | std::uint64_t{datapath::load_word(&data[4])} << 32;
        return BusMemory::Range{first, first + std::uint64_t{datapath::load_word(&data[8])} * finished_triangle_bytes};
    };
}

const CaseTable<BenchMode> random_accesses{
    "random register accesses: ",
    {{"functional", false},
     {"timed", true},
     {"timed, approximately timed processor", true, "", true},
     {"functional, modern design, narrow formats", false, modern},
     {"timed, modern design, narrow formats", true, modern}},
    [](const BenchMode& mode) {
        const std::uint64_t count = from_environment("TESSERA_DEVICE_ACCESSES", 100000);
        const MachineSetup setup = limited_setup(mode);
        Reference reference("reference", setup);
        Bench bench({formats_of(setup)}, packed_design(setup), true);
        const FramePlaces places = bench.place(setup, 40);
        const std::vector<unsigned char> image = bench.memory.bytes;
        watch_ring(bench);
        LitKeys found;
        unsigned refused = 0, started = 0;
        bench.cpu.program = [&](Processor& cpu) {
            Dice dice(from_environment("TESSERA_DEVICE_SEED", 1));
            tessera_driver& driver = bench.init();
            cpu.approximately_timed = mode.approximately_timed;
            for (std::uint64_t k = 0; k < count; ++k) {
                if (k % 100 == 0 && !bench.devices[0]->busy())  // so that some frames start
                    set_frame(driver, setup, places);
                std::vector<unsigned char> data(4 * (dice.one_in(3) ? dice.below(40) : 1) +
                                                (dice.one_in(8) ? dice.below(4) : 0) + 4);
                for (std::size_t at = 0; at + 4 <= data.size(); at += 4)
                    datapath::store_word(random_word(dice), &data[at]);
                std::uint64_t address = dice.below(register_bytes / 4 + 16) * 4;
                if (dice.one_in(4))
                    address = offset::control + 4 * dice.below(6);
                if (dice.one_in(16))
                    address = dice.one_in(2) ? dice.any() : address + dice.below(4);
                const auto length = static_cast<unsigned>(data.size() - (dice.one_in(2) ? 4 : dice.below(5)));
                std::vector<unsigned char> enables(data.size(), static_cast<unsigned char>(dice.any()));
                const tlm::tlm_command command = dice.one_in(30)  ? tlm::TLM_IGNORE_COMMAND
                                                 : dice.one_in(2) ? tlm::TLM_READ_COMMAND
                                                                  : tlm::TLM_WRITE_COMMAND;
                const bool was_busy = bench.devices[0]->busy();
                const tlm::tlm_response_status response =
                    cpu.access(command, address, data.data(), length, dice.one_in(20) ? enables.data() : nullptr,
                               dice.one_in(20) ? static_cast<unsigned>(dice.below(64)) : ~0u);
                REQUIRE(response != tlm::TLM_INCOMPLETE_RESPONSE);
                refused += response != tlm::TLM_OK_RESPONSE ? 1u : 0u;
                started += !was_busy && bench.devices[0]->busy() ? 1u : 0u;
                if (dice.one_in(50))
                    cpu.pass(sc_core::sc_time(static_cast<double>(dice.below(20000)), sc_core::SC_NS));
            }
            CHECK(tessera_reset(&driver, 1000000) == TESSERA_OK);
            cpu.keeper.sync();
            bench.memory.bytes = image;  // a random ring may have overwritten it
            set_frame(driver, setup, places);
            found = run_frame(driver);
        };
        bench.run();
        CHECK(refused > count / 4);
        CHECK(refused < count);
        CHECK(started > count / 5000);
        expect_same(found, reference.keys);
    }};

const CaseTable<BenchMode> random_addresses{
    "random DMA addresses, counts and map sizes: ",
    {{"functional", false}, {"timed", true}, {"timed, modern design, narrow formats", true, modern}},
    [](const BenchMode& mode) {
        const std::uint64_t count = from_environment("TESSERA_DEVICE_FRAMES", 300);
        const MachineSetup setup = limited_setup(mode);
        Reference reference("reference", setup);
        Bench bench({formats_of(setup)}, packed_design(setup));
        const FramePlaces right = bench.place(setup, 60);
        const std::vector<unsigned char> image = bench.memory.bytes;
        watch_ring(bench);
        std::map<int, unsigned> results;
        unsigned right_frames = 0;
        bench.cpu.program = [&](Processor& cpu) {
            Dice dice(from_environment("TESSERA_DEVICE_SEED", 1));
            tessera_driver& driver = bench.init();
            const auto address = [&](std::uint64_t its) {
                switch (dice.below(8)) {
                    case 0: return dice.any();
                    case 1: return Bench::memory_base + dice.below(bench.memory.bytes.size()) / 4 * 4;
                    case 2: return Bench::memory_base + bench.memory.bytes.size() - dice.below(3000) / 4 * 4;
                    case 3: return 0 - dice.below(20000);
                    default: return its;
                }
            };
            for (std::uint64_t k = 0; k < count; ++k) {
                INFO("frame " << k);
                FramePlaces places = right;
                places.displacement_map = address(right.displacement_map);
                places.normal_map = address(right.normal_map);
                places.summed_height_table = address(right.summed_height_table);
                places.triangles = address(right.triangles);
                places.ring = address(right.ring);
                if (dice.one_in(6))
                    places.triangle_count = random_word(dice);
                if (dice.one_in(4))
                    places.ring_size = random_word(dice) & 0x7fffffff;
                cpu.keeper.sync();
                bench.memory.bytes = image;
                set_machine(driver, setup.registers);
                const bool other_map = dice.one_in(4);
                if (other_map) {
                    REQUIRE(tessera_set(&driver, TESSERA_REGISTER_MAP_WIDTH,
                                        static_cast<std::int64_t>(dice.below(70))) == 0);
                    REQUIRE(tessera_set(&driver, TESSERA_REGISTER_MAP_HEIGHT,
                                        static_cast<std::int64_t>(dice.below(70))) == 0);
                }
                set_places(driver, places);
                const bool all_right =
                    !other_map && places.displacement_map == right.displacement_map &&
                    places.normal_map == right.normal_map && places.summed_height_table == right.summed_height_table &&
                    places.triangles == right.triangles && places.triangle_count == right.triangle_count &&
                    places.ring == right.ring && places.ring_size == right.ring_size;
                int result = tessera_start(&driver);
                LitKeys found;
                for (unsigned polls = 0; result == TESSERA_OK || result == TESSERA_TIMEOUT; ++polls) {
                    result = tessera_wait(&driver, 1);
                    if (all_right) {
                        pop_all(driver, found);
                    } else {  // frees the ring without reading it
                        std::int64_t written = 0;
                        REQUIRE(tessera_get(&driver, TESSERA_REGISTER_RING_WRITE_INDEX, &written) == TESSERA_OK);
                        REQUIRE(tessera_set(&driver, TESSERA_REGISTER_RING_READ_INDEX, written) == TESSERA_OK);
                    }
                    if (result != TESSERA_TIMEOUT)
                        break;
                    REQUIRE(polls < 1000000);
                }
                ++results[result];
                CHECK(result >= 0);
                if (all_right) {
                    ++right_frames;
                    CHECK(result == TESSERA_OK);
                    expect_same(found, reference.keys);
                }
            }
        };
        bench.run();
        CHECK(right_frames > 0);
        for (const DeviceError error : {DeviceError::none, DeviceError::bad_address, DeviceError::bad_map_size,
                                        DeviceError::table_read, DeviceError::triangle_read, DeviceError::ring_write})
            CHECK(results[static_cast<int>(error)] > 0);
    }};

}  // namespace
