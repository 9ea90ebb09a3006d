#include "testbench/host/host_traffic.h"

#include <algorithm>

#include "modules/datapath/widths.h"

namespace tessera {

namespace {

class Words {
  public:
    void put(std::uint32_t value) { words.push_back(value); }
    void put(std::int32_t value) { words.push_back(static_cast<std::uint32_t>(value)); }
    void put_two(std::uint64_t value) {
        put(static_cast<std::uint32_t>(value));
        put(static_cast<std::uint32_t>(value >> 32));
    }

    void put(const datapath::TestParameters& tests) {
        put(tests.normal_threshold);
        put_two(tests.summed_height_threshold);
        put(tests.view_threshold);
        put(tests.generation_limit);
    }

    void put(const datapath::TransformParameters& transform) {
        for (const auto* row : {&transform.row_x, &transform.row_y, &transform.row_w}) {
            for (std::size_t k = 0; k < 3; ++k)
                put(static_cast<std::int32_t>((*row)[k]));  // -1..1 with 24 fraction bits
            put_two(static_cast<std::uint64_t>((*row)[3]));
        }
        put(transform.exponent);
        put_two(static_cast<std::uint64_t>(transform.near_plane));
        for (const auto& row : transform.normal_rows)
            for (const std::int32_t entry : row)
                put(entry);
    }

    void put(const datapath::LightParameters& light) {
        for (const std::int32_t component : light.direction)
            put(component);
        put(light.ambient);
    }

    std::vector<std::uint32_t> words;
};

std::uint32_t switches(const datapath::Registers& r) {
    const auto bit = [](auto value, unsigned place) { return static_cast<std::uint32_t>(value) << place; };
    return bit(r.tests.normal_test, 0) | bit(r.tests.summed_height_test, 1) | bit(r.tests.view_test, 2) |
           bit(r.tests.tex_coord_test, 3) | bit(r.tests.generation_test, 4) |
           bit(r.tests.summed_height_unit, 5) | bit(r.map.address_u, 6) | bit(r.map.address_v, 7) |
           bit(r.triangulation, 8) | bit(r.back_face_culling, 10);
}

}  // namespace

std::uint64_t base_mesh_bytes(const Setup& setup) {
    const datapath::Widths widths = datapath::stream_widths(setup.registers.formats);
    return (setup.base_triangles.size() * 3 * widths.base_vertex + 7) / 8;
}

std::vector<std::uint32_t> register_words(const datapath::Registers& registers) {
    Words all;
    all.put(switches(registers));
    all.put(registers.map.width);
    all.put(registers.map.height);
    for (const auto* table :
         {&registers.displacement_map, &registers.normal_map, &registers.summed_height_table})
        all.put_two(table->base);  // columns and rows follow from the map's
    all.put(registers.tests);
    all.put(registers.displacement.scale);
    all.put(registers.displacement.bias);
    all.put(registers.transform);
    all.put(registers.light);
    return std::move(all.words);
}

HostTraffic first_frame_traffic(const Setup& setup) {
    const datapath::Registers& r = setup.registers;
    return {base_mesh_bytes(setup), r.displacement_map.bytes(), r.normal_map.bytes(),
            r.summed_height_table.bytes(), register_words(r).size() * sizeof(std::uint32_t)};
}

HostTraffic next_frame_traffic(const Setup& before, const Setup& now) {
    HostTraffic traffic = first_frame_traffic(now);
    if (before.map.codes == now.map.codes) {
        traffic.displacement_map = 0;
        traffic.summed_height_table = 0;
        // the normals follow from heights and texels' sizes, of which only the quotients matter
        if (before.height_per_code / before.texel_size == now.height_per_code / now.texel_size)
            traffic.normal_map = 0;
    }
    const std::vector<std::uint32_t> old_words = register_words(before.registers),
                                     words = register_words(now.registers);
    traffic.registers = 0;
    for (std::size_t k = 0; k < words.size(); ++k)
        traffic.registers += words[k] == old_words[k] ? 0 : sizeof(std::uint32_t);
    return traffic;
}

}  // namespace tessera
