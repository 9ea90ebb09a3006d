#include "testbench/input/mesh/obj_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "testbench/common/error.h"
#include "testbench/input/mesh/border_points.h"
#include "testbench/input/mesh/mesh_limits.h"
#include "testbench/input/mesh/mesh_text.h"
#include "testbench/input/mesh/obj_text.h"
#include "testbench/input/mesh/polygon_cutter.h"
#include "testbench/input/mesh/surface_flaws.h"
#include "testbench/setup/mesh/equal_groups.h"
#include "testbench/setup/mesh/smooth_normals.h"
#include "testbench/setup/mesh/tangent_frames.h"
#include "testbench/setup/mesh/texture_gradient.h"
#include "testbench/setup/mesh/texture_scale.h"
#include "testbench/setup/mesh/triangle_geometry.h"

namespace tessera {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Number of occurrences, and the line of the first.
struct Tally {
    std::size_t count = 0, first_line = 0;
    void add(std::size_t line, std::size_t times = 1) {
        if (count == 0)
            first_line = line;
        count += times;
    }
};

class Assembler {
  public:
    Assembler(ObjText text, const std::string& name) : text_(std::move(text)), name_(name) {
        mesh_.repairs = std::move(text_.repairs);
        same_position_ = first_equal(text_.positions, position_key);
    }

    BaseMesh assemble() {
        cut_faces();
        drop_duplicates();
        if (triangles_.empty()) {
            throw InputError(
                fmt::format("{}: no triangle is left: all {} face(s) have zero area, the first is in line "
                            "{}; export the mesh again",
                            name_, text_.faces.size(), text_.faces.front().line));
        }
        make_vertices();
        triangles_ = {};
        text_.corners = {};
        Surface surface = surface_of(mesh_);
        join_border_points(mesh_, surface);
        mesh_.winding_changes = surface.opposed;
        complete_smooth_normals(mesh_);
        constexpr const char* smooth_normals =
            "Export the mesh with smooth normals, or its faces without normals, as in `f 1/1 2/2 3/3`: smooth ones are "
            "then calculated.";
        for (std::string& flaw : surface_flaws(mesh_, surface, smooth_normals))
            mesh_.repairs.push_back(std::move(flaw));
        count_leaning_normals(mesh_, surface);
        complete_tangent_frames(mesh_);
        measure_texture_scale(mesh_);
        return std::move(mesh_);
    }

  private:
    std::uint32_t position_of(std::uint32_t corner) const { return same_position_[text_.corners[corner].position]; }
    const glm::dvec3& point(std::uint32_t corner) const { return text_.positions[text_.corners[corner].position]; }

    void cut_faces() {
        std::uint64_t work_left = largest_cutting_work;
        Tally crossing, nonplanar, repeated, degenerate;
        std::vector<std::uint32_t> corners;
        std::vector<glm::dvec3> points;
        for (const ObjText::Face& face : text_.faces) {
            corners.clear();
            for (std::uint32_t i = 0; i < face.count; ++i) {
                const auto corner = static_cast<std::uint32_t>(face.first + i);
                if (corners.empty() || position_of(corner) != position_of(corners.back()))
                    corners.push_back(corner);
            }
            while (corners.size() > 1 && position_of(corners.front()) == position_of(corners.back()))
                corners.pop_back();
            if (corners.size() < 3) {
                degenerate.add(face.line, face.count - 2);
                continue;
            }
            if (corners.size() < face.count)
                repeated.add(face.line);
            points.clear();
            for (std::uint32_t corner : corners)
                points.push_back(point(corner));
            const std::optional<PolygonCut> cut = cut_polygon(points, work_left);
            if (!cut) {
                throw ResourceError(
                    fmt::format("{}:{}: up to this face of {} corners, triangulating non-convex polygons "
                                "took {} steps, the limit: triangulate the mesh in the program that exported it",
                                name_, face.line, face.count, largest_cutting_work));
            }
            if (cut->crosses_itself)
                crossing.add(face.line);
            if (cut->nonplanar)
                nonplanar.add(face.line);
            for (const Triangle& t : cut->triangles) {
                const Triangle triangle{corners[t[0]], corners[t[1]], corners[t[2]]};
                if (triangle_normal(point(triangle[0]), point(triangle[1]), point(triangle[2])) == glm::dvec3(0)) {
                    degenerate.add(face.line);
                } else {
                    triangles_.push_back(triangle);
                    lines_.push_back(face.line);
                }
            }
        }
        mesh_.dropped_degenerate = degenerate.count;
        repair(degenerate, "{} triangle(s) of zero area or with one vertex twice were dropped, the first in line {}.");
        repair(repeated, "{} face(s) name one point twice in a row, the first in line {}: used once.");
        repair(crossing,
               "The outline of {} face(s) crosses itself, the first in line {}: cut into triangles that "
               "overlap.");
        repair(nonplanar, "{} face(s) are not planar, the first in line {}: cut into triangles, with an edge across.");
    }

