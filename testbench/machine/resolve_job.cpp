#include "testbench/machine/resolve_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <stdexcept>

#include "testbench/common/error.h"
#include "testbench/job/job_keys.h"
#include "testbench/job/toml_text.h"
#include "testbench/setup/check_settings.h"
#include "testbench/setup/formats.h"
#include "testbench/setup/map_displacement.h"
#include "testbench/setup/model_scale.h"
#include "testbench/setup/unit_vector.h"

namespace tessera {

namespace {

constexpr double pi = glm::pi<double>();
constexpr double azimuth = 20 * pi / 180;                       // to the right of the front
constexpr double elevation = 38 * pi / 180;                     // above it
constexpr double filled = 0.9;                                  // of the picture's width and height
constexpr double flat_scale = 1.0 / 8, round_scale = 1.0 / 40;  // of the largest extent
constexpr double flatness = 0.1;                                // smallest extent over the next
constexpr double near_part = 1.0 / 1000;                        // of the distance from eye to target

glm::dvec3 vector(const std::array<double, 3>& a) {
    return {a[0], a[1], a[2]};
}
std::array<double, 3> array(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

/// Rounds to six digits of a number of the reference's size, so that job files are readable and independent of libm.
double rounded(double value, double reference) {
    if (reference == 0)
        return value;
    const int digits = 5 - static_cast<int>(std::floor(std::log10(std::abs(reference))));
    const double power = std::pow(10.0, std::abs(digits));
    const double result = digits < 0 ? std::nearbyint(value / power) * power : std::nearbyint(value * power) / power;
    return result == 0 ? 0 : result;  // not -0
}
glm::dvec3 rounded(const glm::dvec3& v, double reference) {
    return {rounded(v.x, reference), rounded(v.y, reference), rounded(v.z, reference)};
}

struct Box {
    glm::dvec3 low{0}, high{0};

    glm::dvec3 centre() const { return low + (high - low) / 2.0; }
    glm::dvec3 extent() const { return high - low; }
    double largest() const { return std::max({extent().x, extent().y, extent().z}); }
};

/// Bounding box of P + h N over the base vertices, for all given h.
Box bounding_box(const BaseMesh& mesh, const std::vector<double>& heights) {
    Box box;
    box.low = box.high = mesh.vertices.front().position + heights[0] * mesh.vertices.front().normal;
    for (const BaseVertex& vertex : mesh.vertices)
        for (const double height : heights) {
            const glm::dvec3 point = vertex.position + height * vertex.normal;
            box.low = glm::min(box.low, point);
            box.high = glm::max(box.high, point);
        }
    return box;
}

/// The axis along which the mesh is flat; -1 if none.
int flat_axis(const Box& box) {
    const glm::dvec3 extent = box.extent();
    std::array<int, 3> axes{0, 1, 2};
    std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return extent[a] < extent[b]; });
    return extent[axes[0]] < flatness * extent[axes[1]] ? axes[0] : -1;
}

glm::dvec3 unit_axis(int axis, double sign) {
    glm::dvec3 result(0);
    result[axis] = sign;
    return result;
}

glm::dvec3 find_up(MeshSource source, const BaseMesh& mesh, int flat) {
    const bool file = source == MeshSource::file;
    if (mesh.up && *mesh.up != glm::dvec3(0))
        return unit_vector(*mesh.up);
    if (!file || flat < 0)
        return unit_axis(file ? 1 : 2, 1);
    double side = 0;
    for (const BaseVertex& vertex : mesh.vertices)
        side += vertex.normal[flat];
    return unit_axis(flat, side < 0 ? -1 : 1);
}

/// The front direction of a model that stands upright: -y, or z if up is y.
glm::dvec3 front_of(const glm::dvec3& up) {
    const glm::dvec3 size = glm::abs(up);
    const glm::dvec3 front = size.y > size.x && size.y > size.z ? glm::dvec3(0, 0, 1) : glm::dvec3(0, -1, 0);
    return unit_vector(front - glm::dot(front, up) * up);
}

glm::dvec3 direction_to_eye(const glm::dvec3& up) {
    const glm::dvec3 front = front_of(up), right = glm::cross(up, front);
    return std::cos(elevation) * (std::cos(azimuth) * front + std::sin(azimuth) * right) + std::sin(elevation) * up;
}

/// The smallest distance from the target at which the box projects within the filled part of the picture. A corner at
/// (x, y) across the view and z towards the eye lies at focal * x / (distance - z) from the picture's middle.
double framing_distance(const Box& box, const glm::dvec3& target, const glm::dvec3& backward, const glm::dvec3& up,
                        const Job::Camera& camera) {
    const glm::dvec3 right = unit_vector(glm::cross(up, backward)), above = glm::cross(backward, right);
    const double half_height = std::tan(camera.field_of_view * pi / 360);  // of the picture, at distance 1
    const double half_width =
        half_height * static_cast<double>(camera.viewport_width) / static_cast<double>(camera.viewport_height);
    double distance = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const glm::dvec3 point{(corner & 1u) != 0 ? box.high.x : box.low.x, (corner & 2u) != 0 ? box.high.y : box.low.y,
                               (corner & 4u) != 0 ? box.high.z : box.low.z};
        const glm::dvec3 q = point - target;
        const double across =
            std::max(std::abs(glm::dot(q, right)) / half_width, std::abs(glm::dot(q, above)) / half_height);
        distance = std::max(distance, glm::dot(q, backward) + across / filled);
    }
    return distance;
}

