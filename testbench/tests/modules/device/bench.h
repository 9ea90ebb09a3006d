#pragma once
#include <array>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "testbench/tests/modules/device/frame_image.h"
#include "testbench/tests/modules/device/platform.h"
#include "testbench/tests/modules/named_machine.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/timed_checks.h"
#include "testbench/tests/support/timed_modules.h"

/// Devices on a platform, next to the testbench's own machine, which gives the expected triangles.
namespace tessera::testing {

using LitKey = std::array<std::uint32_t, 18>;  // a record's words
using LitKeys = std::multiset<LitKey>;

inline LitKey key_of(const unsigned char* record) {
    LitKey key{};
    for (std::size_t k = 0; k < key.size(); ++k)
        key[k] = datapath::load_word(record + 4 * k);
    return key;
}
inline LitKey key_of(const tessera_finished_triangle& triangle) {
    LitKey key{};
    std::size_t place = 0;
    for (const tessera_finished_vertex& v : triangle.vertices) {
        for (const std::int32_t word : {v.x, v.y, v.w})
            key[place++] = static_cast<std::uint32_t>(word);
        for (const std::uint32_t word : {v.u, v.v, v.light})
            key[place++] = word;
    }
    return key;
}

/// The triangles that the testbench's rasteriser takes for a set-up.
struct Reference : tlm::tlm_analysis_if<LitTriangle> {
    NamedMachine machine;
    LitKeys keys;

    Reference(const std::string& name, const MachineSetup& setup) : machine(name.c_str(), setup) {
        machine.rasteriser.taken.bind(*this);
    }

  private:
    void write(const LitTriangle& lit) override {
        std::array<unsigned char, finished_triangle_bytes> record{};
        write_finished_triangle(lit, record.data());
        keys.insert(key_of(record.data()));
    }
};

/// Addresses of a frame's parts in bus memory.
struct FramePlaces {
    std::uint64_t displacement_map, normal_map, summed_height_table, triangles, ring;
    std::uint32_t triangle_count, ring_size;
};

struct Bench {
    static constexpr std::uint64_t memory_base = 0x1000'0000;

    BusMemory memory{"memory", memory_base, std::size_t{8} << 20};
    Router router;
    Processor cpu{"cpu"};
    std::vector<std::unique_ptr<Device>> devices;
    std::vector<std::unique_ptr<sc_core::sc_signal<bool>>> interrupts;
    sc_core::sc_signal<bool> reset{"reset"};
    std::vector<DriverContext> contexts;
    std::vector<tessera_driver> drivers;
    std::uint64_t next = memory_base + 4;
    const bool direct;  ///< the processor is joined to the one device's registers

    /// wires: reset and interrupt are connected; they are optional. units: of each device; none: the machine's own.
    Bench(const std::vector<datapath::Registers>& initial, const DeviceDesign& design, bool its_direct = false,
          bool wires = true, const std::vector<UnitFactory*>& units = {})
        : router("router", initial.size()), direct(its_direct) {
        for (std::size_t k = 0; k < initial.size(); ++k) {
            devices.push_back(std::make_unique<Device>(("device_" + std::to_string(k)).c_str(), initial[k], design,
                                                       units.empty() ? nullptr : units[k]));
            interrupts.push_back(
                std::make_unique<sc_core::sc_signal<bool>>(("interrupt_" + std::to_string(k)).c_str()));
            devices[k]->bus.bind(router.from);
            if (wires) {
                devices[k]->interrupt.bind(*interrupts[k]);
                devices[k]->reset.bind(reset);
            }
            if (direct)
                router.to_devices[k].bind(memory.socket);  // unused
            else
                router.to_devices[k].bind(devices[k]->registers);
        }
        router.to_memory.bind(memory.socket);
        if (direct)
            cpu.bus.bind(devices[0]->registers);
        else
            cpu.bus.bind(router.from);
        cpu.interrupt.bind(*interrupts[0]);
        memory.burst_bytes = design.burst_bytes;
        drivers.resize(initial.size());
        for (std::size_t k = 0; k < initial.size(); ++k)
            contexts.push_back({&cpu, direct ? 0 : Router::registers + k * register_bytes, direct ? &memory : nullptr});
    }
    /// Places a set-up's frame, each part at a multiple of 4, and a ring, the only writable area.
    FramePlaces place(const MachineSetup& setup, std::uint32_t ring_size, bool beyond = false) {
        const FrameImage image = image_of(setup, beyond);
        const auto put = [&](const std::vector<unsigned char>& data) {
            const std::uint64_t at = memory.put(next, data);
            next = (next + data.size() + 3) / 4 * 4 + 4;
            return at;
        };
        FramePlaces places{};
        places.displacement_map = put(image.displacement_map);
        places.normal_map = put(image.normal_map);
        places.summed_height_table = put(image.summed_height_table);
        places.triangles = put(image.triangles);
        places.triangle_count = static_cast<std::uint32_t>(setup.base_triangles.size());
        places.ring_size = ring_size;
        places.ring = put(std::vector<unsigned char>(std::size_t{ring_size} * finished_triangle_bytes, 0xcd));
        memory.writable.push_back({places.ring, places.ring + std::uint64_t{ring_size} * finished_triangle_bytes});
        return places;
    }

