#include "testbench/render/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "testbench/common/parallel.h"
#include "testbench/render/illumination.h"
#include "testbench/render/palette.h"
#include "testbench/render/ray_scene.h"
#include "testbench/render/wireframe.h"

namespace tessera {
namespace {

constexpr int tile_side = 8;
constexpr double line_shade = 0.16;  // of the surface's colour
constexpr double far_in_sizes = 50;  // an eye farther from the mesh than this many mesh sizes is treated as far away

/// No two samples share a row or a column of 8, so that axis-aligned edges are smooth too.
glm::dvec2 sample_position(std::size_t sample) {
    constexpr std::array<double, samples_per_pixel> row{4, 1, 6, 3, 0, 7, 2, 5};
    return {(static_cast<double>(sample) + 0.5) / samples_per_pixel, (row[sample] + 0.5) / samples_per_pixel};
}

/// Calls at(x, y): for the first pixel of each square of 2 x 2, a quarter of all, then for the second ones, and so on.
template <class At>
void for_each_pixel(int left, int top, int right, int bottom, const At& at) {
    for (int k = 0; k < 4; ++k)
        for (int y = top + k / 2; y < bottom; y += 2)
            for (int x = left + k % 2; x < right; x += 2)
                at(x, y);
}

/// A style with its colours in linear light.
class Paint {
  public:
    Paint(const Style& style, const RenderMesh& mesh)
        : style_(style), mesh_(mesh), background_(to_linear(style.background)), surface_(to_linear(style.surface)) {
        for (unsigned g = 0; g < generations_.size(); ++g)
            generations_[g] = to_linear(generation_colour(g));
        for (unsigned t = 0; t < tests_.size(); ++t)
            tests_[t] = to_linear(deciding_test_colour(static_cast<DecidingTest>(t)));
        for (unsigned s = 0; s < stops; ++s)
            stops_[s] = to_linear(stop_colour(static_cast<Stop>(s)));
        if (style.colour_by == ColourBy::error)
            for (std::size_t e = 0; e < error_steps; ++e)
                errors_[e] = to_linear(error_colour(static_cast<double>(e) / (error_steps - 1)));
    }

    bool has_lines() const { return style_.wireframe; }
    const glm::dvec3& background() const { return background_; }

    glm::dvec3 colour(const ShadingPoint& point, const Light& light, const Wireframe* lines,
                      const glm::dvec2& at) const {
        const glm::dvec3 paint = paint_at(point);
        glm::dvec3 lit = paint * light.diffuse + light.highlight;
        if (style_.relief < 1)
            lit = glm::mix(paint, lit, style_.relief);
        if (!lines)
            return lit;
        return glm::mix(lit, paint * line_shade * (0.4 + 0.6 * light.diffuse), lines->coverage(at.x, at.y));
    }

  private:
    static constexpr std::size_t error_steps = 1024;

    glm::dvec3 paint_at(const ShadingPoint& point) const {
        const RenderMesh::Triangle& triangle = mesh_.triangles[point.triangle];
        switch (style_.colour_by) {
            case ColourBy::generation:
                return generations_[std::min<std::size_t>(triangle.generation, generations_.size() - 1)];
            case ColourBy::deciding_test: return tests_[static_cast<std::size_t>(triangle.deciding_test)];
            case ColourBy::stopped_by: return stops_[static_cast<std::size_t>(stop_of(triangle.stopped_by))];
            case ColourBy::error: return error_paint(point);
            case ColourBy::none: break;
        }
        return surface_;
    }

    const glm::dvec3& error_paint(const ShadingPoint& point) const {
        const double error =
            mesh_.triangle_errors.empty() ? 0 : static_cast<double>(mesh_.triangle_errors[point.triangle]);
        const double fraction = style_.errors.largest > 0 ? error / style_.errors.largest : 0;
        return errors_[static_cast<std::size_t>(std::lround(std::clamp(fraction, 0.0, 1.0) * (error_steps - 1)))];
    }

