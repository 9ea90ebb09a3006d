#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "modules/datapath/vertex.h"
#include "testbench/bake/displaced_surface.h"
#include "testbench/machine/machine_setup.h"
#include "testbench/output/report/mesh_units.h"
#include "testbench/setup/height_map.h"

namespace tessera {

/// The error of one emitted triangle, independent of all others, so that it stays valid when thresholds change: at
/// every texel centre of the map that the triangle covers in texture space, the distance between the triangle and the displaced
/// surface at the same texture coordinate. On a height field this is the vertical error of
/// compare/height_field.h, except that a centre on an edge belongs to one of the two triangles here, and
/// one on the mesh's border may belong to none.
/// Elsewhere it is an upper bound on the distance from that point of the surface to the mesh.
class TexelError {
  public:
    struct Sum {
        double squares = 0, weight = 0;  ///< weight: area of the base surface per texel
        double max = 0;

        void add(const Sum& other) {
            squares += other.squares;
            weight += other.weight;
            max = max > other.max ? max : other.max;
        }
    };

    /// `setup` and `map` must outlive it.
    TexelError(const MachineSetup& setup, const HeightMap& map, const DisplacementOf& displacement);

    Sum of(const std::array<const datapath::Vertex*, 3>& corners, std::uint32_t base) const;

  private:
    /// A base triangle: position, normal as affine functions of the texel coordinate.
    struct Base {
        glm::dvec3 position{0}, position_u{0}, position_v{0};
        glm::dvec3 normal{0}, normal_u{0}, normal_v{0};
        double weight = 0;  ///< area of a texel; 0: without area in texture space, not measured
        bool flat = false;  ///< one normal, of unit length already
    };

    Base make_base(const datapath::Triangle& triangle) const;

    const MachineSetup& setup_;
    const HeightMap& map_;
    DisplacementOf displacement_;
    MeshUnits units_;
    std::vector<Base> bases_;
};

}  // namespace tessera
