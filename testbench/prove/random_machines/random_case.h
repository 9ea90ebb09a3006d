#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "testbench/job/job.h"
#include "testbench/machine/machine_setup.h"
#include "testbench/prove/random_machines/random_map.h"
#include "testbench/prove/random_machines/random_mesh.h"
#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// A complete input of the machine, determined by its seed alone: mesh, map and job, as in files.
struct RandomCase {
    /// Limit on the edges evaluated for the mesh: thresholds and the generation limit are raised and lowered until it
    /// is met and, in four of five cases, as far as that helps, until the mesh takes `wanted_edges`.
    static constexpr std::uint64_t most_edges = 40000;
    static constexpr std::uint64_t wanted_edges = 4000;

    std::uint64_t seed = 0;
    Job job;  ///< mesh.file and map.file are the names used by write()
    RandomMesh mesh;
    RandomMap map;

    /// One line that describes mesh, map and design.
    std::string summary() const;

    BaseMesh base_mesh() const;
    HeightMap height_map() const { return map.height_map(); }
    MachineSetup setup() const;

    /// Writes job.toml, mesh.obj and map.pgm: `tessera run FOLDER/job.toml` runs the same case. Creates the folder.
    void write(const std::filesystem::path& folder, Mode mode) const;
};

RandomCase make_random_case(std::uint64_t seed);

}  // namespace tessera
