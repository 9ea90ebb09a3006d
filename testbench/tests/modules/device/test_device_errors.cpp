#include <fmt/format.h>

#include <functional>

#include "modules/device/program_registers.h"
#include "testbench/tests/modules/device/bench.h"
#include "testbench/tests/support/case_table.h"

// Software errors: refused accesses, refused frames, stopped frames.

using namespace tessera;
using namespace tessera::testing;

namespace {

MachineSetup setup_for(const BenchMode& mode, const std::string& settings = "") {
    return setup_of(small_job(mode.timed, settings));
}

/// A register of an otherwise correct frame, its value, and the expected result of start.
struct Refusal {
    tessera_register number;
    std::int64_t value;
    DeviceError error;
};

const std::vector<Refusal> refusals{
    {TESSERA_REGISTER_MAP_WIDTH, 0, DeviceError::bad_map_size},
    {TESSERA_REGISTER_MAP_WIDTH, 65, DeviceError::bad_map_size},
    {TESSERA_REGISTER_MAP_HEIGHT, 0, DeviceError::bad_map_size},
    {TESSERA_REGISTER_MAP_HEIGHT, 4096, DeviceError::bad_map_size},
    {TESSERA_REGISTER_TRIANGULATION, 3, DeviceError::bad_value},
    {TESSERA_REGISTER_LIGHT_AMBIENT, 257, DeviceError::bad_value},
    {TESSERA_REGISTER_TESTS_SUMMED_HEIGHT_THRESHOLD, (std::int64_t{1} << 50) + 1, DeviceError::bad_value},
    {TESSERA_REGISTER_RING_SIZE, 0, DeviceError::bad_ring_size},
    {TESSERA_REGISTER_RING_ADDRESS, 0x10000002, DeviceError::bad_address},
    {TESSERA_REGISTER_RING_ADDRESS, -4, DeviceError::bad_address},
    {TESSERA_REGISTER_TRIANGLES_ADDRESS, 0x10000001, DeviceError::bad_address},
    {TESSERA_REGISTER_TRIANGLES_ADDRESS, -100, DeviceError::bad_address},
    {TESSERA_REGISTER_DISPLACEMENT_MAP_ADDRESS, 0x10000003, DeviceError::bad_address},
    {TESSERA_REGISTER_NORMAL_MAP_ADDRESS, -16, DeviceError::bad_address},
    {TESSERA_REGISTER_SUMMED_HEIGHT_TABLE_ADDRESS, -8, DeviceError::bad_address},
};

/// Each of the rows is refused and changes nothing, and so is what `refuse_more` tries with the correct frame's
/// registers; the next frame is correct.
void check_refusals(
    const MachineSetup& setup, const std::vector<Refusal>& rows,
    const std::function<void(tessera_driver&)>& refuse_more = [](tessera_driver&) {}) {
    Reference reference("reference", setup);
    Bench bench({formats_of(setup)}, design_of(setup));
    const FramePlaces places = bench.place(setup, 50);
    LitKeys found;
    bench.cpu.program = [&](Processor&) {
        tessera_driver& driver = bench.init();
        for (const Refusal& refusal : rows) {
            INFO(tessera_register_name(refusal.number) << " = " << refusal.value);
            set_frame(driver, setup, places);
            REQUIRE(tessera_set(&driver, refusal.number, refusal.value) == TESSERA_OK);
            CHECK(tessera_start(&driver) == static_cast<int>(refusal.error));
            std::uint64_t address = 0;
            std::uint32_t status = 0;
            CHECK(tessera_last_error(&driver, &address) == static_cast<int>(refusal.error));
            CHECK(number_of(static_cast<std::uint32_t>(address)) == refusal.number);
            REQUIRE(tessera_status(&driver, &status) == TESSERA_OK);
            CHECK(status == TESSERA_STATUS_ERROR);
            std::int64_t value = 0;
            REQUIRE(tessera_get(&driver, refusal.number, &value) == TESSERA_OK);
            CHECK(value == refusal.value);
        }
        CHECK((bench.memory.reads == 0 && bench.memory.writes == 0));
        set_frame(driver, setup, places);
        refuse_more(driver);
        set_machine(driver, setup.registers);
        found = run_frame(driver);
    };
    bench.run();
    expect_same(found, reference.keys);
}

const CaseTable<BenchMode> refused_frames{
    "a frame with a wrong register is refused, changes nothing, and the next frame is correct: ",
    {{"functional", false}, {"timed", true}},
    [](const BenchMode& mode) {
        check_refusals(setup_for(mode), refusals, [](tessera_driver& driver) {
            // with the unit `area` the same threshold is too large, and the greatest is not
            REQUIRE(tessera_set(&driver, TESSERA_REGISTER_TESTS_SUMMED_HEIGHT_UNIT, 1) == 0);
            REQUIRE(tessera_set(&driver, TESSERA_REGISTER_TESTS_SUMMED_HEIGHT_THRESHOLD, (1 << 18) + 1) == 0);
            CHECK(tessera_start(&driver) == static_cast<int>(DeviceError::bad_value));
        });
    }};

/// The texels that the Curvature Table covers.
const std::vector<Refusal> curvature_refusals{
    {TESSERA_REGISTER_CURVATURE_TABLE_COLUMNS, 0, DeviceError::bad_map_size},
    {TESSERA_REGISTER_CURVATURE_TABLE_COLUMNS, 65, DeviceError::bad_map_size},
    {TESSERA_REGISTER_CURVATURE_TABLE_ROWS, 0, DeviceError::bad_map_size},
    {TESSERA_REGISTER_CURVATURE_TABLE_ROWS, 4096, DeviceError::bad_map_size},
};

const CaseTable<BenchMode> refused_tables{
    "a frame with a wrong size of the Curvature Table is refused, and the next frame is correct: ",
    {{"functional", false}, {"timed", true}},
    [](const BenchMode& mode) {
        check_refusals(setup_for(mode, "hardware.height_test=curvature tests.curvature_threshold=0.02"),
                       curvature_refusals);
    }};

const CaseTable<BenchMode> stopped_frames{
    "a bus error stops the frame: nothing more is written, the cause is reported, and the next frame is correct: ",
    {{"functional", false}, {"timed", true}},
    [](const BenchMode& mode) {
        const MachineSetup setup = setup_for(mode);
        Reference reference("reference", setup);
        Bench bench({formats_of(setup)}, design_of(setup));
        const FramePlaces places = bench.place(setup, 5000);
        struct Failing {
            const char* what;
            std::uint64_t at;
            DeviceError error;
        };
        const std::vector<Failing> failing{
            {"displacement map", places.displacement_map + 700, DeviceError::table_read},
            {"normal map", places.normal_map, DeviceError::table_read},
            {"Summed Height Table", places.summed_height_table + 41 * 25 * 4 - 1, DeviceError::table_read},
            {"first triangle", places.triangles, DeviceError::triangle_read},
            {"last triangle", places.triangles + places.triangle_count * base_triangle_bytes - 1,
             DeviceError::triangle_read},
            {"first record", places.ring, DeviceError::ring_write},
            {"record 10", places.ring + 10 * finished_triangle_bytes + 71, DeviceError::ring_write},
            {"record 300", places.ring + 300 * finished_triangle_bytes + 30, DeviceError::ring_write}};
        LitKeys found;
        bench.cpu.program = [&](Processor& cpu) {
            tessera_driver& driver = bench.init();
            set_frame(driver, setup, places);
            for (const Failing& its : failing) {
                INFO(its.what);
                bench.memory.failing_from = bench.memory.failing_to = its.at;
                REQUIRE(tessera_start(&driver) == TESSERA_OK);
                CHECK(tessera_wait(&driver, 100000) == static_cast<int>(its.error));
                std::uint64_t address = 0;
                CHECK(tessera_last_error(&driver, &address) == static_cast<int>(its.error));
                CHECK((address <= its.at && its.at - address < bench.memory.burst_bytes));
                const unsigned writes = bench.memory.writes;
                cpu.pass(sc_core::sc_time(1, sc_core::SC_MS));
                CHECK(bench.memory.writes == writes);
                std::uint32_t count = 0;
                REQUIRE(tessera_ring_count(&driver, &count) == TESSERA_OK);
                if (its.error == DeviceError::ring_write)
                    CHECK(count == (its.at - places.ring) / finished_triangle_bytes);
            }
            bench.memory.failing_from = 1;
            bench.memory.failing_to = 0;
            found = run_frame(driver);
        };
        bench.run();
        expect_same(found, reference.keys);
    }};

const CaseTable<BenchMode> bad_triangles{
    "a base triangle that does not fit its formats stops the frame: ",
    {{"functional", false}, {"timed", true}},
    [](const BenchMode& mode) {
        const MachineSetup setup = setup_for(mode);
        Bench bench({formats_of(setup)}, design_of(setup));
        const FramePlaces places = bench.place(setup, 5000);
        bench.cpu.program = [&](Processor&) {
            tessera_driver& driver = bench.init();
            set_frame(driver, setup, places);
            for (const unsigned word : {3u, 9u, 10u, 35u}) {
                const std::uint64_t record = places.triangles + 5 * base_triangle_bytes;
                unsigned char* const at = &bench.memory.bytes[record + 4 * word - bench.memory.base];
                const std::uint32_t was = datapath::load_word(at);
                datapath::store_word(0x7fffffff, at);
                REQUIRE(tessera_start(&driver) == TESSERA_OK);
                CHECK(tessera_wait(&driver, 100000) == static_cast<int>(DeviceError::bad_triangle));
                std::uint64_t address = 0;
                std::int64_t sent = 0;
                CHECK(tessera_last_error(&driver, &address) > 0);
                CHECK(address == record);
                REQUIRE(tessera_get(&driver, TESSERA_REGISTER_TRIANGLES_SENT, &sent) == TESSERA_OK);
                CHECK(sent <= 5);
                datapath::store_word(was, at);
            }
        };
        bench.run();
    }};

const CaseTable<BenchMode> endless{
    "a frame that splits without end is stopped by a full queue, or by a reset: ",
    {{"functional", false}, {"timed", true}},
    [](const BenchMode& mode) {
        const std::string off_chip =
            "hardware.queue_capacity=64 hardware.off_chip_triangles=400 tests.generation_limit=2 ";
        const MachineSetup setup = setup_for(mode, off_chip);
        Reference reference("reference", setup);
        Bench bench({formats_of(setup)}, design_of(setup));
        const FramePlaces places = bench.place(setup, 5000);
        LitKeys found;
        bench.cpu.program = [&](Processor& cpu) {
            tessera_driver& driver = bench.init();
            for (const bool by_reset : {false, true}) {
                set_frame(driver, setup, places);
                for (const tessera_register test :
                     {TESSERA_REGISTER_TESTS_VIEW_TEST, TESSERA_REGISTER_TESTS_TEX_COORD_TEST,
                      TESSERA_REGISTER_TESTS_GENERATION_TEST, TESSERA_REGISTER_TESTS_NORMAL_THRESHOLD,
                      TESSERA_REGISTER_TESTS_SUMMED_HEIGHT_THRESHOLD})
                    REQUIRE(tessera_set(&driver, test, 0) == TESSERA_OK);
                REQUIRE(tessera_set(&driver, TESSERA_REGISTER_TESTS_GENERATION_LIMIT, 15) == TESSERA_OK);
                REQUIRE(tessera_start(&driver) == TESSERA_OK);
                if (by_reset) {
                    cpu.pass(sc_core::sc_time(20, sc_core::SC_US));
                    CHECK(bench.devices[0]->busy());
                    CHECK(tessera_reset(&driver, 100000) == TESSERA_OK);
                } else {
                    CHECK(tessera_wait(&driver, 1000000) == static_cast<int>(DeviceError::queue_full));
                }
            }
            set_frame(driver, setup, places);
            found = run_frame(driver);
        };
        bench.run();
        expect_same(found, reference.keys);
    }};

const CaseTable<BenchMode> halted_clock{
    "a halted clock ends the frame with an error: ", {{"timed", true}}, [](const BenchMode& mode) {
        const MachineSetup setup = setup_for(mode);
        Bench bench({formats_of(setup)}, design_of(setup));
        const FramePlaces places = bench.place(setup, 5000);
        bench.cpu.program = [&](Processor& cpu) {
            tessera_driver& driver = bench.init();
            set_frame(driver, setup, places);
            REQUIRE(tessera_start(&driver) == TESSERA_OK);
            cpu.pass(sc_core::sc_time(20, sc_core::SC_US));
            bench.devices[0]->machine().clock.halt();
            CHECK(tessera_wait(&driver, 1000) == static_cast<int>(DeviceError::machine_stopped));
            CHECK(tessera_start(&driver) == static_cast<int>(DeviceError::machine_stopped));
        };
        bench.run();
    }};

/// An access, and its response.
struct BusAccess {
    std::string what;
    tlm::tlm_command command;
    std::uint64_t address;
    unsigned length;
    tlm::tlm_response_status response;
    unsigned width = ~0u;
    std::vector<unsigned char> enables = {};
};

constexpr tlm::tlm_command reading = tlm::TLM_READ_COMMAND, writing = tlm::TLM_WRITE_COMMAND;
const std::vector<BusAccess> accesses{
    {"a word", reading, 0, 4, tlm::TLM_OK_RESPONSE},
    {"a register of two words", reading, 0x20, 8, tlm::TLM_OK_RESPONSE},
    {"five words", writing, 0x28 + 8, 32, tlm::TLM_OK_RESPONSE},
    {"a byte", reading, 0, 1, tlm::TLM_BURST_ERROR_RESPONSE},
    {"half a word", reading, 2, 2, tlm::TLM_BURST_ERROR_RESPONSE},
    {"a word between two", reading, 2, 4, tlm::TLM_BURST_ERROR_RESPONSE},
    {"nothing", reading, 0, 0, tlm::TLM_BURST_ERROR_RESPONSE},
    {"six bytes", writing, 0x30, 6, tlm::TLM_BURST_ERROR_RESPONSE},
    {"a stream", reading, 0, 8, tlm::TLM_BURST_ERROR_RESPONSE, 4},
    {"a stream within a word", writing, 0x30, 4, tlm::TLM_BURST_ERROR_RESPONSE, 2},
    {"a stream of seven eighths", writing, 0x30, 8, tlm::TLM_BURST_ERROR_RESPONSE, 7},
    {"a streaming width of 0, which the standard forbids", reading, 0, 4, tlm::TLM_OK_RESPONSE, 0},
    {"a streaming width of 0, several words", writing, 0x30, 32, tlm::TLM_OK_RESPONSE, 0},
    {"a streaming width above the length", writing, 0x30, 8, tlm::TLM_OK_RESPONSE, 64},
    {"every byte enabled", writing, 0x30, 4, tlm::TLM_OK_RESPONSE, ~0u, {0xff, 0xff, 0xff, 0xff}},
    {"every byte enabled by a pattern of one", writing, 0x30, 8, tlm::TLM_OK_RESPONSE, ~0u, {0xff}},
    {"every byte enabled by a pattern of three", reading, 0x30, 8, tlm::TLM_OK_RESPONSE, ~0u, {0xff, 0xff, 0xff}},
    {"a pattern that is disabled only beyond the data",
     writing,
     0x30,
     4,
     tlm::TLM_OK_RESPONSE,
     ~0u,
     {0xff, 0xff, 0xff, 0xff, 0, 0}},
    {"byte enables and a streaming width of 0", writing, 0x30, 4, tlm::TLM_OK_RESPONSE, 0, {0xff, 0xff}},
    {"the last byte disabled", writing, 0x30, 4, tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE, ~0u, {0xff, 0xff, 0xff, 0}},
    {"a read with a byte disabled", reading, 0, 4, tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE, ~0u, {0, 0xff, 0xff, 0xff}},
    {"every other byte of two words", writing, 0x30, 8, tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE, ~0u, {0xff, 0}},
    {"the second of two words disabled",
     writing,
     0x30,
     8,
     tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE,
     ~0u,
     {0xff, 0xff, 0xff, 0xff, 0, 0, 0, 0}},
    {"no byte enabled", writing, 0x30, 4, tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE, ~0u, {0}},
    {"neither enabled nor disabled", writing, 0x30, 4, tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE, ~0u, {1}},
    {"no command", static_cast<tlm::tlm_command>(3), 0x30, 4, tlm::TLM_COMMAND_ERROR_RESPONSE},
    {"no command, a read-only register", static_cast<tlm::tlm_command>(3), 0, 4, tlm::TLM_COMMAND_ERROR_RESPONSE},
    {"neither read nor write", tlm::TLM_IGNORE_COMMAND, 0x30, 4, tlm::TLM_OK_RESPONSE},
    {"neither read nor write, control", tlm::TLM_IGNORE_COMMAND, offset::control, 4, tlm::TLM_OK_RESPONSE},
    {"neither read nor write, a read-only register", tlm::TLM_IGNORE_COMMAND, 0, 4, tlm::TLM_OK_RESPONSE},
    {"neither read nor write, nothing", tlm::TLM_IGNORE_COMMAND, 0, 0, tlm::TLM_OK_RESPONSE},
    {"no register", reading, 0x1c, 4, tlm::TLM_ADDRESS_ERROR_RESPONSE},
    {"a hole among registers", reading, 0x18, 12, tlm::TLM_ADDRESS_ERROR_RESPONSE},
    {"beyond the last", reading, 0x3fc, 4, tlm::TLM_ADDRESS_ERROR_RESPONSE},
    {"across the end", reading, 0x3fc, 8, tlm::TLM_ADDRESS_ERROR_RESPONSE},
    {"far beyond", reading, ~std::uint64_t{3}, 4, tlm::TLM_ADDRESS_ERROR_RESPONSE},
    {"a read-only register", writing, 0, 4, tlm::TLM_COMMAND_ERROR_RESPONSE},
    {"the last of a burst is read-only", writing, 0x50, 8, tlm::TLM_COMMAND_ERROR_RESPONSE},
    {"a read index beyond the write index", writing, offset::ring_read_index, 4, tlm::TLM_GENERIC_ERROR_RESPONSE},
};

}  // namespace

