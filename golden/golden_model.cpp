#include "golden/golden_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "golden/height_tests/height_test.h"

namespace tessera::golden {
namespace {

// Largest absolute difference of two components.
double largest_difference(const glm::dvec3& a, const glm::dvec3& b) {
    return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

// Calculates P', N' and the screen position from P, N, T, t. Returns the length of the sum inside bump().
double displace_and_transform(Vertex& v, const Map& map, const Parameters& parameters) {
    const double code = map.code(v.texture, parameters.filter);
    v.displaced_position = v.position + (parameters.scale * code + parameters.bias) * v.normal;
    const Normalised bumped = bump(v.normal, v.tangent, v.handedness, map.normal(v.texture, parameters.filter));
    v.displaced_normal = bumped.direction;

    const glm::dvec4 p(v.displaced_position, 1);
    v.w = glm::dot(parameters.row_w, p);
    v.distance = map.height_test().uses_distances() ? eye_distance(v.displaced_position - parameters.eye) : 0;
    v.in_front = v.w > parameters.near_plane;
    v.screen =
        v.in_front ? glm::dvec2(glm::dot(parameters.row_x, p), glm::dot(parameters.row_y, p)) / v.w : glm::dvec2(0);
    return bumped.length;
}

// Section 4.3. The near-plane rule is expressed by an infinite length.
double view_length(const Vertex& i, const Vertex& j) {
    if (i.in_front && j.in_front)
        return std::abs(i.screen.x - j.screen.x) + std::abs(i.screen.y - j.screen.y);
    const double infinity = std::numeric_limits<double>::infinity();
    return i.in_front || j.in_front ? infinity : -infinity;
}

}  // namespace

double manhattan(const glm::dvec3& v) {
    return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

double eye_distance(const glm::dvec3& v) {
    const glm::dvec3 a = glm::abs(v);
    return std::max({a.x, a.y, a.z, std::max({a.x + a.y, a.y + a.z, a.z + a.x}) * 11 / 16, (a.x + a.y + a.z) * 9 / 16});
}

double level(double distance) {
    int octave = 0;
    const double mantissa = std::frexp(distance, &octave);  // 1/2 to 1
    return std::floor(4096 * (octave - 2 + 2 * mantissa));
}

Normalised normalise(const glm::dvec3& v) {
    const double length = glm::length(v);
    return {length > 0 ? v / length : glm::dvec3(0), length};
}

Normalised bump(const glm::dvec3& normal, const glm::dvec3& tangent, double handedness, const glm::dvec3& map_normal) {
    const glm::dvec3 bitangent = handedness * glm::cross(normal, tangent);
    return normalise(map_normal.x * tangent + map_normal.y * bitangent + map_normal.z * normal);
}

Vertex complete_base_vertex(const Vertex& base, const Map& map, const Parameters& parameters) {
    Vertex v = base;
    v.generation = 0;
    displace_and_transform(v, map, parameters);
    return v;
}

Insertion insert_vertex(const Vertex& i, const Vertex& j, const Map& map, const Parameters& parameters) {
    const auto mean = [&](const glm::dvec3& a, const glm::dvec3& b) {
        const glm::dvec3 sum = a + b, size = glm::abs(sum);
        return normalise(std::max({size.x, size.y, size.z}) < parameters.direction_step ? glm::dvec3(0) : sum / 2.0);
    };
    const Normalised normal = mean(i.normal, j.normal);
    const Normalised tangent = mean(i.tangent, j.tangent);
    Insertion result;
    Vertex& v = result.vertex;
    v.position = (i.position + j.position) / 2.0;
    v.normal = normal.direction;
    v.tangent = tangent.direction;
    // Usually both ends have the same handedness. On a mixed edge the minimum keeps the result commutative.
    v.handedness = std::min(i.handedness, j.handedness);
    v.texture = (i.texture + j.texture) / 2.0;
    if (parameters.texture_step > 0)
        v.texture = glm::floor(v.texture / parameters.texture_step) * parameters.texture_step;
    v.generation = std::max(i.generation, j.generation) + 1;
    result.mean_normal_length = normal.length;
    result.mean_tangent_length = tangent.length;
    result.bump_length = displace_and_transform(v, map, parameters);
    return result;
}

EdgeEvaluation evaluate_edge(const Vertex& i, const Vertex& j, const Map& map, const Parameters& parameters) {
    EdgeEvaluation e;
    e.inserted = insert_vertex(i, j, map, parameters);
    const Vertex& m = e.inserted.vertex;
    const Parameters::Enabled& enabled = parameters.enabled;

    e.normal_difference = std::max(largest_difference(m.displaced_normal, i.displaced_normal),
                                   largest_difference(m.displaced_normal, j.displaced_normal));
    e.normal_test = enabled.normal && e.normal_difference > parameters.normal_threshold;

    const Rectangle size = map.rectangle_size(i.texture, j.texture);
    e.rectangle_width = size.width;
    e.rectangle_height = size.height;
    const HeightTest::Verdict verdict = map.height_test().decide(i, j, m, map, parameters);
    e.summed_height_test = enabled.summed_height && verdict.asks;
    e.order = enabled.summed_height ? verdict.order : 0;
    e.height = verdict.value;
    e.height_limit = verdict.limit;

    e.view_length = view_length(i, j);
    e.view_test = !enabled.view || e.view_length > parameters.view_threshold;

    // Before addressing, so that both copies of a periodic seam get the same result.
    const auto part = [&](const Vertex& v) { return glm::floor(v.texture * parameters.texel_parts); };
    const bool resolution_reached = part(m) == part(i) || part(m) == part(j);
    e.tex_coord_test = !enabled.tex_coord || !resolution_reached;

    e.generation_test = !enabled.generation || m.generation <= parameters.generation_limit;

    e.end_cosine = std::max(glm::dot(i.displaced_normal, parameters.half_vector),
                            glm::dot(j.displaced_normal, parameters.half_vector));
    e.midpoint_cosine = glm::dot(m.displaced_normal, parameters.half_vector);
    e.highlight_test = enabled.highlight && std::max(e.end_cosine, e.midpoint_cosine) > parameters.highlight_cosine &&
                       e.normal_difference > parameters.highlight_normal_threshold;

    e.split = (e.normal_test || e.summed_height_test || e.highlight_test) && e.view_test && e.tex_coord_test &&
              e.generation_test;
    return e;
}

Subdivision subdivide(const std::array<bool, 3>& split, const std::array<Vertex, 6>& vertices, Diagonal diagonal) {
    const int splits = int{split[0]} + int{split[1]} + int{split[2]};
    if (splits == 0)
        return {1, {{{0, 1, 2}}}};
    if (splits == 3)
        return {4, {{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}}};
    if (splits == 1) {
        if (split[0])
            return {2, {{{0, 3, 2}, {3, 1, 2}}}};
        if (split[1])
            return {2, {{{0, 1, 4}, {0, 4, 2}}}};
        return {2, {{{0, 1, 5}, {5, 1, 2}}}};
    }
    std::array<int, 3> corner{};
    std::array<int, 4> q{};
    if (!split[0]) {
        corner = {5, 4, 2};
        q = {0, 1, 4, 5};
    } else if (!split[1]) {
        corner = {0, 3, 5};
        q = {3, 1, 2, 5};
    } else {
        corner = {3, 1, 4};
        q = {0, 3, 4, 2};
    }
    const auto length = [&](int a, int b) {
        return manhattan(vertices[static_cast<std::size_t>(a)].displaced_position -
                         vertices[static_cast<std::size_t>(b)].displaced_position);
    };
    const bool from_first =
        diagonal == Diagonal::first ||
        (diagonal == Diagonal::shorter && length(q[0], q[2]) * (1 - diagonal_margin) <= length(q[1], q[3]));
    if (from_first)
        return {3, {{corner, {q[0], q[1], q[2]}, {q[0], q[2], q[3]}}}};
    return {3, {{corner, {q[0], q[1], q[3]}, {q[1], q[2], q[3]}}}};
}

std::array<bool, 3> edge_to_cut(const std::array<bool, 3>& ask, const std::array<Vertex, 3>& triangle,
                                const std::array<int, 3>& order) {
    std::array<bool, 3> cut{};
    std::size_t best = 3;
    double best_length = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec2 d = glm::abs(triangle[k].texture - triangle[(k + 1) % 3].texture);
        const double length = d.x + d.y;
        if (ask[k] && (best == 3 || order[k] > order[best] || (order[k] == order[best] && length > best_length))) {
            best = k;
            best_length = length;
        }
    }
    if (best < 3)
        cut[best] = true;
    return cut;
}

int Triangle::generation() const {
    return std::max({vertices[0].generation, vertices[1].generation, vertices[2].generation});
}

Tessellation tessellate(const std::vector<std::array<Vertex, 3>>& base, const Map& map, const Parameters& parameters,
                        const std::atomic<std::uint64_t>& bound, const std::function<void(const Triangle&)>& emit) {
    Tessellation result;
    std::vector<Triangle> waiting;
    for (std::size_t index = base.size(); index-- > 0;) {
        Triangle& t = waiting.emplace_back();
        t.base_index = index;
        for (std::size_t k = 0; k < 3; ++k)
            t.vertices[k] = complete_base_vertex(base[index][k], map, parameters);
    }
    while (!waiting.empty()) {
        if (result.triangles_emitted + waiting.size() > bound) {
            result.bound_hit = true;
            return result;
        }
        const Triangle t = waiting.back();
        waiting.pop_back();

        std::array<Vertex, 6> vertices{t.vertices[0], t.vertices[1], t.vertices[2]};
        std::array<bool, 3> split{};
        std::array<int, 3> order{};
        for (std::size_t edge = 0; edge < 3; ++edge) {
            const EdgeEvaluation e = evaluate_edge(t.vertices[edge], t.vertices[(edge + 1) % 3], map, parameters);
            split[edge] = e.split;
            order[edge] = e.order;
            vertices[3 + edge] = e.inserted.vertex;
        }
        result.edges_evaluated += 3;
        if (parameters.diagonal == Diagonal::greatest_rank)
            split = edge_to_cut(split, t.vertices, order);

        const Subdivision pieces = subdivide(split, vertices, parameters.diagonal);
        if (pieces.count == 1) {
            ++result.triangles_emitted;
            result.largest_generation = std::max(result.largest_generation, t.generation());
            emit(t);
            continue;
        }
        for (int child = pieces.count; child-- > 0;) {
            Triangle& c = waiting.emplace_back();
            c.base_index = t.base_index;
            for (std::size_t k = 0; k < 3; ++k) {
                const int corner = pieces.children[static_cast<std::size_t>(child)][k];
                c.vertices[k] = vertices[static_cast<std::size_t>(corner)];
            }
        }
    }
    return result;
}

Tessellation tessellate(const std::vector<std::array<Vertex, 3>>& base, const Map& map, const Parameters& parameters,
                        std::uint64_t bound, const std::function<void(const Triangle&)>& emit) {
    return tessellate(base, map, parameters, std::atomic<std::uint64_t>(bound), emit);
}

}  // namespace tessera::golden