class Resolver {
  public:
    Resolver(const Job& job, const BaseMesh& mesh, const HeightMap& map)
        : mesh_(mesh), map_(map), base_(bounding_box(mesh, {0})), flat_(flat_axis(base_)) {
        result_.job = job;
    }

    ResolvedJob result() {
        find_scale();
        check_displacement();
        find_camera();
        check();
        return std::move(result_);
    }

  private:
    void found(const std::string& key, const std::string& rule) {
        result_.found.push_back({key, toml_value(find_key(key)->get(result_.job)), rule});
    }

    void find_scale() {
        double& scale = result_.job.displacement.scale;
        if (!is_automatic(scale))
            return;
        const auto [low, high] = map_.extremes();
        const double span = map_.span_high - map_.span_low;
        const double reach = std::max(high, map_.span_high) - std::min(low, map_.span_low);
        scale = (flat_ >= 0 ? flat_scale : round_scale) * base_.largest();
        if (reach > span)
            scale *= span / reach;
        scale = rounded(scale, scale);
        found("displacement.scale", fmt::format("{} of the base mesh's largest extent, {:.6g}{}",
                                                flat_ >= 0 ? "flat: an eighth" : "a fortieth", base_.largest(),
                                                reach > span ? ", reduced because values exceed map.range" : ""));
    }

    /// A displacement that is too large for the formats would put the camera out of its range: it is refused first.
    void check_displacement() const {
        const Job& job = result_.job;
        const datapath::Format position = make_formats(job.formats, job.hardware.displacement_filter).position;
        fit_model(mesh_, job.displacement, map_, position, job.map.source == MapSource::file ? job.map.file : "map");
    }

    /// Lowest and highest displacement.
    std::vector<double> extreme_heights() const {
        std::vector<double> heights;
        for (const double value : map_.extremes())
            heights.push_back(MapDisplacement::from(result_.job.displacement, map_).of(value));
        return heights;
    }