TEST_CASE("register accesses: each is done completely, or is refused with its response and changes nothing") {
    const MachineSetup setup = setup_for({"", false});
    Bench bench({formats_of(setup)}, design_of(setup), true);
    bench.cpu.program = [&](Processor& cpu) {
        const auto snapshot = [&] {
            std::map<std::uint32_t, std::uint32_t> words;
            for (const DeviceRegister& r : register_map(formats_of(setup), {64, 64}))
                for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(r.words); ++k)
                    CHECK(cpu.read32(r.offset + 4 * k, words[r.offset + 4 * k]) == 0);
            return words;
        };
        for (const bool timed : {false, true}) {
            cpu.keeper.sync();
            cpu.approximately_timed = timed;
            for (const BusAccess& access : accesses) {
                INFO(access.what << (timed ? ", approximately timed" : ""));
                std::vector<unsigned char> data(64, 0x55), enables = access.enables;
                const auto before = snapshot();
                CHECK(cpu.access(access.command, access.address, data.data(), access.length,
                                 enables.empty() ? nullptr : enables.data(), access.width,
                                 static_cast<unsigned>(enables.size())) == access.response);
                if (access.response != tlm::TLM_OK_RESPONSE || access.command == tlm::TLM_IGNORE_COMMAND) {
                    CHECK(snapshot() == before);
                    CHECK(data == std::vector<unsigned char>(64, 0x55));
                } else if (access.command == writing) {
                    CHECK(snapshot() != before);
                    std::fill(data.begin(), data.end(), 0);
                    CHECK(cpu.access(writing, access.address, data.data(), access.length) == tlm::TLM_OK_RESPONSE);
                } else {
                    CHECK(data[0] != 0x55);
                }
            }
            unsigned char enable = 0xff, word[4] = {};
            CHECK(cpu.access(reading, 0, nullptr, 4) == tlm::TLM_GENERIC_ERROR_RESPONSE);
            CHECK(cpu.access(writing, 0x30, nullptr, 4) == tlm::TLM_GENERIC_ERROR_RESPONSE);
            CHECK(cpu.access(writing, 0x30, word, 4, &enable, ~0u, 0) == tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
        }
    };
    bench.run();
}

