#pragma once
#include <glm/glm.hpp>

#include "testbench/job/job.h"
#include "testbench/output/picture/render_mesh.h"

namespace tessera {

/// A pinhole camera and the image behind it. Pixels: x to the right, y down, (0, 0) the top left corner of
/// the image.
struct View {
    glm::dvec3 eye{0};
    glm::dvec3 right{1, 0, 0}, up{0, 1, 0}, backward{0, 0, 1};
    double focal = 1;       ///< pixels
    glm::dvec2 centre{0};   ///< where the view direction meets the image
    double near_plane = 0;  ///< model units, along the view direction
    int width = 0, height = 0;

    /// Through an image point; its component along the view direction is 1, so a hit's distance is w.
    glm::dvec3 ray(double x, double y) const;

    /// (x w, y w, w) of a point: linear, also behind the eye.
    glm::dvec3 project(const glm::dvec3& point) const;
};

/// The run's own camera and viewport.
View make_view(const Job::Camera& camera);

/// The same eye and perspective in an image of another size: all of `view` stays in sight.
View resized(const View& view, int width, int height);

/// Width to height of what framed() enlarges.
double proportions(const View& view, const RenderMesh& mesh);

/// The same eye and perspective, enlarged to the part of `view` where the mesh is, with a margin (a fraction of the
/// image's sides). What `view` leaves out stays out, except for the margin and what the image's proportions add.
View framed(const View& view, const RenderMesh& mesh, int width, int height, double margin = 0.04);

/// A close-up: the image point (across * width, down * height) comes to the middle, and everything gets `factor` times
/// larger.
View zoomed(const View& view, double across, double down, double factor);

}  // namespace tessera
