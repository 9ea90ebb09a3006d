#pragma once
#include <cmath>
#include <glm/glm.hpp>

#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"

namespace tessera {

/// Converts the machine's integers to the model: model = world / scale + centre (MachineSetup::model_scale).
///
///     const MeshUnits units{setup.registers.formats, setup.registers.map, setup.model_scale.scale,
///                           setup.model_scale.centre};
struct MeshUnits {
    datapath::Formats formats;
    datapath::MapGeometry map;
    double scale = 1;
    glm::dvec3 centre{0};

    /// In model units. Exact except for one rounding when the centre is added: the scale is a power of two.
    glm::dvec3 position(const datapath::Position& p) const {
        return glm::dvec3(p.x, p.y, p.z) * (std::ldexp(1.0, -formats.position.fraction) / scale) + centre;
    }
    /// As in the machine: of unit length up to rounding, or zero.
    glm::vec3 normal(const datapath::Direction& n) const {
        return glm::vec3(glm::dvec3(n.x, n.y, n.z) * std::ldexp(1.0, -formats.normal.fraction));
    }
    /// 0..1 spans the map once; v = 0 is the bottom row. On a repeated axis it may differ from the file's by whole
    /// periods.
    glm::dvec2 texture(const datapath::TexCoord& t) const {
        const double texel = std::ldexp(1.0, -formats.texture.fraction);
        return glm::dvec2(t.u, t.v) * texel / glm::dvec2(map.width, map.height);
    }
};

}  // namespace tessera
