#pragma once
#include <cstdint>
#include <vector>

#include "modules/device/records.h"
#include "testbench/machine/machine_setup.h"

namespace tessera::testing {

/// The data of a frame in bus memory.
struct FrameImage {
    std::vector<unsigned char> displacement_map, normal_map, summed_height_table, triangles;
};

/// Sets the bits of a table's entries beyond their format.
inline void fill_beyond(std::vector<unsigned char>& table, std::size_t entry_bytes, int bits) {
    for (std::size_t entry = 0; entry < table.size(); entry += entry_bytes)
        for (std::size_t bit = static_cast<std::size_t>(bits); bit < 8 * entry_bytes; ++bit)
            table[entry + bit / 8] = static_cast<unsigned char>(table[entry + bit / 8] | 1u << bit % 8);
}

/// The three tables and the base triangles of a set-up. beyond: sets bits of an entry beyond its format.
inline FrameImage image_of(const MachineSetup& setup, bool beyond = false) {
    FrameImage image;
    const datapath::Registers& r = setup.registers;
    write_tables(setup, [&](std::uint64_t address, const unsigned char* bytes, std::size_t count) {
        auto& table = address >= r.height_table.base ? image.summed_height_table
                      : address >= r.normal_map.base ? image.normal_map
                                                     : image.displacement_map;
        table.insert(table.end(), bytes, bytes + count);
    });
    if (beyond) {
        fill_beyond(image.displacement_map, r.displacement_map.entry_bytes, r.formats.displacement.bits);
        fill_beyond(image.normal_map, r.normal_map.entry_bytes, 3 * r.formats.normal.bits);
        fill_beyond(image.summed_height_table, r.height_table.entry_bytes, datapath::height_entry_bits(r.formats));
    }
    image.triangles.resize(setup.base_triangles.size() * base_triangle_bytes);
    for (std::size_t k = 0; k < setup.base_triangles.size(); ++k)
        write_base_triangle(setup.base_triangles[k], &image.triangles[k * base_triangle_bytes]);
    return image;
}

}  // namespace tessera::testing