    /// Drops and counts triangles at the same three positions as an earlier one.
    void drop_duplicates() {
        Tally same, turned;
        // same winding: rotated so that the lowest position comes first
        drop_repeated(
            [this](const Triangle& t) {
                std::array<std::uint64_t, 3> key{position_of(t[0]), position_of(t[1]), position_of(t[2])};
                std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
                return key;
            },
            [](const Triangle&, const Triangle&) { return true; }, same);
        drop_repeated(
            [this](const Triangle& t) {
                std::array<std::uint64_t, 3> key{position_of(t[0]), position_of(t[1]), position_of(t[2])};
                std::sort(key.begin(), key.end());
                return key;
            },
            [this](const Triangle& a, const Triangle& b) { return !own_normals(a, b); }, turned);
        mesh_.dropped_duplicate = same.count + turned.count;
        repair(same, "{} triangle(s) repeat an earlier one and were dropped, the first in line {}.");
        repair(turned,
               "{} triangle(s) repeat an earlier one with opposite winding and were dropped, the first in line {}.");
    }

    template <typename Key, typename Drop>
    void drop_repeated(Key key, Drop drop, Tally& dropped) {
        const std::vector<std::uint32_t> first = first_equal(triangles_, key);
        std::size_t kept = 0;
        std::vector<Triangle> triangles(triangles_.size());
        std::vector<std::size_t> lines(triangles_.size());
        for (std::size_t i = 0; i < triangles_.size(); ++i) {
            if (first[i] != i && drop(triangles_[first[i]], triangles_[i])) {
                dropped.add(lines_[i]);
                continue;
            }
            triangles[kept] = triangles_[i];
            lines[kept] = lines_[i];
            ++kept;
        }
        triangles.resize(kept);
        lines.resize(kept);
        triangles_ = std::move(triangles);
        lines_ = std::move(lines);
    }

    /// Whether two triangles on the same positions have given normals that differ at every position.
    bool own_normals(const Triangle& a, const Triangle& b) const {
        for (std::uint32_t i : a) {
            for (std::uint32_t j : b) {
                const std::uint32_t m = text_.corners[i].normal, n = text_.corners[j].normal;
                if (m == ObjText::none || n == ObjText::none ||
                    (position_of(i) == position_of(j) &&
                     unit_or_zero(text_.normals[m]) == unit_or_zero(text_.normals[n])))
                    return false;
            }
        }
        return true;
    }

