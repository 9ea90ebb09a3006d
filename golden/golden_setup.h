#pragma once
#include <glm/glm.hpp>

#include "golden/golden_map.h"
#include "golden/golden_model.h"

/// From a job, in the model's own units, to what the golden model runs on (ALGORITHM.md section 6), in double
/// precision. Written from that page, so that it shares no line with the host.
namespace tessera::golden {

/// From the model to the world: world = scale * (model - centre). The host chooses it so that the world fits the
/// formats; everything else follows from it.
struct Placement {
    glm::dvec3 centre{0};
    double scale = 1;
    glm::dvec3 to_world(const glm::dvec3& model) const { return scale * (model - centre); }
};

struct Camera {
    glm::dvec3 eye{0, 0, 1}, target{0};  ///< model units
    glm::dvec3 up{0, 1, 0};              ///< of any length, not along eye - target
    double field_of_view = 90;           ///< vertical, degrees
    double near_plane = 0;               ///< model units
    glm::dvec2 viewport{1, 1};           ///< width and height in pixels
};

/// The camera's axes and its transform, as Parameters has it. Pixel (0, 0) is the viewport's lower left
/// corner, y runs up.
struct View {
    glm::dvec3 right{1, 0, 0}, up{0, 1, 0}, backward{0, 0, 1};  ///< unit, world; backward: towards the viewer
    glm::dvec3 eye{0};                                          ///< world
    glm::dvec4 row_x{0}, row_y{0}, row_w{0};
    double near_plane = 0;  ///< world units
    double rounding =
        0;  ///< bound on the axes' components' error by double precision: 2^-49 / sin(up, backward)
};
View make_view(const Camera& camera, const Placement& placement);

/// v / |v|, |v| as small or large as a double can be; zero stays zero.
glm::dvec3 unit(const glm::dvec3& v);

/// All that the golden model needs to know besides mesh and map.
struct Scene {
    Camera camera;
    Placement placement;

    double lowest = 0, highest = 1;  ///< displacement of code 0 and of the highest code, model units
    double highest_code = 65535;

    double normal_threshold = 0;         ///< difference of one component of two unit normals
    double summed_height_threshold = 0;  ///< full-scale texels; with the area option: full scale
    bool area = false;
    double view_threshold = 0;  ///< pixels
    int generation_limit = 12;
    double highlight_angle = 0;  ///< degrees
    double highlight_normal_threshold = 0;
    Parameters::Enabled enabled;
    Diagonal diagonal = Diagonal::shorter;

    glm::dvec3 light{0, 0, 1};  ///< direction towards it, world, of any length
};
Parameters make_parameters(const Scene& scene);

/// The direction towards the light along the view's right, up and backward axes, unit length.
glm::dvec3 light_as_seen(const Scene& scene);

/// The code that a map value stands for, before it is rounded: 0 at `low`, highest_code at `high`, held between them.
double code_of(double value, double low, double high, double highest_code);

/// A base vertex, of which `uv` = 1 spans the map once, in world units and texels. A clamped axis holds the
/// coordinate on the map.
Vertex place_vertex(const Vertex& in_model_units, const glm::dvec2& uv, const Placement& placement,
                    const Map& map);

/// A base vertex's texture coordinate on a grid: the nearest step, a tie to the even one.
glm::dvec2 on_grid(const glm::dvec2& t, double step);

}  // namespace tessera::golden
