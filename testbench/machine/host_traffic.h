#pragma once
#include <cstdint>
#include <vector>

#include "modules/datapath/parameters.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// Bytes that the host sends for one frame.
struct HostTraffic {
    std::uint64_t base_mesh = 0;  ///< sent every frame: the machine does not store the base mesh
    std::uint64_t displacement_map = 0;
    std::uint64_t normal_map = 0;
    std::uint64_t summed_height_table = 0;
    std::uint64_t registers = 0;

    std::uint64_t total() const { return base_mesh + displacement_map + normal_map + summed_height_table + registers; }
};

/// Size of a run's base mesh as sent to Get Triangle: three vertices of P, N, T, handedness, t per triangle.
std::uint64_t base_mesh_bytes(const MachineSetup& setup);

/// The registers (modules/datapath/registers.h) as 32 bit words written by the host: a register of at most 32 bits
/// takes one word, a wider one two; switches and choices share the first. Their number depends on the design only.
std::vector<std::uint32_t> register_words(const datapath::Registers& registers);

/// Traffic for a frame for which everything is sent.
HostTraffic host_traffic(const MachineSetup& setup);

}  // namespace tessera
