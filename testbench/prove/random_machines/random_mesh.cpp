#include "testbench/prove/random_machines/random_mesh.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <utility>
#include <vector>

namespace tessera {

namespace {

using glm::dvec2, glm::dvec3;

/// A point on the unit circle, `part` of the way round: rational, quarter by quarter.
dvec2 on_circle(double part) {
    const double quarters = (part - std::floor(part)) * 4;
    const double whole = std::floor(quarters), t = quarters - whole;
    const dvec2 p{(1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)};
    switch (static_cast<int>(whole)) {
        case 0: return p;
        case 1: return {-p.y, p.x};
        case 2: return {-p.x, -p.y};
        default: return {p.y, -p.x};
    }
}

dvec3 unit(const dvec3& v) {
    const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return length > 0 ? v / length : dvec3(0, 0, 1);
}

class MeshMaker {
  public:
    explicit MeshMaker(Random& random) : random_(random) {}

    std::string make();
    void dress(const RandomMap& map);
    std::string obj() const;

  private:
    struct Corner {
        std::size_t position, texture, normal;
    };
    using Face = std::array<Corner, 3>;

    std::size_t position(const dvec3& p) {
        positions_.push_back(p);
        return positions_.size() - 1;
    }
    std::size_t texture(const dvec2& t) {
        textures_.push_back(t);
        return textures_.size() - 1;
    }
    void face(const Corner& a, const Corner& b, const Corner& c) { faces_.push_back({a, b, c}); }
    dvec3 jitter(double size) {
        return {random_.real(-size, size), random_.real(-size, size), random_.real(-size, size)};
    }

    std::vector<double> steps(int count);
    template <class Shape>
    void grid(int columns, int rows, bool closed_u, bool closed_v, Shape&& shape);
    void solid();
    void fan();
    void slivers();
    void book();
    void soup();
    void mirrored_pair();

    void place();
    void set_normals();
    void set_textures(const RandomMap& map);

