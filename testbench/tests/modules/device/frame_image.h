#pragma once
#include <cstdint>
#include <vector>

#include "modules/device/records.h"
#include "testbench/machine/machine_setup.h"

namespace tessera::testing {

/// What a frame needs in bus memory.
struct FrameImage {
    std::vector<unsigned char> displacement_map, normal_map, summed_height_table, triangles;
};

inline FrameImage image_of(const MachineSetup& setup) {
    FrameImage image;
    const datapath::Registers& r = setup.registers;
    write_tables(setup, [&](std::uint64_t address, const unsigned char* bytes, std::size_t count) {
        auto& table = address >= r.summed_height_table.base ? image.summed_height_table
                      : address >= r.normal_map.base        ? image.normal_map
                                                            : image.displacement_map;
        table.insert(table.end(), bytes, bytes + count);
    });
    image.triangles.resize(setup.base_triangles.size() * base_triangle_bytes);
    for (std::size_t k = 0; k < setup.base_triangles.size(); ++k)
        write_base_triangle(setup.base_triangles[k], &image.triangles[k * base_triangle_bytes]);
    return image;
}

}  // namespace tessera::testing