TEST_CASE("during a frame only reset, interrupts and the read index may be written") {
    const MachineSetup setup = setup_for({"", true});
    Bench bench({formats_of(setup)}, design_of(setup));
    const FramePlaces places = bench.place(setup, 10);
    bench.cpu.program = [&](Processor& cpu) {
        tessera_driver& driver = bench.init();
        set_frame(driver, setup, places);
        REQUIRE(tessera_start(&driver) == TESSERA_OK);
        for (const DeviceRegister& r : register_map(formats_of(setup), {64, 64})) {
            INFO(r.name);
            std::uint32_t word = 0;
            REQUIRE(cpu.read32(Router::registers + r.offset, word) == 0);
            const bool may = r.while_busy;
            CHECK((cpu.write32(Router::registers + r.offset, r.offset == offset::control ? 0 : word) == 0) == may);
        }
        CHECK(tessera_start(&driver) == TESSERA_BUSY);
        CHECK(bench.devices[0]->busy());
        tlm::tlm_generic_payload debug;
        unsigned char word[4] = {};
        debug.set_command(writing);
        debug.set_address(TESSERA_MAP_WIDTH);
        debug.set_data_ptr(word);
        debug.set_data_length(4);
        CHECK(bench.router.to_devices[0]->transport_dbg(debug) == 0);
        cpu.pass(sc_core::sc_time(100, sc_core::SC_US));
        std::uint32_t count = 0;
        REQUIRE(tessera_ring_count(&driver, &count) == TESSERA_OK);
        CHECK(count == 10);  // full
        for (const std::uint32_t index : {11u, 0xffffffffu, 0x80000000u})
            CHECK(cpu.write32(Router::registers + offset::ring_read_index, index) != 0);
        CHECK(cpu.write32(Router::registers + offset::ring_read_index, 3) == 0);
        CHECK(cpu.write32(Router::registers + offset::ring_read_index, 2) != 0);
        cpu.pass(sc_core::sc_time(100, sc_core::SC_US));
        REQUIRE(cpu.read32(Router::registers + offset::ring_write_index, count) == 0);
        CHECK(count == 13);
        CHECK(tessera_reset(&driver, 10000) == TESSERA_OK);
    };
    bench.run();
}

