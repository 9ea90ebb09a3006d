#include "testbench/machine/host_traffic.h"

#include "modules/datapath/fields.h"
#include "modules/datapath/registers.h"
#include "modules/datapath/vertex.h"

namespace tessera {

std::uint64_t base_mesh_bytes(const MachineSetup& setup) {
    datapath::WidthCounter width;
    datapath::Fields<datapath::WidthCounter> fields(width, setup.registers.formats);
    const datapath::Vertex vertex;
    describe_base_vertex(fields, vertex);
    return (setup.base_triangles.size() * 3 * width.bits + 7) / 8;
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

HostTraffic host_traffic(const MachineSetup& setup) {
    const datapath::Registers& r = setup.registers;
    const std::uint64_t n = setup.machines;
    return {base_mesh_bytes(setup), n * r.displacement_map.bytes(), n * r.normal_map.bytes(),
            n * r.height_table.bytes(), n * register_words(r).size() * sizeof(std::uint32_t)};
}

}  // namespace tessera
