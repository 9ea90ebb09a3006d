#pragma once
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "testbench/bake/nurbs_patch.h"
#include "testbench/bake/quadric.h"

namespace tessera {

/// A quadric of a surface file.
struct QuadricSurface {
    Quadric quadric;
    std::optional<Root> root;     ///< absent: highest over the plane, nearest over a base mesh
    std::optional<double> floor;  ///< height of texels where the surface is lower or absent, model units
    std::string where;            ///< "FILE:LINE" of its table, for messages
};

/// A curved surface to be sampled into a displacement map.
struct Surface {
    std::variant<QuadricSurface, NurbsPatch> shape;
    /// The rectangle of the plane z = 0 that the map spans, unless there is a base mesh; model units. A patch is
    /// stretched over it.
    glm::dvec2 low{-1}, high{1};
    bool has_domain = false;  ///< the file gives it
};

/// Reads a surface file, TOML: one of these tables, and optionally [domain]. Unknown keys are errors.
/// Lengths in model units, -1e6 .. 1e6.
///
///     [domain]                  the default plane of a job
///     x = [-1.0, 1.0]
///     y = [-1.0, 1.0]
///
///     [quadric]
///     shape        sphere, ellipsoid, paraboloid, cone, cylinder, hyperboloid (quadric.h) or general
///     centre       [x, y, z]; default the origin
///     radius       or semi_axes = [a, b, c], along x, y and z; 1e-6 .. 1e6, of a paraboloid's axis also negative
///     axis         "x", "y" or "z", the default: of all but sphere, ellipsoid and general
///     sheets       1 or 2: of a hyperboloid
///     coefficients general only: of x^2, y^2, z^2, xy, xz, yz, x, y, z and 1; each -1e12 .. 1e12
///     root         "highest", "lowest" or "nearest": the intersection to use if there are two
///     floor        height where the surface is absent or lower; default: no texel is raised, and where the surface is
///                  absent the map has its lowest height elsewhere
///
///     [nurbs]                   any degree from 1 to 32
///     degree_u, degree_v
///     knots_u, knots_v          as many as columns (rows) of heights + degree + 1
///     heights                   rows of control heights, along u; the first row at v = 0
///     weights                   rows likewise, 1e-9 .. 1e9; default 1
///
///     [bezier]                  heights and weights; the degrees are their number less 1
///
/// Errors: InputError, "FILE:LINE:COLUMN: ...", with the value found, the value expected and the limit.
Surface read_surface(const std::filesystem::path& path);

/// The same from memory; messages show `name` as the file.
Surface parse_surface(std::string_view text, const std::string& name);

}  // namespace tessera