TEST_CASE("driver calls refused during a frame do not change it: the frame's triangles are read") {
    const MachineSetup setup = setup_for({"", true});
    Reference reference("reference", setup);
    Bench bench({formats_of(setup)}, design_of(setup));
    const FramePlaces places = bench.place(setup, 16);
    LitKeys found;
    bench.cpu.program = [&](Processor&) {
        tessera_driver& driver = bench.init();
        const tessera_platform platform = bench.contexts[0].platform();
        CHECK(program_registers(platform, setup.registers) == TESSERA_OK);
        set_places(driver, places);
        REQUIRE(tessera_start(&driver) == TESSERA_OK);
        int result = TESSERA_TIMEOUT;
        bool refused = false;
        while (result == TESSERA_TIMEOUT) {
            result = tessera_wait(&driver, 1);
            if (!refused && found.size() > 20) {
                refused = true;
                REQUIRE(result == TESSERA_TIMEOUT);
                CHECK(tessera_start(&driver) == TESSERA_BUSY);
                CHECK(tessera_set_ring(&driver, places.ring, 7) == TESSERA_BUSY);
                CHECK(program_registers(platform, setup.registers) == TESSERA_BUS);
            }
            pop_all(driver, found);
        }
        CHECK(result == TESSERA_OK);
        CHECK(refused);
    };
    bench.run();
    CHECK(found.size() > 100);
    expect_same(found, reference.keys);
}

