#include "modules/host.h"
#include "testbench/tests/modules/device/bench.h"
#include "testbench/tests/modules/memories/base_protocol_memories.h"
#include "testbench/tests/modules/memories/bridged_units.h"
#include "testbench/tests/support/case_table.h"

// A UnitFactory joins the units' ports to other memories than the machine's: device and host fill the memories that the
// units read, or say that they cannot.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

std::unique_ptr<sc_core::sc_module> blocking(BaseProtocolBridge& bridge, const std::string& name) {
    return bound<BlockingMemory>(bridge, name, sc_core::sc_time(5, sc_core::SC_NS));
}

/// The error with which a frame ends on a device with these units.
std::string error_of_frame(const MachineSetup& setup, UnitFactory& units) {
    Bench bench({formats_of(setup)}, design_of(setup), false, true, {&units});
    const FramePlaces places = bench.place(setup, 5000);
    bench.cpu.program = [&](Processor&) {
        tessera_driver& driver = bench.init();
        set_frame(driver, setup, places);
        run_frame(driver);
    };
    return error_of([] { sc_core::sc_start(); });
}

/// A frame, and another that fetches no tables; returns the first triangles.
LitKeys two_frames(Bench& bench, const MachineSetup& setup, const FramePlaces& places) {
    LitKeys found, again;
    bench.cpu.program = [&](Processor&) {
        tessera_driver& driver = bench.init();
        set_frame(driver, setup, places);
        found = run_frame(driver);
        REQUIRE(tessera_fetch_tables(&driver, 0) == TESSERA_OK);
        again = run_frame(driver);
    };
    bench.run();
    expect_same(again, found);
    return found;
}

const CaseTable<BenchMode> bridged{
    "a device whose tables are behind bridges draws the testbench's triangles: ",
    {
        {"functional", false},
        {"timed", true},
        {"timed, a queue that spills through a bridge", true, "hardware.queue_capacity=8"},
        {"functional, modern design", false, "hardware.design=modern"},
        {"timed, modern design, two Normal Tests", true, "hardware.design=modern hardware.normal_tests=2"},
        {"functional, both sides of the displacement map", false,
         "hardware.height_test=curvature tests.curvature_threshold=0.02"},
        {"timed, codes from the displacement map", true, "hardware.one_texel_from_map=true"},
        {"timed, behind caches", true,
         "timing.summed_height_table_cache_bytes=1024 timing.normal_map_cache_bytes=1024 "
         "timing.displacement_map_cache_bytes=1024"},
        {"functional, a Mipmap Test", false, "hardware.height_test=mipmap tests.mipmap_threshold=0.01"},
        {"timed, three Tessellation Tests units", true, "hardware.tests_units=3"},
    },
    [](const BenchMode& mode) {
        const MachineSetup setup = setup_of(small_job(mode.timed, mode.settings));
        Reference reference("reference", setup);
        BridgedUnits units(setup.design.timing, blocking);
        Bench bench({formats_of(setup)}, design_of(setup), false, true, {&units});
        const FramePlaces places = bench.place(setup, 100);
        const LitKeys found = two_frames(bench, setup, places);
        CHECK(found.size() > 100);
        expect_same(found, reference.keys);
        CHECK(bench.devices[0]->machine().height_table.transactions() == 0);
    }};

/// Joins some ports to memories of its own.
class OwnTables : public UnitFactory {
  public:
    OwnTables(const MachineSetup& setup, bool all) : setup_(setup), all_(all) {}

    void join(MemoryPort& port, TableMemory& memory) override {
        const std::string name = memory.basename();
        const datapath::Registers& r = setup_.registers;
        if (name != "normal_map" && !all_) {
            port.bind(memory);
            return;
        }
        if (tables_.count(name) == 0) {
            datapath::TableLayout layout = name == "normal_map"         ? r.normal_map
                                           : name == "displacement_map" ? r.displacement_map
                                                                        : r.height_table;
            layout.rows *= 4;  // the device's largest map
            const std::string machine = memory.get_parent_object()->name();
            auto* clock = dynamic_cast<CycleScheduler*>(sc_core::sc_find_object((machine + ".clock").c_str()));
            tables_[name] = std::make_unique<TableMemory>(("own_" + name).c_str(), *clock, layout,
                                                          setup_.design.timing.normal_map, StallParameters{});
            clock->attach(*tables_[name]);
        }
        port.bind(*tables_[name]);
    }

  private:
    const MachineSetup& setup_;
    bool all_;
    std::map<std::string, std::unique_ptr<TableMemory>> tables_;
};

