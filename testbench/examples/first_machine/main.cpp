#include <cmath>
#include <cstdio>
#include <systemc>

#include "modules/host.h"
#include "modules/rasteriser.h"
#include "testbench/setup/prepare_scene.h"

using namespace tessera;

namespace {

/// A square of two triangles with a bump.
PreparedScene square_with_bump() {
    Scene scene;
    scene.vertices = {{{0, 0, 0}, {0, 0}, {0, 0, 1}},
                      {{1, 0, 0}, {1, 0}, {0, 0, 1}},
                      {{1, 1, 0}, {1, 1}, {0, 0, 1}},
                      {{0, 1, 0}, {0, 1}, {0, 0, 1}}};
    scene.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.map_width = scene.map_height = 64;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            scene.map.push_back(static_cast<float>(std::exp(-(std::pow(x - 31.5, 2) + std::pow(y - 31.5, 2)) / 200)));
    scene.settings.displacement.scale = 0.4;
    scene.settings.camera = {{0.5, -1.1, 1.2}, {0.5, 0.5, 0.1}, {0, 0, 1}, 36, 0.01, 1024, 768};
    return prepare(scene);
}

}  // namespace

int sc_main(int, char**) {
    const PreparedScene scene = square_with_bump();
    Design design;
    design.transport = Transport::non_blocking;  // timed mode
    Machine machine("machine", scene.registers, design);
    Host host("host", machine, scene.base_triangles, [&](const TableWriter& writer) { write_tables(scene, writer); });
    Rasteriser rasteriser("rasteriser", machine.clock, design.timing.stalls);
    host.bind();
    machine.lighting.to_rasteriser.bind(rasteriser.from_lighting);
    sc_core::sc_start();
    std::printf("%u triangles in %u cycles\n", static_cast<unsigned>(rasteriser.triangles()),
                static_cast<unsigned>(machine.clock.last_cycle() + 1));
    return machine.idle() && rasteriser.triangles() > 2 ? 0 : 1;
}