    void make_vertices() {
        std::vector<std::array<std::uint64_t, 3>> keys;
        keys.reserve(triangles_.size() * 3);
        for (const Triangle& t : triangles_) {
            for (std::uint32_t corner : t) {
                const ObjText::Corner& c = text_.corners[corner];
                keys.push_back({c.position, c.texture, c.normal});
            }
        }
        const std::vector<std::uint32_t> first = first_equal(keys);
        Tally zero_normals, odd_normals, bare;
        std::vector<std::uint32_t> vertex_of(keys.size());
        mesh_.triangles.resize(triangles_.size());
        std::vector<std::uint32_t> without_texture;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            if (first[i] == i) {
                const ObjText::Corner& corner = text_.corners[triangles_[i / 3][i % 3]];
                const auto index = static_cast<std::uint32_t>(mesh_.vertices.size());
                vertex_of[i] = index;
                BaseVertex vertex;
                vertex.position = text_.positions[corner.position];
                if (corner.normal != ObjText::none) {
                    const glm::dvec3& given = text_.normals[corner.normal];
                    vertex.normal = unit_or_zero(given);
                    if (vertex.normal == glm::dvec3(0))
                        zero_normals.add(lines_[i / 3]);
                    else if (std::abs(safe_length(given) - 1) > 0.01)
                        odd_normals.add(lines_[i / 3]);
                }
                if (corner.texture != ObjText::none) {
                    vertex.texture = text_.textures[corner.texture];
                } else {
                    bare.add(lines_[i / 3]);
                    without_texture.push_back(index);
                }
                mesh_.vertices.push_back(vertex);
            }
            mesh_.triangles[i / 3][i % 3] = vertex_of[first[i]];
        }
        repair(zero_normals,
               "{} vertex normal(s) have zero length, first used in line {}: replaced by smooth normals.");
        repair(odd_normals, "{} vertex normal(s) are not of unit length, first used in line {}: normalised.");
        std::string why =
            fmt::format("{} vertices have no texture coordinates, first used in line {}", bare.count, bare.first_line);
        const auto has_area = [this](const Triangle& t) { return texture_gradient(mesh_, t).has_value(); };
        if (without_texture.empty() && std::none_of(mesh_.triangles.begin(), mesh_.triangles.end(), has_area)) {
            without_texture.resize(mesh_.vertices.size());
            std::iota(without_texture.begin(), without_texture.end(), 0u);
            why = "No triangle has an area in texture space";
        }
        project_texture(without_texture, why);
    }

    void project_texture(const std::vector<std::uint32_t>& vertices, const std::string& why) {
        const auto [low, high] = bounds_of(mesh_.vertices);
        const glm::dvec3 size = high - low;
        require_size(size, name_);
        if (vertices.empty())
            return;
        constexpr std::array<std::array<int, 2>, 3> seen_along{{{1, 2}, {0, 2}, {0, 1}}};
        int thinnest = 2;
        for (int axis : {1, 0})
            if (size[axis] < size[thinnest])
                thinnest = axis;
        const auto [across, up] = seen_along[static_cast<std::size_t>(thinnest)];
        for (std::uint32_t i : vertices) {
            BaseVertex& vertex = mesh_.vertices[i];
            vertex.texture = {(vertex.position[across] - low[across]) / size[across],
                              (vertex.position[up] - low[up]) / size[up]};
        }
        mesh_.repairs.push_back(
            fmt::format("{}: the map was projected onto the mesh's bounding box along {}.", why, "xyz"[thinnest]));
    }

    void repair(const Tally& tally, const char* sentence) {
        if (tally.count > 0)
            mesh_.repairs.push_back(fmt::format(fmt::runtime(sentence), tally.count, tally.first_line));
    }

    ObjText text_;
    const std::string& name_;
    std::vector<std::uint32_t> same_position_;  // per `v` line: the first with that position
    std::vector<Triangle> triangles_;           // indices of corners
    std::vector<std::size_t> lines_;            // per triangle
    BaseMesh mesh_;
};

}  // namespace

BaseMesh parse_obj(std::string_view text, const std::string& name) {
    return Assembler(read_obj_text(text, name), name).assemble();
}

BaseMesh read_obj(const std::string& path) {
    return parse_obj(read_mesh_text(path, "an OBJ file"), path);
}

}  // namespace tessera