TEST_CASE("registers for other formats than the device's are not written") {
    const MachineSetup setup = setup_for({"", false});
    Bench bench({formats_of(setup)}, design_of(setup));
    bench.cpu.program = [&](Processor&) {
        bench.init();
        const tessera_platform platform = bench.contexts[0].platform();
        for (const char* const other :
             {"formats.summed_height_bits=40", "formats.displacement_bits=8", "formats.position_fraction=15",
              "formats.screen_fraction=7", "hardware.one_texel_from_map=true", "hardware.work=family",
              "hardware.displacement_filter=bilinear"}) {
            INFO(other);
            CHECK(program_registers(platform, setup_for({"", false}, other).registers) == TESSERA_NO_DEVICE);
        }
        tessera_platform broken = platform;
        broken.read32 = [](void*, std::uint32_t, std::uint32_t*) { return 1; };
        CHECK(program_registers(broken, setup.registers) == TESSERA_BUS);
        std::int64_t width = 1;
        CHECK(tessera_get(&bench.drivers[0], TESSERA_REGISTER_MAP_WIDTH, &width) == TESSERA_OK);
        CHECK(width == formats_of(setup).map.width);
        CHECK(program_registers(platform, setup.registers) == TESSERA_OK);
        CHECK(tessera_get(&bench.drivers[0], TESSERA_REGISTER_MAP_WIDTH, &width) == TESSERA_OK);
        CHECK(width == setup.registers.map.width);
    };
    bench.run();
}

