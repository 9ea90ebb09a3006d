#pragma once
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <optional>

#include "testbench/setup/scene_settings.h"

namespace tessera {

/// A job's resolved camera: maps points of model space to the picture.
class ErrorView {
  public:
    explicit ErrorView(const CameraSettings& camera)
        : eye_(vector(camera.eye)),
          forward_(glm::normalize(vector(camera.target) - eye_)),
          right_(glm::normalize(glm::cross(forward_, glm::normalize(vector(camera.up))))),
          up_(glm::cross(right_, forward_)),
          half_(glm::dvec2(camera.viewport_width, camera.viewport_height) / 2.0),
          focal_(half_.y / std::tan(glm::radians(camera.field_of_view) / 2)),
          near_(camera.near_plane) {}

    /// Offset in pixels from the picture's centre if the point is beyond the near plane, else infinite.
    glm::dvec2 place(const glm::dvec3& p) const {
        const glm::dvec3 from_eye = p - eye_;
        const double depth = glm::dot(from_eye, forward_);
        if (depth <= near_)
            return glm::dvec2(std::numeric_limits<double>::infinity());
        return focal_ / depth * glm::dvec2(glm::dot(from_eye, right_), glm::dot(from_eye, up_));
    }

    /// Distance in pixels between two points in the picture; nothing if the first is not in it.
    std::optional<double> apart(const glm::dvec3& in_picture, const glm::dvec3& other) const {
        const glm::dvec2 at = place(in_picture);
        if (!(std::abs(at.x) <= half_.x && std::abs(at.y) <= half_.y))
            return std::nullopt;
        return glm::length(place(other) - at);
    }

  private:
    static glm::dvec3 vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

    glm::dvec3 eye_, forward_, right_, up_;
    glm::dvec2 half_;  // of the picture, pixels
    double focal_, near_;
};

}  // namespace tessera
