#pragma once
#include <cstdint>
#include <vector>

#include "modules/datapath/parameters.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// Bytes that the host sends for one frame.
struct HostTraffic {
    std::uint64_t base_mesh = 0;  ///< every frame: the machine keeps no base mesh
    std::uint64_t displacement_map = 0;
    std::uint64_t normal_map = 0;
    std::uint64_t summed_height_table = 0;
    std::uint64_t registers = 0;

    std::uint64_t total() const {
        return base_mesh + displacement_map + normal_map + summed_height_table + registers;
    }
};

/// A run's base mesh as it goes to Get Triangle: three vertices of P, N, T, handedness, t a triangle, as wires.
std::uint64_t base_mesh_bytes(const MachineSetup& setup);

/// The registers (modules/datapath/registers.h) as the host writes them, 32 bit words: a register of at most 32 bits is
/// one word, a longer one two; switches and choices share the first. As many words for every job of one design.
std::vector<std::uint32_t> register_words(const datapath::Registers& registers);

/// What a machine needs that knows nothing yet.
HostTraffic first_frame_traffic(const MachineSetup& setup);

/// What a machine needs that has rendered the frame `before`: the base mesh, and of all else what is another now, a
/// table as a whole or a register's word. Another displacement scale: the normal map, and the register S; the model's
/// scale and with it Transform's matrix too where the displacement outgrows the position's range or lets it shrink.
HostTraffic next_frame_traffic(const MachineSetup& before, const MachineSetup& now);

}  // namespace tessera