TEST_CASE("debug transport reads all registers, writes plain ones, and starts nothing, DMI is refused") {
    const MachineSetup setup = setup_for({"", false});
    Bench bench({formats_of(setup)}, design_of(setup), true);
    bench.cpu.program = [&](Processor& cpu) {
        const auto debug = [&](tlm::tlm_command command, std::uint64_t address, std::vector<unsigned char>& data) {
            tlm::tlm_generic_payload payload;
            payload.set_command(command);
            payload.set_address(address);
            payload.set_data_ptr(data.data());
            payload.set_data_length(static_cast<unsigned>(data.size()));
            return cpu.bus->transport_dbg(payload);
        };
        std::vector<unsigned char> word(4, 0xff), two(8, 0x12), odd(7);
        CHECK(debug(reading, 0, two) == 8);
        CHECK((two[0] == 'T' && two[1] == 'E' && two[2] == 'S' && two[3] == 'S'));
        CHECK(debug(writing, offset::control, word) == 0);
        CHECK(debug(writing, offset::id, word) == 0);
        CHECK(debug(writing, offset::interrupt, word) == 0);
        CHECK(debug(writing, offset::interrupt_enable, word) == 0);
        CHECK(debug(writing, offset::ring_read_index, word) == 0);
        CHECK(debug(writing, offset::ring_address, two) == 8);
        CHECK(debug(reading, offset::ring_address, odd) == 4);
        CHECK(debug(tlm::TLM_IGNORE_COMMAND, offset::ring_address, word) == 0);
        std::vector<unsigned char> none;
        CHECK(debug(reading, 0, none) == 0);
        CHECK(debug(reading, 0x1c, word) == 0);
        CHECK(debug(reading, 1, word) == 0);
        CHECK(debug(reading, ~std::uint64_t{0}, word) == 0);
        std::uint32_t value = 0;
        CHECK(cpu.read32(offset::ring_address + 4, value) == 0);
        CHECK(value == datapath::load_word(&two[4]));
        CHECK_FALSE(bench.devices[0]->busy());
        bench.reset.write(true);
        cpu.pass(sc_core::sc_time(1, sc_core::SC_NS));
        CHECK(debug(writing, offset::ring_address, two) == 0);
        bench.reset.write(false);
        tlm::tlm_generic_payload payload;
        tlm::tlm_dmi dmi;
        CHECK_FALSE(cpu.bus->get_direct_mem_ptr(payload, dmi));
    };
    bench.run();
}