    void find_camera() {
        Job& job = result_.job;
        Job::Camera& camera = job.camera;
        const Box box = bounding_box(mesh_, extreme_heights());
        const bool no_eye = is_automatic(camera.eye), no_target = is_automatic(camera.target),
                   no_up = is_automatic(camera.up);
        glm::dvec3 up = no_up ? find_up(job.mesh.source, mesh_, flat_) : glm::dvec3(0);
        if (!no_up && vector(camera.up) != glm::dvec3(0))
            up = unit_vector(vector(camera.up));
        glm::dvec3 target = no_target ? box.centre() : vector(camera.target);
        if (no_eye) {
            const glm::dvec3 backward = direction_to_eye(up);
            const double distance = framing_distance(box, target, backward, up, camera);
            if (no_target)
                target = rounded(target, distance);
            camera.eye = array(rounded(target + distance * backward, distance));
        } else if (no_target) {
            target = rounded(target, glm::length(vector(camera.eye) - target));
        }
        camera.target = array(target);
        const glm::dvec3 view = vector(camera.eye) - target;
        // Seen from directly above, the front is at the bottom.
        const bool along_up = no_up && glm::length(glm::cross(view, up)) <= 1e-6 * glm::length(view);
        if (along_up)
            up = glm::dvec3(0) - front_of(up);  // avoids -0
        if (no_up)
            camera.up = array(up);
        if (no_eye)
            found("camera.eye", "the displaced model's bounding box fits into 90 % of the picture's width and height");
        if (no_target)
            found("camera.target", "the centre of the displaced model's bounding box");
        if (no_up)
            found("camera.up", along_up   ? "seen along the up axis: the front is at the bottom"
                               : mesh_.up ? "as in the run that mesh.file names"
                               : job.mesh.source != MeshSource::file ? "z, as for all meshes except OBJ files"
                               : flat_ < 0                           ? "y, as in most OBJ files"
                                                                     : "the axis along which the mesh is flat");
        if (is_automatic(camera.near_plane)) {
            const double distance = glm::length(view) * near_part;
            camera.near_plane = rounded(distance, distance);
            found("camera.near_plane", "a thousandth of the distance from eye to target");
        }
    }

    void check() const {
        const Job::Camera& camera = result_.job.camera;
        const bool same = is_found("camera.target") && !are_apart(camera.eye, camera.target);
        if (same && is_found("camera.eye"))
            throw InputError(
                fmt::format("the camera's distance from the mesh is too small beside its distance from the origin: "
                            "derived from a base mesh of {:.6g} model units{}",
                            base_.largest(), place_and_remedy()));
        if (same)
            throw InputError(fmt::format(
                "`camera.eye` = {} is the centre of the displaced model, as is camera.target: set camera.eye = \"auto\"",
                toml_value(find_key("camera.eye")->get(result_.job))));
        for (const FoundValue& value : result_.found) {
            const Key& key = *find_key(value.key);
            if (const std::string fault = complaint(key, key.get(result_.job)); !fault.empty())
                throw InputError(fmt::format("{}: derived from a base mesh of {:.6g} model units{}", fault,
                                             base_.largest(), place_and_remedy()));
        }
    }

    bool is_found(const std::string& key) const {
        return std::any_of(result_.found.begin(), result_.found.end(),
                           [&](const FoundValue& value) { return value.key == key; });
    }

    /// What takes a value out of its range: the mesh's place, the displacement, or the mesh's size.
    std::string place_and_remedy() const {
        const glm::dvec3 centre = base_.centre(), away = glm::abs(centre);
        if (std::max({away.x, away.y, away.z}) > base_.largest())
            return fmt::format(
                " around ({0:.6g}, {1:.6g}, {2:.6g}); subtract ({0:.6g}, {1:.6g}, {2:.6g}) from each "
                "vertex of the mesh",
                centre.x, centre.y, centre.z);
        double reach = 0;
        for (const double height : extreme_heights())
            reach = std::max(reach, std::abs(height));
        if (constexpr double usual = 1e6; reach > usual * base_.largest())
            return fmt::format(
                "; the displacement reaches {:.3g}: check the map's values, or divide "
                "displacement.scale and displacement.bias by {:g}",
                reach, std::pow(10.0, std::ceil(std::log10(reach / base_.largest()))));
        return fmt::format("; multiply each coordinate of the mesh's vertices by {:g}",
                           std::pow(10.0, -std::round(std::log10(base_.largest()))));
    }

    const BaseMesh& mesh_;
    const HeightMap& map_;
    Box base_;
    int flat_;
    ResolvedJob result_;
};

}  // namespace

ResolvedJob resolve_job(const Job& job, const BaseMesh& mesh, const HeightMap& map) {
    return Resolver(job, mesh, map).result();
}

void require_resolved(const Job& job, const char* user) {
    if (const std::string key = automatic_key(job); !key.empty())
        throw std::logic_error(fmt::format("{}: {} is \"auto\"; call resolve_job() on the job first", user, key));
}

}  // namespace tessera
