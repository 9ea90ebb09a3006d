#pragma once
#include <cstdint>
#include <vector>

#include "modules/datapath/map_entry.h"
#include "modules/device/records.h"
#include "testbench/machine/machine_setup.h"

namespace tessera::testing {

/// What a frame needs in bus memory.
struct FrameImage {
    std::vector<unsigned char> displacement_map, normal_map, summed_height_table, triangles;
};

/// Appends entries, little endian.
inline void append(std::vector<unsigned char>& table, std::uint64_t entry, std::uint32_t bytes) {
    for (std::uint32_t k = 0; k < bytes; ++k)
        table.push_back(static_cast<unsigned char>(entry >> (8 * k)));
}

/// The three tables and the base triangles of a setup, as the host of testbench/machine would write them.
/// beyond: what bits of an entry beyond its format hold.
inline FrameImage image_of(const MachineSetup& setup, bool beyond = false) {
    FrameImage image;
    const auto filled = [&](std::uint64_t entry, int bits) {
        return beyond ? entry | ~std::uint64_t{0} << bits : entry;
    };
    const datapath::Registers& r = setup.registers;
    for (std::uint32_t y = 0; y < r.map.height; ++y) {
        for (std::uint32_t x = 0; x < r.map.width; ++x) {
            append(image.displacement_map, filled(setup.map.code(x, y), r.formats.displacement.bits),
                   r.displacement_map.entry_bytes);
            const datapath::Direction n =
                map_normal(setup.map, x, y, setup.height_per_code, setup.texel_size, r.formats.normal);
            append(image.normal_map, filled(datapath::pack_normal(n, r.formats.normal.bits), 3 * r.formats.normal.bits),
                   r.normal_map.entry_bytes);
        }
    }
    const auto mask = static_cast<std::uint64_t>(r.formats.summed_height.highest);
    std::vector<std::uint64_t> sums(r.map.width + 1);
    for (std::uint32_t y = 0; y <= r.map.height; ++y) {
        std::uint64_t along = 0;
        for (std::uint32_t x = 0; x <= r.map.width; ++x) {
            if (y > 0 && x > 0)
                along += setup.map.code(x - 1, y - 1);
            sums[x] = (sums[x] + along) & mask;
            append(image.summed_height_table, filled(sums[x], r.formats.summed_height.bits),
                   r.summed_height_table.entry_bytes);
        }
    }
    image.triangles.resize(setup.base_triangles.size() * base_triangle_bytes);
    for (std::size_t k = 0; k < setup.base_triangles.size(); ++k)
        write_base_triangle(setup.base_triangles[k], &image.triangles[k * base_triangle_bytes]);
    return image;
}

}  // namespace tessera::testing