TEST_CASE("an invalid device is refused during construction") {
    const MachineSetup setup = setup_for({"", true});
    const auto refused = [&](DeviceDesign design) {
        return error_of([&] { const Device device("device", setup.registers, design); });
    };
    DeviceDesign design = design_of(setup);
    for (const auto& [width, height] : {std::pair{4097u, 1u}, {1u, 4097u}, {0u, 1u}, {1u, 0u}}) {
        design.largest_map = {width, height};
        const bool wide = width != 1;
        CHECK(refused(design) == fmt::format("device: DeviceDesign::largest_map.{} = {}: must be 1 to 4096",
                                             wide ? "width" : "height", wide ? width : height));
    }
    design = design_of(setup);
    for (const unsigned bytes : {0u, 2u, 48u, 8192u}) {
        design.burst_bytes = bytes;
        CHECK(refused(design) == fmt::format("device: DeviceDesign::burst_bytes = {}: must be {}", bytes,
                                             bytes == 48 ? "a power of two" : "4 to 4096"));
    }
    design = design_of(setup);
    design.machine.queue.capacity = 10;
    design.machine.queue.overflow = QueueOverflow::stall;
    CHECK_THAT(refused(design), Catch::Contains("DeviceDesign::machine.queue.capacity = 10: a bounded queue"));
    design = design_of(setup);
    design.finished_triangles = 0;
    CHECK(refused(design) == "device: DeviceDesign::finished_triangles = 0: must be 1 to 65536");
    design = design_of(setup);
    design.triangles_ahead = 65537;
    CHECK(refused(design) == "device: DeviceDesign::triangles_ahead = 65537: must be 1 to 65536");
    design = design_of(setup);
    design.register_cycles = 0;
    CHECK(refused(design) == "device: DeviceDesign::register_cycles = 0: must be 1 to 65536");
    design = design_of(setup);
    design.machine.transport = static_cast<Transport>(9);
    CHECK_THAT(refused(design), Catch::Contains("Design::transport = 9: must be Transport::blocking or"));
    design = design_of(setup);
    datapath::Registers narrow = setup.registers;
    narrow.formats.texture.bits = 12;
    narrow.formats.texture.fraction = 12;
    CHECK_THAT(error_of([&] { const Device device("device", narrow, design); }),
               Catch::Contains("Formats::texture.bits = 12: must be 14 to 25"));
    design.machine.timing.transform.interval = 0;
    CHECK_THAT(refused(design), Catch::Contains("device.machine: Design::timing.transform.interval = 0: must be 1 to"));
}