const CaseTable<BenchMode> own_tables{
    "a device whose factory brings its own table memories draws the testbench's triangles: ",
    {{"functional, all", false, "all"},
     {"timed, all", true, "all"},
     {"functional, the normal map", false},
     {"timed, the normal map", true}},
    [](const BenchMode& mode) {
        const MachineSetup setup = setup_of(small_job(mode.timed));
        Reference reference("reference", setup);
        OwnTables units(setup, mode.settings == "all");
        Bench bench({setup.registers}, design_of(setup), false, true, {&units});
        const FramePlaces places = bench.place(setup, 100);
        expect_same(two_frames(bench, setup, places), reference.keys);
    }};

/// A blocking memory that may do without debug transport, or treat writes by it otherwise.
struct StubbornMemory : sc_core::sc_module {
    enum class Debug { none, reads_only, loses_writes, one_byte_at_a_time, elsewhere };

    tlm_utils::simple_target_socket<StubbornMemory> socket{"socket"};
    Bytes bytes, other_bytes;
    Debug debug;

    StubbornMemory(const sc_core::sc_module_name& name, Debug its_debug) : sc_module(name), debug(its_debug) {
        socket.register_b_transport(this, &StubbornMemory::b_transport);
        if (debug != Debug::none)
            socket.register_transport_dbg(this, &StubbornMemory::transport_dbg);
    }

  private:
    void b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time&) { bytes.access(payload); }
    unsigned transport_dbg(tlm::tlm_generic_payload& payload) {
        if (payload.is_write() && debug == Debug::reads_only)
            return 0;
        if (payload.is_write() && debug == Debug::loses_writes)
            return payload.get_data_length();
        if (debug == Debug::one_byte_at_a_time)
            payload.set_data_length(1);
        return debug == Debug::elsewhere ? other_bytes.access(payload) : bytes.access(payload);
    }
};

using Debug = StubbornMemory::Debug;

/// One table is behind such a memory.
BridgedMemory one_stubborn(const std::string& table, Debug debug) {
    return [=](BaseProtocolBridge& bridge, const std::string& name) {
        return name == table ? bound<StubbornMemory>(bridge, name, debug) : blocking(bridge, name);
    };
}

struct Stubborn {
    std::string name;
    std::string table;
    Debug debug;
    std::string port;
};

const CaseTable<Stubborn> refused{
    "a table memory that does not take its table is an error that names the port: ",
    {
        {"the displacement map, no debug transport", "displacement_map", Debug::none,
         "displace_vertex.displacement_map"},
        {"the normal map, no debug transport", "normal_map", Debug::none, "normal_test.normal_map"},
        {"the Summed Height Table, reads only", "summed_height_table", Debug::reads_only,
         "summed_height_test.summed_height_table"},
        {"the normal map, writes are lost", "normal_map", Debug::loses_writes, "normal_test.normal_map"},
    },
    [](const Stubborn& row) {
        const MachineSetup setup = setup_of(small_job(false));
        BridgedUnits units(setup.design.timing, one_stubborn(row.table, row.debug));
        Bench bench({formats_of(setup)}, design_of(setup), false, true, {&units});
        const FramePlaces places = bench.place(setup, 100);
        int result = TESSERA_OK;
        bench.cpu.program = [&](Processor&) {
            tessera_driver& driver = bench.init();
            set_frame(driver, setup, places);
            run_frame(driver, result);
        };
        CHECK_THAT(error_of([] { sc_core::sc_start(); }), Contains("device_0.machine.") && Contains(row.port + ": ") &&
                                                              Contains("0x") &&
                                                              Contains("give the memory, and what is in front of it, "
                                                                       "transport_dbg for writes"));
    }};

const CaseTable<Stubborn> host_refused{
    "likewise for the host, without a device: ",
    {
        {"the displacement map, no debug transport", "displacement_map", Debug::none,
         "displace_vertex.displacement_map"},
        {"the normal map, writes are lost", "normal_map", Debug::loses_writes, "normal_test.normal_map"},
        {"the Summed Height Table, reads only", "summed_height_table", Debug::reads_only,
         "summed_height_test.summed_height_table"},
    },
    [](const Stubborn& row) {
        const MachineSetup setup = setup_of(small_job(true));
        BridgedUnits units(setup.design.timing, one_stubborn(row.table, row.debug));
        NamedMachine machine("machine", setup, &units);
        CHECK_THAT(error_of([] { sc_core::sc_start(); }),
                   Contains("machine.pipeline.") && Contains(row.port + ": ") && Contains("transport_dbg"));
    }};

