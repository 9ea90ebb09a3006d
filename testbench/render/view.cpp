#include "testbench/render/view.h"

#include <algorithm>

#include "testbench/setup/view.h"

namespace tessera {
namespace {

struct Rectangle {
    glm::dvec2 low, high;
};

/// Shows `part` of the view's image centred and as large as it fits.
View enlarged(const View& view, const Rectangle& part, int width, int height) {
    const glm::dvec2 size = part.high - part.low;
    const double zoom = std::min(width / size.x, height / size.y);
    View result = view;
    result.width = width;
    result.height = height;
    result.focal *= zoom;
    result.centre = glm::dvec2(width, height) / 2.0 + (view.centre - (part.low + part.high) / 2.0) * zoom;
    return result;
}

/// The part of the view's image occupied by the mesh; all of it if none, or if part of the mesh is too near to project.
Rectangle occupied(const View& view, const RenderMesh& mesh) {
    const glm::dvec2 size(view.width, view.height);
    const Rectangle all{glm::dvec2(0), size};
    Rectangle seen{size, glm::dvec2(0)};
    for (const glm::vec3& position : mesh.positions) {
        const glm::dvec3 p = view.project(mesh.origin + glm::dvec3(position));
        if (!(p.z > view.near_plane))
            return all;
        const glm::dvec2 pixel = glm::clamp(glm::dvec2(p) / p.z, glm::dvec2(0), size);
        seen.low = glm::min(seen.low, pixel);
        seen.high = glm::max(seen.high, pixel);
    }
    return seen.high.x - seen.low.x >= 1 && seen.high.y - seen.low.y >= 1 ? seen : all;
}

}  // namespace

glm::dvec3 View::ray(double x, double y) const {
    return right * ((x - centre.x) / focal) + up * ((centre.y - y) / focal) - backward;
}

glm::dvec3 View::project(const glm::dvec3& point) const {
    const glm::dvec3 seen = point - eye;
    const double w = -glm::dot(seen, backward);
    return {focal * glm::dot(seen, right) + centre.x * w, centre.y * w - focal * glm::dot(seen, up), w};
}

View make_view(const Job::Camera& camera) {
    const ViewAxes axes = view_axes(camera);
    View view;
    view.eye = {camera.eye[0], camera.eye[1], camera.eye[2]};
    view.right = axes.right;
    view.up = axes.up;
    view.backward = axes.backward;
    view.width = static_cast<int>(camera.viewport_width);
    view.height = static_cast<int>(camera.viewport_height);
    view.focal = focal_length(camera);
    view.centre = glm::dvec2(view.width, view.height) / 2.0;
    view.near_plane = camera.near_plane;
    return view;
}

View resized(const View& view, int width, int height) {
    return enlarged(view, {glm::dvec2(0), glm::dvec2(view.width, view.height)}, width, height);
}

double proportions(const View& view, const RenderMesh& mesh) {
    const Rectangle part = occupied(view, mesh);
    return (part.high.x - part.low.x) / (part.high.y - part.low.y);
}

View framed(const View& view, const RenderMesh& mesh, int width, int height, double margin) {
    const Rectangle part = occupied(view, mesh);
    const glm::dvec2 border = (part.high - part.low) * (margin / (1 - 2 * margin));
    return enlarged(view, {part.low - border, part.high + border}, width, height);
}

View zoomed(const View& view, double across, double down, double factor) {
    const glm::dvec2 size(view.width, view.height);
    View result = view;
    result.focal *= factor;
    result.centre = size / 2.0 + (view.centre - glm::dvec2(across, down) * size) * factor;
    return result;
}

}  // namespace tessera