    const Style& style_;
    const RenderMesh& mesh_;
    glm::dvec3 background_, surface_;
    std::array<glm::dvec3, 16> generations_;
    std::array<glm::dvec3, deciding_tests> tests_;
    std::array<glm::dvec3, stops> stops_;
    std::vector<glm::dvec3> errors_ = std::vector<glm::dvec3>(error_steps, glm::dvec3(0));
};

class Renderer {
  public:
    Renderer(const RenderMesh& mesh, const View& view, const std::vector<Style>& styles)
        : mesh_(mesh), view_(view), scene_(mesh), illumination_(view, styles.front(), scene_) {
        for (const Style& style : styles) {
            paints_.emplace_back(style, mesh);
            pictures_.push_back({Image(view.width, view.height, style.background)});
            if (style.wireframe)
                line_width_ = style.line_width;
        }
        glm::dvec3 low(0), high(0);
        for (const glm::vec3& p : mesh.positions) {
            low = glm::min(low, glm::dvec3(p));
            high = glm::max(high, glm::dvec3(p));
        }
        const double size = glm::length(high - low);
        clearance_ = 3e-6 * size;
        const double distance = -glm::dot((low + high) / 2.0 + mesh.origin - view.eye, view.backward);
        if (distance > far_in_sizes * size)
            start_ = distance - size;
    }

    std::vector<Picture> run() {
        const int rows = (view_.height + tile_side - 1) / tile_side;
        std::vector<std::uint8_t> in_sight(static_cast<std::size_t>(rows), 0);
        for_each_chunk(in_sight.size(), [&] {
            return [&, tile = Tile()](std::size_t row) mutable {
                const int y = static_cast<int>(row) * tile_side;
                for (int x = 0; x < view_.width; x += tile_side)
                    if (render_tile(tile, x, y, std::min(x + tile_side, view_.width),
                                    std::min(y + tile_side, view_.height)))
                        in_sight[row] = 1;
            };
        });
        const bool any = std::find(in_sight.begin(), in_sight.end(), 1) != in_sight.end();
        for (Picture& picture : pictures_)
            picture.mesh_in_sight = any;
        return std::move(pictures_);
    }

  private:
    /// Data of a triangle needed by all rays that hit it.
    struct Met {
        std::uint32_t triangle = RayScene::nothing;
        std::array<glm::dvec3, 3> positions, normals;
        glm::dvec3 across{0}, flat{0};  // its own normal, and the same at unit length
        Wireframe lines;
    };

    /// Reusable memory for a tile, one per thread.
    struct Tile {
        std::vector<Ray> rays;
        std::vector<glm::dvec2> at;
        std::vector<std::uint32_t> hits;
        std::vector<ShadingPoint> points;
        std::vector<Light> lights;
        std::vector<glm::dvec3> sums;  // linear light, one plane per style
        Illumination::Scratch scratch;
        std::array<Met, 256> met;  // a cache, by number modulo its size: neighbouring pixels hit the same triangles
    };

    /// Returns false if no part of the mesh is visible in the tile.
    bool render_tile(Tile& tile, int left, int top, int right, int bottom) {
        const std::size_t pixels = static_cast<std::size_t>((right - left) * (bottom - top));
        tile.sums.assign(pixels * paints_.size(), glm::dvec3(0));
        bool anything = false;
        for (std::size_t sample = 0; sample < samples_per_pixel; ++sample)
            anything = add_sample(tile, sample, left, top, right, bottom) || anything;
        if (!anything)
            return false;
        for (std::size_t s = 0; s < paints_.size(); ++s) {
            const glm::dvec3* sum = &tile.sums[s * pixels];
            for_each_pixel(left, top, right, bottom, [&](int x, int y) {
                pictures_[s].image.set(x, y, to_srgb(*sum++ / static_cast<double>(samples_per_pixel)));
            });
        }
        return true;
    }

