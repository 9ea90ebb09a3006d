#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "golden/golden_map.h"
#include "golden/golden_model.h"

/// Derives the golden model's inputs from a job in model units (ALGORITHM.md section 6), in double precision. Written
/// from that page; it shares no code with the host.
namespace tessera::golden {

/// Model to world: world = scale * (model - centre). The host chooses it so that the world fits the formats.
struct Placement {
    glm::dvec3 centre{0};
    double scale = 1;
    glm::dvec3 to_world(const glm::dvec3& model) const { return scale * (model - centre); }
};

struct Camera {
    glm::dvec3 eye{0, 0, 1}, target{0};  ///< model units
    glm::dvec3 up{0, 1, 0};              ///< any length, not parallel to eye - target
    double field_of_view = 90;           ///< vertical, degrees
    double near_plane = 0;               ///< model units
    glm::dvec2 viewport{1, 1};           ///< width and height in pixels
};

/// The camera's axes, and its transform in the form of Parameters. Pixel (0, 0) is the viewport's lower left corner, y
/// upwards.
struct View {
    glm::dvec3 right{1, 0, 0}, up{0, 1, 0}, backward{0, 0, 1};  ///< unit, world; backward: towards the viewer
    glm::dvec3 eye{0};                                          ///< world
    glm::dvec4 row_x{0}, row_y{0}, row_w{0};
    double near_plane = 0;  ///< world units
    double rounding = 0;    ///< bound on the double-precision error of the axes' components: 2^-49 / sin(up, backward)
};
View make_view(const Camera& camera, const Placement& placement);

/// The size in pixels of an object of height 1 at distance 1 in the centre of the picture.
double focal_length(const Camera& camera);

/// v / |v|, without overflow or underflow; zero stays zero.
glm::dvec3 unit(const glm::dvec3& v);

/// All inputs of the golden model except mesh, map and height test.
struct Scene {
    Camera camera;
    Placement placement;

    double lowest = 0, highest = 1;  ///< displacement of code 0 and of the highest code, model units
    double highest_code = 65535;
    double texel_area = 1;  ///< world units

    double normal_threshold = 0;  ///< difference of one component of two unit normals
    /// Texture coordinates are not clamped on a clamped axis: the mesh extends beyond the map.
    bool beyond_map = false;
    double view_threshold = 0;  ///< pixels
    int generation_limit = 12;
    double highlight_angle = 0;  ///< degrees
    double highlight_normal_threshold = 0;
    Parameters::Enabled enabled;
    Diagonal diagonal = Diagonal::shorter;
    Filter filter = Filter::nearest;
    double texel_parts = 1;  ///< parts per texel and axis that the Tex Coord Test distinguishes

    glm::dvec3 light{0, 0, 1};  ///< direction towards the light, world, any length
};
Parameters make_parameters(const Scene& scene);

/// Unit direction towards the light; components along the view's right, up and backward axes.
glm::dvec3 light_as_seen(const Scene& scene);

/// A map value's code before rounding: 0 at `low`, highest_code at `high`, clamped to that range.
double code_of(double value, double low, double high, double highest_code);

/// What a source says about a map's values.
struct MapSource {
    std::vector<double> no_data;  ///< values that mark missing data, in source units
    double units = 1;             ///< source units per unit of value
    int significant_bits = 24;    ///< of a value
};

/// The heights of a map (2): values that are none, as NaN, infinite or missing, are replaced.
std::vector<float> heights_of(std::vector<float> values, const MapSource& source);

/// A base vertex in world units and texels. `uv` spans the map once from 0 to 1; on a clamped axis it is clamped to the
/// map, unless `beyond_map`.
Vertex place_vertex(const Vertex& in_model_units, const glm::dvec2& uv, const Placement& placement, const Map& map,
                    bool beyond_map = false);

/// A base vertex's texture coordinate rounded to the nearest multiple of `step`, ties to even.
glm::dvec2 on_grid(const glm::dvec2& t, double step);

}  // namespace tessera::golden
