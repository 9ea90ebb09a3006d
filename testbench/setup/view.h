#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "modules/datapath/parameters.h"
#include "testbench/setup/model_scale.h"
#include "testbench/setup/scene_settings.h"

namespace tessera {

/// View space's axes in world space, unit length: x right, y up, z towards the viewer.
struct ViewAxes {
    glm::dvec3 right, up, backward;
};

ViewAxes view_axes(const CameraSettings& camera);

/// The size in pixels of an object of height 1 at distance 1 in the picture's centre.
double focal_length(const CameraSettings& camera);
/// 1 / cosine of the angle between the view's axis and a corner of the picture.
double corner_secant(const CameraSettings& camera);

/// Input: a resolved camera in model units. Output: Transform's registers: world to pixels (x right, y up, (0, 0) the
/// viewport's lower left corner), the near plane, and the rotation of normals to view space; saturated entries of the
/// rotation are counted. Throws InputError if the eye is too far from the mesh's centre for Transform's sums.
datapath::TransformParameters make_transform(const CameraSettings& camera, const ModelScale& model_scale,
                                             const datapath::Formats& formats, std::uint64_t& saturated);

/// Size of a distance's LSB in world units.
double distance_step(const datapath::Formats& formats);

/// The format of distances along the view axis: a position's width, with the point moved until the distance of the
/// farthest corner of the position's range fits.
datapath::Format view_distance_format(const datapath::TransformParameters& transform, const datapath::Format& position);

}  // namespace tessera