    /// Adds one sample of every pixel in the tile to the sums; returns false if none hit the mesh.
    bool add_sample(Tile& tile, std::size_t sample, int left, int top, int right, int bottom) const {
        auto& [rays, at, hits, points, lights, sums, scratch, met] = tile;
        const glm::dvec2 offset = sample_position(sample);
        rays.clear();
        at.clear();
        for_each_pixel(left, top, right, bottom, [&](int x, int y) {
            tile.at.push_back({x + offset.x, y + offset.y});
            const glm::dvec3 direction = view_.ray(tile.at.back().x, tile.at.back().y);
            tile.rays.push_back(
                {view_.eye - mesh_.origin + start_ * direction, direction, std::max(0.0, view_.near_plane - start_)});
        });
        scene_.first_hits(rays, hits);
        points.clear();
        for (std::size_t i = 0; i < rays.size(); ++i)
            if (hits[i] != RayScene::nothing)
                points.push_back(shading_point(rays[i], meet(tile, hits[i])));
        illumination_.light(sample, {points, points.size() == rays.size()}, lights, scratch);

        std::size_t point = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (hits[i] == RayScene::nothing) {
                for (std::size_t s = 0; s < paints_.size(); ++s)
                    sums[s * rays.size() + i] += paints_[s].background();
                continue;
            }
            for (std::size_t s = 0; s < paints_.size(); ++s)
                sums[s * rays.size() + i] += paints_[s].colour(
                    points[point], lights[point], paints_[s].has_lines() ? &meet(tile, hits[i]).lines : nullptr, at[i]);
            ++point;
        }
        return !points.empty();
    }

    const Met& meet(Tile& tile, std::uint32_t index) const {
        Met& place = tile.met[index % tile.met.size()];
        if (place.triangle == index)
            return place;
        place.triangle = index;
        std::array<glm::dvec3, 3> projected;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh_.triangles[index].vertices[k];
            place.positions[k] = mesh_.positions[vertex];
            place.normals[k] = mesh_.normals[vertex];
            projected[k] = view_.project(mesh_.origin + place.positions[k]);
        }
        const auto& p = place.positions;
        place.across = glm::cross(p[1] - p[0], p[2] - p[0]);
        place.flat = glm::normalize(place.across);
        if (line_width_ > 0)
            place.lines = {projected, line_width_};
        return place;
    }

    ShadingPoint shading_point(const Ray& ray, const Met& met) const {
        const auto& p = met.positions;
        const auto& n = met.normals;
        const double facing = -glm::dot(met.across, ray.direction);
        const glm::dvec3 flat = facing < 0 ? -met.flat : met.flat;

        // Möller and Trumbore's barycentric coordinates, clamped to the triangle: Embree's rounding may place a hit
        // slightly outside.
        const glm::dvec3 from = ray.origin - p[0];
        const glm::dvec3 turned = glm::cross(from, ray.direction);
        const double scale = facing == 0 ? 0 : 1 / facing;  // exactly edge-on: any corner will do
        double b1 = std::clamp(glm::dot(p[2] - p[0], turned) * scale, 0.0, 1.0);
        double b2 = std::clamp(-glm::dot(p[1] - p[0], turned) * scale, 0.0, 1.0);
        if (b1 + b2 > 1) {
            const double sum = b1 + b2;
            b1 /= sum;
            b2 /= sum;
        }
        const std::array<double, 3> b{1 - b1 - b2, b1, b2};

        glm::dvec3 position(0), normal(0);
        for (std::size_t k = 0; k < 3; ++k) {
            position += b[k] * p[k];
            normal += b[k] * n[k];
        }
        const double side = glm::dot(normal, flat) < 0 ? -1 : 1;
        const double length = glm::length(normal);

        // Hanika, Hacking the Shadow Terminator (Ray Tracing Gems II, 4).
        glm::dvec3 lifted = position;
        for (std::size_t k = 0; k < 3; ++k)
            lifted -= b[k] * std::min(0.0, glm::dot(position - p[k], side * n[k])) * side * n[k];
        return {met.triangle, glm::vec3(lifted + clearance_ * flat), length > 0.01 ? normal * (side / length) : flat};
    }

    const RenderMesh& mesh_;
    const View& view_;
    RayScene scene_;
    Illumination illumination_;
    std::vector<Paint> paints_;
    std::vector<Picture> pictures_;
    double line_width_ = 0;  // of all wireframes; 0: there are none
    double start_ = 0;       // of the rays, along the view direction: single precision fails for a distant eye
    double clearance_ = 0;   // height above the surface of the rays to the lights, against single-precision rounding
};

}  // namespace

std::vector<Picture> render_pictures(const RenderMesh& mesh, const View& view, const std::vector<Style>& styles) {
    if (styles.empty())
        return {};
    return Renderer(mesh, view, styles).run();
}

}  // namespace tessera