    Random& random_;
    std::vector<dvec3> positions_;
    std::vector<dvec2> textures_;
    std::vector<dvec3> normals_;
    std::vector<Face> faces_;
};

/// 0..1 in `count` steps, equal or with widths up to 64 to 1.
std::vector<double> MeshMaker::steps(int count) {
    const bool mixed = random_.chance(40);
    std::vector<double> at{0};
    for (int k = 0; k < count; ++k)
        at.push_back(at.back() + (mixed ? std::ldexp(1.0, -random_.integer32(0, 6)) : 1));
    for (double& value : at)
        value /= at.back();
    at.back() = 1;
    return at;
}

/// shape(u, v) over 0..1; a closed direction shares its first and last positions, but not their texture coordinates.
template <class Shape>
void MeshMaker::grid(int columns, int rows, bool closed_u, bool closed_v, Shape&& shape) {
    const std::vector<double> u = steps(columns), v = steps(rows);
    const double size = random_.chance(50) ? random_.real(0, 0.3) / std::max(columns, rows) : 0;
    std::vector<std::vector<Corner>> corners;
    for (std::size_t y = 0; y < v.size(); ++y) {
        corners.emplace_back();
        for (std::size_t x = 0; x < u.size(); ++x) {
            const bool last_u = closed_u && x + 1 == u.size(), last_v = closed_v && y + 1 == v.size();
            const std::size_t p = last_u
                                      ? corners[y][0].position
                                      : (last_v ? corners[0][x].position : position(shape(u[x], v[y]) + jitter(size)));
            corners[y].push_back({p, texture({u[x], v[y]}), 0});
        }
    }
    const bool same_cut = random_.coin();
    for (std::size_t y = 0; y + 1 < v.size(); ++y)
        for (std::size_t x = 0; x + 1 < u.size(); ++x) {
            const Corner &a = corners[y][x], &b = corners[y][x + 1], &c = corners[y + 1][x + 1], &d = corners[y + 1][x];
            if (same_cut || random_.coin()) {
                face(a, b, c);
                face(a, c, d);
            } else {
                face(b, c, d);
                face(b, d, a);
            }
        }
}

/// Tetrahedron, octahedron or cube, each face a triangle, subdivided up to twice, every vertex with one texture
/// coordinate (the map seen along z) or each face with a chart of its own.
void MeshMaker::solid() {
    std::vector<dvec3> points;
    std::vector<std::array<std::size_t, 3>> triangles;
    switch (random_.integer(0, 2)) {
        case 0:
            points = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
            triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
            break;
        case 1:
            points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
            triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
            break;
        default:
            for (int k = 0; k < 8; ++k)
                points.emplace_back((k & 1) * 2 - 1, (k >> 1 & 1) * 2 - 1, (k >> 2 & 1) * 2 - 1);
            triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                         {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    }
    const bool round = random_.coin();
    for (std::int64_t times = random_.integer(0, 2); times > 0; --times) {
        std::map<std::pair<std::size_t, std::size_t>, std::size_t> middles;
        const auto middle = [&](std::size_t a, std::size_t b) {
            const auto [at, fresh] = middles.insert({{std::min(a, b), std::max(a, b)}, points.size()});
            if (fresh) {
                const dvec3 p = (points[a] + points[b]) / 2.0;
                points.push_back(round ? unit(p) : p);
            }
            return at->second;
        };
        std::vector<std::array<std::size_t, 3>> finer;
        for (const auto& [a, b, c] : triangles) {
            const std::size_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        triangles = std::move(finer);
    }
    const double size = random_.chance(50) ? random_.real(0, 0.2) : 0;
    for (const dvec3& p : points)
        texture({p.x / 2 + 0.5, p.y / 2 + 0.5}), position(p + jitter(size));
    const bool charts = random_.coin();
    for (const auto& triangle : triangles) {
        Face made;
        for (std::size_t k = 0; k < 3; ++k)
            made[k] = {triangle[k], charts ? texture({random_.real(0, 1), random_.real(0, 1)}) : triangle[k], 0};
        faces_.push_back(made);
    }
}

void MeshMaker::fan() {
    const int count = random_.integer32(3, 60);
    const bool closed = random_.coin(), radial = random_.coin();
    const std::vector<double> around = steps(count);
    const std::size_t centre = position({0, 0, random_.real(-0.5, 0.5)});
    const std::size_t middle = texture({0.5, 0.5});
    std::vector<Corner> rim;
    for (std::size_t k = 0; k < around.size(); ++k) {
        const dvec2 at = on_circle(closed ? around[k] : around[k] * 0.7);
        const double radius = random_.chance(80) ? 1 : random_.real(0.1, 1);
        const bool last = closed && k + 1 == around.size();
        rim.push_back({last ? rim[0].position : position({at.x * radius, at.y * radius, 0}),
                       radial ? texture({around[k], 0}) : texture({at.x / 2 + 0.5, at.y / 2 + 0.5}), 0});
    }
    for (std::size_t k = 0; k + 1 < rim.size(); ++k)
        face({centre, radial ? texture({(around[k] + around[k + 1]) / 2, 1}) : middle, 0}, rim[k], rim[k + 1]);
}

/// A strip of long thin triangles in space and, at random, in the map as well.
void MeshMaker::slivers() {
    const int count = random_.integer32(1, 24);
    const double width = random_.one_of({1.0, 0.1, 0.01, 0.0001});
    const bool in_map = random_.coin();
    std::vector<Corner> low, high;
    for (int k = 0; k <= count; ++k) {
        const double at = width * k, in_texture = in_map ? at / (width * count) : at / (count + 1);
        low.push_back({position({0, at, 0}), texture({0, in_texture}), 0});
        high.push_back(
            {position({1, at + random_.real(0, width / 2), random_.real(0, 0.1)}), texture({1, in_texture}), 0});
    }
    for (std::size_t k = 0; k + 1 < low.size(); ++k) {
        face(low[k], high[k], low[k + 1]);
        face(low[k + 1], high[k], high[k + 1]);
    }
}

/// Pages that share one edge: not manifold there.
void MeshMaker::book() {
    const Corner bottom{position({0, 0, 0}), texture({0, 0}), 0}, top{position({0, 0, 1}), texture({0, 1}), 0};
    const int pages = random_.integer32(3, 7);
    const bool one_texture = random_.coin();
    for (int k = 0; k < pages; ++k) {
        const dvec2 at = on_circle(static_cast<double>(k) / pages);
        const double u = one_texture ? 1 : random_.real(0.2, 1);
        const Corner outer{position({at.x, at.y, random_.real(0, 1)}), texture({u, 0.5}), 0};
        if (random_.coin())
            face(bottom, top, outer);
        else
            face(top, bottom, outer);
    }
}

void MeshMaker::soup() {
    const int vertices = random_.integer32(4, 14), count = random_.integer32(1, 40);
    for (int k = 0; k < vertices; ++k) {
        position(jitter(1));
        texture({random_.real(0, 1), random_.real(0, 1)});
    }
    const bool own_texture = random_.chance(30);
    const auto any = [&] {
        const auto p = static_cast<std::size_t>(random_.integer(0, vertices - 1));
        return Corner{p, own_texture ? texture({random_.real(0, 1), random_.real(0, 1)}) : p, 0};
    };
    for (int k = 0; k < count; ++k) {
        const Corner a = any(), b = any(), c = any();
        face(a, b, c);
    }
    // One that is a triangle whatever was drawn.
    const std::size_t p = position({2, 0, 0}), q = position({2, 1, 0}), r = position({2, 0, 1});
    // In separate statements: the evaluation order of a call's arguments is unspecified.
    const std::size_t tp = texture({0, 0}), tq = texture({1, 0}), tr = texture({0, 1});
    face({p, tp, 0}, {q, tq, 0}, {r, tr, 0});
}

/// Two triangles whose texture is mirrored across their common edge: one of each handedness.
void MeshMaker::mirrored_pair() {
    const Corner a{position({0, 0, 0}), texture({0.3, 0}), 0}, b{position({0, 1, 0}), texture({0.3, 1}), 0};
    const Corner c{position({1, 0.5, 0}), texture({0.9, 0.5}), 0};
    const Corner d{position({-1, 0.5, random_.real(-0.5, 0.5)}), texture({0.9, 0.5}), 0};
    face(a, c, b);
    face(a, b, d);
}

std::string MeshMaker::make() {
    const int columns = random_.integer32(1, 9), rows = random_.integer32(1, 9);
    const int round = std::max(3, columns), tall = std::max(3, rows);
    const double hill = random_.real(-0.5, 0.5), inner = random_.real(0.1, 0.6);
    switch (random_.integer(0, 9)) {
        case 0:
            grid(columns, rows, false, false,
                 [&](double u, double v) { return dvec3(2 * u - 1, 2 * v - 1, hill * u * (1 - u) * v); });
            return "grid";
        case 1:
            grid(round, rows, true, false, [](double u, double v) {
                const dvec2 c = on_circle(u);
                return dvec3(c.x, c.y, 2 * v - 1);
            });
            return "cylinder";
        case 2:
            grid(round, std::max(2, rows), true, false, [](double u, double v) {
                const dvec2 c = on_circle(u), s = on_circle(v / 2);  // v: half round, from pole to pole
                return v == 0 || v == 1 ? dvec3(0, 0, v == 0 ? 1 : -1) : dvec3(c.x * s.y, c.y * s.y, s.x);
            });
            return "sphere";
        case 3:
            grid(round, tall, true, true, [&](double u, double v) {
                const dvec2 c = on_circle(u), s = on_circle(v);
                const double radius = 1 + inner * s.x;
                return dvec3(radius * c.x, radius * c.y, inner * s.y);
            });
            return "torus";
        case 4:
        case 5: solid(); return "solid";
        case 6: fan(); return "fan";
        case 7: slivers(); return "slivers";
        case 8:
            if (random_.coin()) {
                book();
                return "book";
            }
            mirrored_pair();
            return "mirrored pair";
        default: soup(); return "soup";
    }
}

void MeshMaker::dress(const RandomMap& map) {
    set_normals();
    set_textures(map);
    place();
}

/// Face normals give creases; tilted ones are perpendicular to nothing.
void MeshMaker::set_normals() {
    const std::int64_t choice = random_.integer(0, 5);
    if (choice > 1)
        return;
    if (choice == 0)
        for (const dvec3& p : positions_)
            normals_.push_back(unit(unit(p) + jitter(0.8)));
    for (Face& face : faces_) {
        if (choice == 1) {
            const dvec3 a = positions_[face[0].position];
            normals_.push_back(unit(glm::cross(positions_[face[1].position] - a, positions_[face[2].position] - a)));
        }
        for (Corner& corner : face)
            corner.normal = choice == 0 ? corner.position : normals_.size() - 1;
    }
}

void MeshMaker::set_textures(const RandomMap& map) {
    const auto scale = [&] {
        return random_.chance(2)    ? 0.0
               : random_.chance(50) ? 1.0
                                    : random_.one_of({0.25, 0.5, 2.0, 3.0, 1.7, -1.0, 0.015625});
    };
    const auto offset = [&] { return random_.chance(60) ? 0.0 : random_.one_of({0.5, 1.0, -1.25, 0.37}); };
    const dvec2 times{scale(), scale()}, plus{offset(), offset()};  // braces: drawn in this order
    const dvec2 size(map.width, map.height);
    const double snapped = random_.chance(40) ? random_.one_of({1.0, 2.0, 8.0}) : 0;  // steps per texel
    const bool turned = random_.chance(20);
    for (dvec2& t : textures_) {
        t = (turned ? dvec2(t.y, t.x) : t) * times + plus;
        if (snapped > 0)
            t = glm::floor(t * size * snapped + 0.5) / (size * snapped);
    }
}

void MeshMaker::place() {
    const double size = random_.one_of({1.0, 1.0, 1.0, 0.001, 37.5, 2000.0});
    const dvec3 centre = random_.chance(70) ? dvec3(0) : jitter(10 * size);
    for (dvec3& p : positions_)
        p = p * size + centre;
}

std::string MeshMaker::obj() const {
    std::string text;
    for (const dvec3& p : positions_)
        text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    for (const dvec2& t : textures_)
        text += fmt::format("vt {} {}\n", t.x, t.y);
    for (const dvec3& n : normals_)
        text += fmt::format("vn {} {} {}\n", n.x, n.y, n.z);
    for (const Face& face : faces_) {
        text += "f";
        for (const Corner& c : face)
            text += normals_.empty() ? fmt::format(" {}/{}", c.position + 1, c.texture + 1)
                                     : fmt::format(" {}/{}/{}", c.position + 1, c.texture + 1, c.normal + 1);
        text += "\n";
    }
    return text;
}

}  // namespace

RandomMesh make_random_mesh(Random& random, const RandomMap& map) {
    MeshMaker maker(random);
    RandomMesh mesh;
    mesh.kind = maker.make();
    maker.dress(map);
    mesh.obj = maker.obj();
    return mesh;
}

}  // namespace tessera
