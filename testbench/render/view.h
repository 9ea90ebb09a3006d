#pragma once
#include <glm/glm.hpp>

#include "testbench/job/job.h"
#include "testbench/render/render_mesh.h"

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

    /// The ray through an image point; its component along the view direction is 1, so a hit's distance is w.
    glm::dvec3 ray(double x, double y) const;

    /// (x w, y w, w) of a point: linear, valid behind the eye too.
    glm::dvec3 project(const glm::dvec3& point) const;
};

/// The run's own camera and viewport.
View make_view(const Job::Camera& camera);

/// The same eye and perspective with another image size: all of `view` stays in sight.
View resized(const View& view, int width, int height);

/// Ratio of width to height of the part that framed() enlarges.
double proportions(const View& view, const RenderMesh& mesh);

/// The same eye and perspective, enlarged to the part of `view` occupied by the mesh, with a margin (a fraction of the
/// image's sides). Parts outside `view` stay outside, except for the margin and the image's proportions.
View framed(const View& view, const RenderMesh& mesh, int width, int height, double margin = 0.04);

/// A close-up: the image point (across * width, down * height) becomes the centre, and everything is magnified by
/// `factor`.
View zoomed(const View& view, double across, double down, double factor);

}  // namespace tessera
