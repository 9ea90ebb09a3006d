#include "testbench/setup/mesh/tangent_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "testbench/setup/mesh/equal_groups.h"
#include "testbench/setup/mesh/texture_gradient.h"

namespace tessera {
namespace {

/// A sum below this fraction of its terms is the rounding error of a cancellation.
constexpr double cancelled = 1e-6;
/// Mirrored triangles with no more than this part of the area around a point are slips of its unwrapping.
constexpr double slip = 0.06;
/// Texture coordinates are compared in these parts of the map: 1/16 texel of the largest.
constexpr int texture_bits = 16;
/// Parts around a point of a curved surface may differ by this much, in degrees, without a fault.
constexpr double natural_turn = 15;
/// Normals are against their triangle's winding only beyond rounding.
constexpr double against_winding = -1e-6;

/// Disjoint sets of the triangles' corners; corner k of triangle t is number 3 t + k.
class Corners {
  public:
    explicit Corners(std::uint32_t count) {
        parent_.reserve(count);
        for (std::uint32_t corner = 0; corner < count; ++corner)
            parent_.push_back(corner);
    }

    std::uint32_t of(std::uint32_t corner) {
        while (parent_[corner] != corner)
            corner = parent_[corner] = parent_[parent_[corner]];
        return corner;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = of(a);
        b = of(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> parent_;
};

/// For each corner the number of its frame, numbered by their first corners. `apart`: triangles that are joined to none;
/// empty: there are none.
std::vector<std::uint32_t> frames_of_corners(const BaseMesh& mesh, const std::vector<bool>& apart = {}) {
    const std::vector<std::uint32_t> place = first_equal(mesh.vertices, [](const BaseVertex& vertex) {
        const PositionKey p = position_key(vertex.position), n = position_key(vertex.normal);
        return std::array{p[0], p[1], p[2], n[0], n[1], n[2]};
    });
    const auto count = static_cast<std::uint32_t>(3 * mesh.triangles.size());
    const auto vertex = [&](std::size_t corner) { return mesh.triangles[corner / 3][corner % 3]; };
    // The corners at the ends of the edge that starts at corner `side`; first the one with the lower place.
    const auto ends = [&](std::size_t side) {
        std::array<std::uint32_t, 2> corners{static_cast<std::uint32_t>(side),
                                             static_cast<std::uint32_t>(side / 3 * 3 + (side + 1) % 3)};
        if (place[vertex(corners[0])] > place[vertex(corners[1])])
            std::swap(corners[0], corners[1]);
        return corners;
    };
    const auto steps = [](double t) { return std::nearbyint(std::ldexp(t, texture_bits)); };
    const auto within_period = [](double s) {
        return s - std::ldexp(std::floor(std::ldexp(s, -texture_bits)), texture_bits);
    };
    const std::vector<std::uint32_t> first = first_equal_of(count, [&](std::size_t side) {
        const auto [from, to] = ends(side);
        const glm::dvec2 &a = mesh.vertices[vertex(from)].texture, &b = mesh.vertices[vertex(to)].texture;
        const glm::dvec2 start(steps(a.x), steps(a.y)), end(steps(b.x), steps(b.y));
        return std::array<std::uint64_t, 7>{apart.empty() || !apart[side / 3] ? 0 : side + 1,
                                            place[vertex(from)],
                                            place[vertex(to)],
                                            alike_bits(within_period(start.x)),
                                            alike_bits(within_period(start.y)),
                                            alike_bits(end.x - start.x),
                                            alike_bits(end.y - start.y)};
    });
    Corners corners(count);
    for (std::uint32_t side = 0; side < count; ++side)
        for (std::size_t end : {0u, 1u})
            corners.join(ends(side)[end], ends(first[side])[end]);

    std::vector<std::uint32_t> frame;
    frame.reserve(count);
    std::uint32_t frames = 0;
    for (std::uint32_t corner = 0; corner < count; ++corner)
        frame.push_back(corners.of(corner) == corner ? frames++ : frame[corners.of(corner)]);
    return frame;
}

/// The triangles of one winding in texture space that share a frame.
struct Sum {
    glm::dvec3 direction{0};
    double area = 0;
};

struct Frame {
    Sum straight, mirrored;
    bool torn = false;  // used by both
    glm::dvec3 tangent{0};
    double turned = 0;  // largest angle in degrees from the tangent to that of a part

    double area() const { return straight.area + mirrored.area; }
    bool is_mirrored() const { return mirrored.area > straight.area; }
};

void add_triangles(const BaseMesh& mesh, const std::vector<std::uint32_t>& frame_of, std::vector<Frame>& frames,
                   std::vector<bool>& flat) {
    const auto position = [&](std::uint32_t vertex) -> const glm::dvec3& { return mesh.vertices[vertex].position; };
    double largest_area = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        largest_area = std::max(largest_area, triangle_area(position(a), position(b), position(c)));
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& triangle = mesh.triangles[t];
        const auto gradient = texture_gradient(mesh, triangle);
        if (!gradient) {
            flat[t] = true;
            continue;
        }
        const double weight = largest_area > 0 ? gradient->area / largest_area : 1;
        const glm::dvec3 direction = unit_or_zero(gradient->dp_du);
        const glm::dvec3 facing = triangle_normal(position(triangle[0]), position(triangle[1]), position(triangle[2]));
        double along = 0;
        for (const std::uint32_t corner : triangle)
            along += glm::dot(facing, mesh.vertices[corner].normal);
        const bool inside_out = along < against_winding;
        for (std::size_t k = 0; k < 3; ++k) {
            Frame& frame = frames[frame_of[3 * t + k]];
            Sum& sum = gradient->mirrored != inside_out ? frame.mirrored : frame.straight;
            sum.direction += weight * direction;
            sum.area += weight;
        }
    }
}

/// The sum orthogonalised against the normal; zero if it cancels.
glm::dvec3 tangent_from(const Sum& sum, const glm::dvec3& normal) {
    const glm::dvec3 in_plane = sum.direction - normal * glm::dot(normal, sum.direction);
    if (!(safe_length(in_plane) > cancelled * sum.area))
        return glm::dvec3(0);
    const glm::dvec3 rough = unit_or_zero(in_plane);
    return unit_or_zero(rough - normal * glm::dot(normal, rough));
}

/// Parts of the texture that only the triangles without area in it connect may lie in different directions: sets
/// Frame::turned.
void measure_turns(const BaseMesh& mesh, std::vector<bool>& flat, const std::vector<std::uint32_t>& frame_of,
                   std::vector<Frame>& frames) {
    const std::vector<std::uint32_t> part_of = frames_of_corners(mesh, flat);
    std::vector<Frame> parts(1 + *std::max_element(part_of.begin(), part_of.end()));
    add_triangles(mesh, part_of, parts, flat);
    for (std::size_t corner = 0; corner < frame_of.size(); ++corner) {
        Frame& frame = frames[frame_of[corner]];
        const Frame& part = parts[part_of[corner]];
        const glm::dvec3 own = tangent_from(frame.is_mirrored() ? part.mirrored : part.straight,
                                            mesh.vertices[mesh.triangles[corner / 3][corner % 3]].normal);
        if (frame.tangent == glm::dvec3(0) || own == glm::dvec3(0))
            continue;
        const double cosine = std::clamp(glm::dot(own, frame.tangent), -1.0, 1.0);
        frame.turned = std::max(frame.turned, glm::degrees(std::acos(cosine)));
    }
}

/// Gives each vertex the frame of its corners, and a vertex of several frames copies.
void hand_out(BaseMesh& mesh, const std::vector<std::uint32_t>& frame_of, const std::vector<Frame>& frames) {
    constexpr std::uint32_t none = UINT32_MAX;
    std::vector<std::uint32_t> owner(mesh.vertices.size(), none);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> copies;
    for (std::size_t corner = 0; corner < frame_of.size(); ++corner) {
        std::uint32_t& index = mesh.triangles[corner / 3][corner % 3];
        const std::uint32_t number = frame_of[corner];
        if (owner[index] == none) {
            owner[index] = number;
        } else if (owner[index] != number) {
            const auto [at, made] =
                copies.try_emplace({index, number}, static_cast<std::uint32_t>(mesh.vertices.size()));
            if (made) {
                const BaseVertex copy = mesh.vertices[index];
                mesh.vertices.push_back(copy);
            }
            index = at->second;
        }
        mesh.vertices[index].tangent = frames[number].tangent;
        mesh.vertices[index].handedness = frames[number].is_mirrored() && !frames[number].torn ? -1 : 1;
    }
}

}  // namespace

void complete_tangent_frames(BaseMesh& mesh) {
    const std::vector<std::uint32_t> frame_of = frames_of_corners(mesh);
    std::vector<Frame> frames(frame_of.empty() ? 0 : 1 + *std::max_element(frame_of.begin(), frame_of.end()));
    std::vector<bool> flat(mesh.triangles.size());
    std::size_t without = 0, cancelling = 0, torn = 0, slips = 0;
    add_triangles(mesh, frame_of, frames, flat);
    const auto flat_texture = static_cast<std::size_t>(std::count(flat.begin(), flat.end(), true));
    for (std::size_t corner = 0, next = 0; corner < frame_of.size(); ++corner) {
        if (frame_of[corner] != next)
            continue;
        Frame& frame = frames[next++];
        const double lesser = std::min(frame.straight.area, frame.mirrored.area);
        frame.torn = lesser > slip * frame.area();
        slips += lesser > 0 && !frame.torn;
        torn += frame.torn;
        if (frame.torn)
            continue;
        frame.tangent = tangent_from(frame.is_mirrored() ? frame.mirrored : frame.straight,
                                     mesh.vertices[mesh.triangles[corner / 3][corner % 3]].normal);
        if (frame.tangent == glm::dvec3(0))
            ++(frame.area() > 0 ? cancelling : without);
    }
    std::size_t blank = 0;
    for (std::size_t corner = 0; corner < frame_of.size(); corner += 3)
        blank += std::all_of(&frame_of[corner], &frame_of[corner] + 3, [&](std::uint32_t f) { return frames[f].torn; });
    if (flat_texture > 0)
        measure_turns(mesh, flat, frame_of, frames);
    hand_out(mesh, frame_of, frames);

    std::size_t turned = 0;
    double most_turned = 0;
    for (const Frame& frame : frames) {
        turned += frame.turned > natural_turn;
        most_turned = std::max(most_turned, frame.turned);
    }
    const auto say = [&](std::size_t count, const char* sentence) {
        if (count > 0)
            mesh.repairs.push_back(fmt::format(fmt::runtime(sentence), count));
    };
    say(flat_texture,
        "{} triangle(s) have no area in texture space and do not define a tangent: unwrap them with an area in the map.");
    if (turned > 0)
        mesh.repairs.push_back(fmt::format(
            "At {} point(s) triangles without area in texture space connect parts of the texture that lie in different "
            "directions. The parts share the mean tangent, up to {:.0f} degrees from their own, and their normals are "
            "wrong. Give these triangles an area in the map.",
            turned, most_turned));
    say(without,
        "{} point(s) have no triangle with area in texture space, so no tangent: their normals are those of the base "
        "mesh.");
    say(cancelling,
        "At {} point(s) the directions of dp/du cancel (for example at a pole): they have no tangent, and their "
        "normals are those of the base mesh.");
    if (torn > 0)
        mesh.repairs.push_back(fmt::format(
            "At {} point(s) the texture is mirrored in some triangles and not in others, with the same texture "
            "coordinates: they have no tangent, so that the surface stays closed, and their normals are those of the "
            "base mesh. To give them one, {}unwrap the mirrored part to a place of its own in the map, or, where it is "
            "folded over, without triangles turned over.",
            torn, mesh.winding_changes > 0 ? "first make the winding of all triangles the same, then " : ""));
    say(blank,
        "{} triangle(s) have only such points, and the map does not show in their normals: cut them so that no edge but "
        "the mirrored ones joins two such points.");
    say(slips,
        "At {} point(s) a few small triangles are mirrored in texture space against the others around them, whose "
        "tangent they get: the normals in these triangles are wrong. Unwrap the mesh without triangles turned over.");
}

}  // namespace tessera
