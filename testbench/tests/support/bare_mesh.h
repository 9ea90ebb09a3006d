#pragma once
#include <catch2/catch.hpp>
#include <cstdint>

#include "testbench/machine/bare_recursion.h"
#include "testbench/tests/machine/mesh_keys.h"

namespace tessera::testing {

/// Runs the datapath without SystemC on a machine's set-up.
struct BareRun {
    explicit BareRun(const MachineSetup& setup) {
        BareRecursion bare(setup);
        edges = bare.run(mesh);
        saturations = bare.saturations;
    }
    EmittedMesh mesh;
    std::uint64_t edges = 0;
    datapath::Saturations saturations;
};

inline EmittedMesh bare_mesh(const MachineSetup& setup) {
    return BareRun(setup).mesh;
}

/// The same triangles, in any order.
inline void expect_mesh(const EmittedMesh& mesh, const EmittedMesh& expected) {
    CHECK(mesh.triangles.size() == expected.triangles.size());
    CHECK((keys(mesh) == keys(expected)));  // extra parentheses: nothing is printed
}

}  // namespace tessera::testing
