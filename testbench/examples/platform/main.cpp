#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <systemc>

#include "bus.h"
#include "modules/device/device.h"
#include "modules/device/program_registers.h"
#include "modules/device/records.h"
#include "picture.h"
#include "processor.h"
#include "testbench/setup/prepare_scene.h"

// A processor draws frames of a growing bump, with a tessera device on a bus.
// Usage: platform functional|timed [FRAMES]

namespace {

constexpr std::uint32_t ring_records = 20'000;
constexpr int frames_at_most = 99;

/// A square of two triangles with a bump, seen from a camera that orbits it.
tessera::Scene scene_of(int frame, int frames) {
    tessera::Scene scene;
    scene.vertices = {{{0, 0, 0}, {0, 0}, {0, 0, 1}},
                      {{1, 0, 0}, {1, 0}, {0, 0, 1}},
                      {{1, 1, 0}, {1, 1}, {0, 0, 1}},
                      {{0, 1, 0}, {0, 1}, {0, 0, 1}}};
    scene.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.map_width = scene.map_height = 64;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            scene.map.push_back(static_cast<float>(std::exp(-(std::pow(x - 31.5, 2) + std::pow(y - 31.5, 2)) / 200)));
    tessera::SceneSettings& settings = scene.settings;
    settings.formats.summed_height_bits = 32;  // fixed by the device, not chosen per frame
    settings.displacement.scale = 0.4 * (frame + 1) / frames;
    const double angle = 0.5 * frame / frames;
    settings.camera.eye = {0.5 + 1.6 * std::sin(angle), 0.5 - 1.6 * std::cos(angle), 1.2};
    settings.camera.target = {0.5, 0.5, 0.1};
    settings.camera.up = {0, 0, 1};
    settings.camera.near_plane = 0.01;
    settings.camera.viewport_width = 320;
    settings.camera.viewport_height = 240;
    return scene;
}

/// Addresses in memory of a frame's inputs and its ring.
struct Places {
    std::uint64_t tables, triangles, ring;
};

Places write_frame(const tessera::PreparedScene& scene, Memory& memory) {
    const std::uint64_t tables = 0;  // at their layouts' addresses
    const tessera::datapath::TableLayout& last = scene.registers.height_table;
    const std::uint64_t triangles = (last.base + last.bytes() + 3) / 4 * 4;
    tessera::write_tables(scene, [&](std::uint64_t address, const unsigned char* bytes, std::size_t count) {
        std::memcpy(&memory.bytes.at(tables + address), bytes, count);
    });
    std::uint64_t next = triangles;
    for (const tessera::datapath::Triangle& triangle : scene.base_triangles) {
        tessera::write_base_triangle(triangle, &memory.bytes.at(next));
        next += tessera::base_triangle_bytes;
    }
    return {tables, triangles, next};
}

/// Draws a frame and reads its triangles. Returns their number; negative: the device's error.
int draw(tessera_driver& driver, const tessera::PreparedScene& scene, const Places& places, Picture& picture) {
    const tessera::datapath::Registers& r = scene.registers;
    int result = tessera::program_registers(driver.platform, r);
    tessera_set_tables(&driver, places.tables + r.displacement_map.base, places.tables + r.normal_map.base,
                       places.tables + r.height_table.base);
    tessera_fetch_tables(&driver, 7);
    tessera_set_triangles(&driver, places.triangles, static_cast<std::uint32_t>(scene.base_triangles.size()));
    tessera_set_ring(&driver, places.ring, ring_records);
    tessera_enable_interrupts(&driver, 3);
    if (result == TESSERA_OK)
        result = tessera_start(&driver);
    if (result == TESSERA_OK)
        result = tessera_wait(&driver, ~0u);
    std::uint32_t interrupts = 0, count = 0;
    tessera_acknowledge(&driver, &interrupts);
    tessera_ring_count(&driver, &count);
    if (result != TESSERA_OK) {
        std::fprintf(stderr, "platform: %s\n", tessera_text(result));
        return -1;
    }
    for (std::uint32_t k = 0; k < count; ++k) {
        tessera_finished_triangle triangle;
        tessera_ring_pop(&driver, &triangle);
        picture.draw(triangle, r.formats.screen.fraction);
    }
    return static_cast<int>(count);
}

}  // namespace

int sc_main(int argc, char** argv) {
    const std::string mode = argc > 1 ? argv[1] : "";
    const int frames = argc > 2 ? std::atoi(argv[2]) : 3;
    if ((mode != "functional" && mode != "timed") || frames < 1 || frames > frames_at_most) {
        std::fprintf(stderr, "usage: platform functional|timed [FRAMES, 1 to %d]\n", frames_at_most);
        return 2;
    }
    tessera::DeviceDesign design;
    design.machine.transport = mode == "timed" ? tessera::Transport::non_blocking : tessera::Transport::blocking;
    design.largest_map = {64, 64};
    tessera::Device device("device", tessera::prepare(scene_of(0, frames)).registers, design);
    Memory memory("memory", 4u << 20);
    Router router("router");
    Processor processor("processor");
    sc_core::sc_signal<bool> interrupt("interrupt");
    processor.bus.bind(router.from);
    device.bus.bind(router.from);
    router.to_device.bind(device.registers);
    router.to_memory.bind(memory.bus);
    device.interrupt.bind(interrupt);
    processor.interrupt.bind(interrupt);

    int drawn = 0;
    processor.program = [&](Processor& self) {
        const tessera_platform platform = self.platform();
        tessera_driver driver;
        if (tessera_init(&driver, &platform) != TESSERA_OK)
            return;
        for (; drawn < frames; ++drawn) {
            const tessera::PreparedScene scene = tessera::prepare(scene_of(drawn, frames));
            const Places places = write_frame(scene, memory);
            const std::uint64_t moved = router.bytes_moved;
            Picture picture(320, 240);
            const int triangles = draw(driver, scene, places, picture);
            const std::string name = mode + "_" + std::to_string(drawn) + ".pgm";
            if (triangles < 0 || !picture.write(name))
                return;
            std::printf("%s: %d triangles, %llu bytes to and from memory, done at %s\n", name.c_str(), triangles,
                        static_cast<unsigned long long>(router.bytes_moved - moved),
                        sc_core::sc_time_stamp().to_string().c_str());
        }
    };
    sc_core::sc_start();
    if (device.busy())
        std::fprintf(stderr, "platform: the simulation ended during a frame: is the ring full?\n");
    return drawn == frames ? 0 : 1;
}
