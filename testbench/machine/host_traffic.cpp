#include "testbench/machine/host_traffic.h"

#include "modules/datapath/registers.h"
#include "modules/datapath/widths.h"

namespace tessera {

std::uint64_t base_mesh_bytes(const MachineSetup& setup) {
    const datapath::Widths widths = datapath::stream_widths(setup.registers.formats);
    return (setup.base_triangles.size() * 3 * widths.base_vertex + 7) / 8;
}

std::vector<std::uint32_t> register_words(const datapath::Registers& registers) {
    std::vector<std::uint32_t> words(1);  // first word: switches and choices
    int choice_bits = 0;
    datapath::visit_registers(registers, [&](const datapath::Register& field, const auto& values) {
        for (const std::int64_t value : values) {
            const auto code = static_cast<std::uint64_t>(value);
            if (field.kind == datapath::RegisterKind::choice) {
                words[0] |= static_cast<std::uint32_t>(code << choice_bits);
                choice_bits += field.bits;
                continue;
            }
            words.push_back(static_cast<std::uint32_t>(code));
            if (field.bits > 32)
                words.push_back(static_cast<std::uint32_t>(code >> 32));
        }
    });
    return words;
}

HostTraffic first_frame_traffic(const MachineSetup& setup) {
    const datapath::Registers& r = setup.registers;
    const std::uint64_t n = setup.machines;
    return {base_mesh_bytes(setup), n * r.displacement_map.bytes(), n * r.normal_map.bytes(),
            n * r.height_table.bytes(), n * register_words(r).size() * sizeof(std::uint32_t)};
}

HostTraffic next_frame_traffic(const MachineSetup& before, const MachineSetup& now) {
    HostTraffic traffic = first_frame_traffic(now);
    if (before.heights() == now.heights())
        traffic.displacement_map = 0;
    if (before.map.codes == now.map.codes) {
        // a Rank Table's radii depend on the displacement scale and the format of distances, too
        if (before.rank_tables.radius == now.rank_tables.radius)
            traffic.summed_height_table = 0;
        // the normals follow from heights and texels' sizes, of which only the quotients matter
        if (before.height_per_code / before.texel_size[0] == now.height_per_code / now.texel_size[0] &&
            before.height_per_code / before.texel_size[1] == now.height_per_code / now.texel_size[1])
            traffic.normal_map = 0;
    }
    const std::vector<std::uint32_t> old_words = register_words(before.registers),
                                     words = register_words(now.registers);
    traffic.registers = 0;
    for (std::size_t k = 0; k < words.size(); ++k)
        traffic.registers += words[k] == old_words[k] ? 0 : now.machines * sizeof(std::uint32_t);
    return traffic;
}

}  // namespace tessera
