#include "modules/device/driver/example.h"

#include <regex>
#include <string>

#include "testbench/tests/modules/device/bench.h"
#include "testbench/tests/support/source_folder.h"
#include "testbench/tests/support/test_folder.h"

// The example of modules/device/README.md.

using namespace tessera;
using namespace tessera::testing;

TEST_CASE("the example draws three frames, and the README names its functions") {
    const MachineSetup setup = setup_of(small_job(true));
    std::vector<MachineSetup> setups(3, setup);
    std::vector<std::unique_ptr<Reference>> references;
    for (std::size_t k = 0; k < setups.size(); ++k) {
        setups[k].registers.displacement.scale /= 1 << k;
        references.push_back(std::make_unique<Reference>("reference_" + std::to_string(k), setups[k]));
    }
    Bench bench({setup.registers}, design_of(setup));
    const FramePlaces places = bench.place(setup, 64);
    std::vector<LitKeys> found(3);
    bench.cpu.program = [&](Processor&) {
        const tessera_platform platform = bench.contexts[0].platform();
        const example_scene scene{
            places.displacement_map,
            places.normal_map,
            places.summed_height_table,
            places.triangles,
            places.ring,
            places.triangle_count,
            places.ring_size,
            &found,
            [](void* drawing, int frame, const tessera_finished_triangle* triangle) {
                (*static_cast<std::vector<LitKeys>*>(drawing))[static_cast<std::size_t>(frame)].insert(
                    key_of(*triangle));
            }};
        CHECK(draw_three_frames(&platform, &scene) == TESSERA_OK);
    };
    bench.run();
    for (std::size_t k = 0; k < 3; ++k)
        expect_same(found[k], references[k]->keys);
    CHECK(found[0] != found[1]);

    const std::string page = read_all(source_folder() / "modules/device/README.md");
    const std::string example = read_all(source_folder() / "modules/device/driver/example.c");
    const std::regex name("`(tessera_[a-z_]+)`");
    unsigned functions = 0;
    for (std::sregex_iterator it(page.begin(), page.end(), name), end; it != end; ++it) {
        const std::string function = (*it)[1];
        if (function == "tessera_benchmark")
            continue;
        ++functions;
        CHECK_THAT(example, Catch::Contains(function + "("));
    }
    CHECK(functions == 10);
}