const CaseTable<BenchMode> led_elsewhere{
    "a memory whose debug accesses lead elsewhere than its transactions is an error: ",
    {{"functional", false}, {"timed", true}},
    [](const BenchMode& mode) {
        const MachineSetup setup = setup_of(small_job(mode.timed));
        BridgedUnits units(setup.design.timing, one_stubborn("normal_map", Debug::elsewhere));
        CHECK_THAT(error_of_frame(setup, units),
                   Contains("normal_map: ") && Contains("lead debug accesses where transactions go"));
    }};

}  // namespace

TEST_CASE("a client that lets SC_ERRORs pass gets the device's error, and no triangles") {
    sc_core::sc_report_handler::set_actions("tessera/machine", sc_core::SC_ERROR, sc_core::SC_CACHE_REPORT);
    const MachineSetup setup = setup_of(small_job(false));
    BridgedUnits units(setup.design.timing, one_stubborn("normal_map", Debug::none));
    Bench bench({formats_of(setup)}, design_of(setup), false, true, {&units});
    const FramePlaces places = bench.place(setup, 100);
    bench.cpu.program = [&](Processor&) {
        tessera_driver& driver = bench.init();
        set_frame(driver, setup, places);
        int result = TESSERA_OK;
        CHECK(run_frame(driver, result).empty());
        CHECK(result == TESSERA_ERROR_TABLE_MEMORY);
        std::uint64_t address = 0;
        CHECK(tessera_last_error(&driver, &address) == TESSERA_ERROR_TABLE_MEMORY);
        CHECK(address == places.normal_map);
    };
    bench.run();
}

TEST_CASE("a table memory that moves one byte for each debug access is filled") {
    const MachineSetup setup = setup_of(small_job(false));
    Reference reference("reference", setup);
    BridgedUnits units(setup.design.timing, one_stubborn("normal_map", Debug::one_byte_at_a_time));
    Bench bench({formats_of(setup)}, design_of(setup), false, true, {&units});
    const FramePlaces places = bench.place(setup, 100);
    expect_same(two_frames(bench, setup, places), reference.keys);
}

TEST_CASE("a memory that already holds its table need not be writable") {
    const MachineSetup setup = setup_of(small_job(false));
    BridgedUnits units(setup.design.timing, [&](BaseProtocolBridge& bridge, const std::string& name) {
        auto memory = std::make_unique<StubbornMemory>((name + "_bus").c_str(), Debug::reads_only);
        bridge.to_memory.bind(memory->socket);
        write_tables(setup, [&](std::uint64_t address, const unsigned char* bytes, std::size_t count) {
            for (std::size_t k = 0; k < count; ++k)
                memory->bytes.written[address + k] = bytes[k];
        });
        return memory;
    });
    NamedMachine machine("machine", setup, &units);
    sc_core::sc_start();
    expect_bare_mesh(machine);
}