    tessera_driver& init(std::size_t device = 0) {
        const tessera_platform platform = contexts[device].platform();
        REQUIRE(tessera_init(&drivers[device], &platform) == TESSERA_OK);
        return drivers[device];
    }

    void run() {
        sc_core::sc_start();
        CHECK(cpu.finished);
        CHECK(memory.writes_outside == 0);
        CHECK(memory.across == 0);
        CHECK(memory.longest <= memory.burst_bytes);
    }
};

/// The driver's number of a register.
inline tessera_register number_of(std::uint32_t offset) {
    static const std::map<std::uint32_t, tessera_register> numbers{
#define TESSERA_PAIR(name, its_offset, bits, words, is_signed, writable) {its_offset, TESSERA_REGISTER_##name},
        TESSERA_REGISTER_LIST(TESSERA_PAIR)
#undef TESSERA_PAIR
    };
    return numbers.at(offset);
}

/// Writes every register of the machine that software may write, through the driver.
inline void set_machine(tessera_driver& driver, const datapath::Registers& registers) {
    for (const DeviceRegister& r : register_map(registers, {})) {
        if (r.offset < offset::machine || r.access != RegisterAccess::read_write)
            continue;
        std::uint64_t value = r.reset;
        if (r.is_signed && (value >> (r.bits - 1) & 1) != 0)
            value |= ~((std::uint64_t{1} << (r.bits - 1)) - 1);
        INFO(r.name);
        REQUIRE(tessera_set(&driver, number_of(r.offset), static_cast<std::int64_t>(value)) == TESSERA_OK);
    }
}

inline void set_places(tessera_driver& driver, const FramePlaces& places) {
    REQUIRE(tessera_set_tables(&driver, places.displacement_map, places.normal_map, places.summed_height_table) == 0);
    REQUIRE(tessera_set_triangles(&driver, places.triangles, places.triangle_count) == 0);
    REQUIRE(tessera_set_ring(&driver, places.ring, places.ring_size) == 0);
}

inline void set_frame(tessera_driver& driver, const MachineSetup& setup, const FramePlaces& places) {
    set_machine(driver, setup.registers);
    set_places(driver, places);
}

/// Requires that registers have their reset values; held: by the input.
inline void expect_reset(tessera_driver& driver, const datapath::Registers& initial, bool held = false) {
    for (const DeviceRegister& r : register_map(initial, {64, 64})) {
        INFO(r.name);
        std::int64_t value = 0;
        REQUIRE(tessera_get(&driver, number_of(r.offset), &value) == TESSERA_OK);
        const std::uint64_t mask = r.bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << r.bits) - 1;
        const bool busy = held && r.offset == offset::status;
        CHECK((static_cast<std::uint64_t>(value) & mask) == (busy ? status_busy | status_resetting : r.reset));
    }
}

inline void pop_all(tessera_driver& driver, LitKeys& keys) {
    std::uint32_t count = 0;
    REQUIRE(tessera_ring_count(&driver, &count) == TESSERA_OK);
    for (; count > 0; --count) {
        tessera_finished_triangle triangle;
        REQUIRE(tessera_ring_pop(&driver, &triangle) == TESSERA_OK);
        keys.insert(key_of(triangle));
    }
}

/// Starts a frame and reads the ring until the frame has ended; returns its triangles. result: the driver's.
inline LitKeys run_frame(tessera_driver& driver, int& result) {
    LitKeys keys;
    result = tessera_start(&driver);
    while (result == TESSERA_OK && (result = tessera_wait(&driver, 1)) == TESSERA_TIMEOUT) {
        pop_all(driver, keys);
        result = TESSERA_OK;
    }
    pop_all(driver, keys);
    return keys;
}
/// The same for a frame that must succeed.
inline LitKeys run_frame(tessera_driver& driver) {
    int result = TESSERA_OK;
    const LitKeys keys = run_frame(driver, result);
    INFO(tessera_text(result));
    REQUIRE(result == TESSERA_OK);
    return keys;
}

inline void expect_same(const LitKeys& found, const LitKeys& expected) {
    CHECK(found.size() == expected.size());
    CHECK((found == expected));  // extra parentheses: nothing is printed
}

/// A row of a CaseTable: a mode, and additional settings of the job.
struct BenchMode {
    std::string name;
    bool timed;
    std::string settings = "";
    bool approximately_timed = false;  ///< the processor
};

/// The default job, smaller, in either mode.
inline Job small_job(bool timed, const std::string& settings = "") {
    return with_settings({}, std::string("mode=") + (timed ? "timed" : "functional") +
                                 " mesh.columns=4 mesh.rows=3 map.width=40 map.height=24 tests.generation_limit=5 " +
                                 settings);
}

/// The formats alone: a device's registers before a frame sets them.
inline datapath::Registers formats_of(const MachineSetup& setup) {
    datapath::Registers registers;
    registers.formats = setup.registers.formats;
    return registers;
}

inline DeviceDesign design_of(const MachineSetup& setup) {
    DeviceDesign design;
    design.machine = setup.design;
    const datapath::Registers& registers = setup.registers;
    design.largest_map = {std::max({64u, registers.map.width, registers.covered.columns}),
                          std::max({64u, registers.map.height, registers.covered.rows})};
    return design;
}

}  // namespace tessera::testing