namespace {

/// Joins the tables to this memory.
BridgedMemory joined(SharedMemory& memory) {
    return [&](BaseProtocolBridge& bridge, const std::string& name) -> std::unique_ptr<sc_core::sc_module> {
        if (name == "off_chip_memory")
            return blocking(bridge, name);
        bridge.to_memory.bind(memory.socket);
        return nullptr;
    };
}

const CaseTable<BenchMode> shared{"two machines read the same tables from one memory: ",
                                  {{"functional", false}, {"timed", true}},
                                  [](const BenchMode& mode) {
                                      const MachineSetup setup = setup_of(small_job(mode.timed));
                                      SharedMemory memory("memory");
                                      BridgedUnits first_units(setup.design.timing, joined(memory));
                                      BridgedUnits second_units(setup.design.timing, joined(memory));
                                      NamedMachine first("first", setup, &first_units),
                                          second("second", setup, &second_units);
                                      sc_core::sc_start();
                                      expect_bare_mesh(first);
                                      expect_bare_mesh(second);
                                  }};

const CaseTable<BenchMode> overwritten{
    "two machines with different tables at the same place of one memory are an error: ",
    {{"functional", false}, {"timed", true}},
    [](const BenchMode& mode) {
        const MachineSetup setup = setup_of(small_job(mode.timed));
        const MachineSetup other = setup_of(small_job(mode.timed, "map.source=noise"));
        SharedMemory memory("memory");
        BridgedUnits first_units(setup.design.timing, joined(memory));
        BridgedUnits second_units(setup.design.timing, joined(memory));
        NamedMachine first("first", setup, &first_units), second("second", other, &second_units);
        CHECK_THAT(error_of([] { sc_core::sc_start(); }),
                   Contains("first.pipeline.") && Contains("no longer holds the table that was written to "
                                                           "it: give each machine and table a memory, or "
                                                           "addresses, of its own"));
    }};

const CaseTable<BenchMode> apart{
    "two machines with different tables in one memory, at addresses of their own, draw their meshes: ",
    {{"functional", false}, {"timed", true}},
    [](const BenchMode& mode) {
        const MachineSetup setup = setup_of(small_job(mode.timed));
        MachineSetup other = setup_of(small_job(mode.timed, "map.source=noise"));
        datapath::Registers& r = other.registers;
        for (datapath::TableLayout* const table : {&r.displacement_map, &r.normal_map, &r.height_table})
            table->base += 1u << 20;
        SharedMemory memory("memory");
        BridgedUnits first_units(setup.design.timing, joined(memory));
        BridgedUnits second_units(setup.design.timing, joined(memory));
        NamedMachine first("first", setup, &first_units), second("second", other, &second_units);
        sc_core::sc_start();
        expect_bare_mesh(first);
        expect_bare_mesh(second);
    }};

const CaseTable<BenchMode> separate{
    "two machines with different tables at the same place of a memory each draw their meshes: ",
    {{"functional", false}, {"timed", true}},
    [](const BenchMode& mode) {
        const MachineSetup setup = setup_of(small_job(mode.timed));
        const MachineSetup other = setup_of(small_job(mode.timed, "map.source=noise"));
        SharedMemory memory("memory"), other_memory("other_memory");
        BridgedUnits first_units(setup.design.timing, joined(memory));
        BridgedUnits second_units(setup.design.timing, joined(other_memory));
        NamedMachine first("first", setup, &first_units), second("second", other, &second_units);
        sc_core::sc_start();
        expect_bare_mesh(first);
        expect_bare_mesh(second);
    }};

// Registers that are not laid out have all tables at address 0.
const CaseTable<BenchMode> overlapping{"a device whose tables lie over one another in one memory is an error: ",
                                       {{"functional", false}, {"timed", true}},
                                       [](const BenchMode& mode) {
                                           const MachineSetup setup = setup_of(small_job(mode.timed));
                                           SharedMemory memory("shared");
                                           BridgedUnits units(setup.design.timing, joined(memory));
                                           CHECK_THAT(error_of_frame(setup, units),
                                                      Contains("device_0.machine.") && Contains("of its own"));
                                       }};

const CaseTable<BenchMode> overwritten_frames{
    "likewise two devices, whichever frame fetches first: ",
    {{"functional", false}, {"timed", true}},
    [](const BenchMode& mode) {
        const MachineSetup setup = setup_of(small_job(mode.timed));
        const MachineSetup other = setup_of(small_job(mode.timed, "map.source=noise"));
        SharedMemory memory("shared");
        BridgedUnits first_units(setup.design.timing, joined(memory));
        BridgedUnits second_units(setup.design.timing, joined(memory));
        Bench bench({setup.registers, setup.registers}, design_of(setup), false, true, {&first_units, &second_units});
        const std::array<FramePlaces, 2> places{bench.place(setup, 5000), bench.place(other, 5000)};
        bool drawn = false;
        bench.cpu.program = [&](Processor&) {
            for (std::size_t k = 0; k < 2; ++k) {
                tessera_driver& driver = bench.init(k);
                set_frame(driver, k == 0 ? setup : other, places[k]);
                run_frame(driver);
            }
            drawn = true;
            REQUIRE(tessera_fetch_tables(&bench.drivers[0], 0) == TESSERA_OK);
            run_frame(bench.drivers[0]);
        };
        CHECK_THAT(error_of([] { sc_core::sc_start(); }), Contains("device_0.machine.") && Contains("of its own"));
        CHECK(drawn);
    }};

}  // namespace

TEST_CASE("what a client writes to a table memory that no port reads is an error") {
    const MachineSetup setup = setup_of(small_job(true));
    BridgedUnits units(setup.design.timing, blocking);
    NamedMachine machine("machine", setup, &units), other("other", setup);
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
    unsigned char data[4] = {};
    tlm::tlm_generic_payload payload;
    payload.set_address(setup.registers.normal_map.base);
    payload.set_data_ptr(data);
    payload.set_data_length(4);
    payload.set_read();
    CHECK(machine.host.normal_map->transport_dbg(payload) == 4);
    payload.set_write();
    CHECK_THAT(error_of([&] { machine.host.normal_map->transport_dbg(payload); }),
               Contains("machine.pipeline.normal_map") && Contains("write_table"));
    CHECK(other.host.normal_map->transport_dbg(payload) == 4);
}
