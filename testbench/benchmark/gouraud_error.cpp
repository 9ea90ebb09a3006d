#include "testbench/benchmark/gouraud_error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera {
namespace {

double power(double base, int exponent) {
    double result = 1;
    for (; exponent > 0; exponent /= 2, base *= base)
        if (exponent % 2 != 0)
            result *= base;
    return result;
}

double area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// A triangle in texture space, in texels.
class TexelTriangle {
  public:
    explicit TexelTriangle(const std::array<glm::dvec2, 3>& corners)
        : corners_(corners), area_(area(corners[0], corners[1], corners[2])) {}

    bool flat() const { return area_ == 0; }
    /// Barycentric coordinates; they add up to 1, and none is negative inside.
    glm::dvec3 weights(const glm::dvec2& t) const {
        const glm::dvec2 &a = corners_[0], &b = corners_[1], &c = corners_[2];
        return glm::dvec3(area(b, c, t), area(c, a, t), area(a, b, t)) / area_;
    }
    /// Calls each(centre, weights) for each texel centre inside.
    template <class Each>
    void each_texel(Each&& each) const {
        if (flat())
            return;
        glm::dvec2 low = corners_[0], high = low;
        for (const glm::dvec2& corner : corners_) {
            low = glm::min(low, corner);
            high = glm::max(high, corner);
        }
        for (double y = std::ceil(low.y - 0.5) + 0.5; y <= high.y; ++y)
            for (double x = std::ceil(low.x - 0.5) + 0.5; x <= high.x; ++x) {
                const glm::dvec2 centre(x, y);
                const glm::dvec3 w = weights(centre);
                if (w.x >= 0 && w.y >= 0 && w.z >= 0)
                    each(centre, w);
            }
    }

  private:
    std::array<glm::dvec2, 3> corners_;
    double area_;
};

/// The true displaced normals of one base triangle's texels.
class TrueNormals {
  public:
    TrueNormals(const MachineSetup& setup, const GoldenInputs& inputs)
        : setup_(setup), inputs_(inputs), dequantise_(setup.registers.formats) {}

    glm::dvec3 at(std::uint32_t base, const glm::dvec2& t) const {
        const auto& v = setup_.base_triangles[base].vertices;
        const TexelTriangle triangle(
            {dequantise_.texture(v[0].texture), dequantise_.texture(v[1].texture), dequantise_.texture(v[2].texture)});
        const glm::dvec3 w = triangle.flat() ? glm::dvec3(1, 0, 0) : triangle.weights(t);
        glm::dvec3 normal(0), tangent(0);
        for (int k = 0; k < 3; ++k) {
            const datapath::Vertex& corner = v[static_cast<std::size_t>(k)];
            normal += w[k] * dequantise_.direction(corner.normal);
            tangent += w[k] * dequantise_.direction(corner.tangent);
        }
        return golden::bump(golden::normalise(normal).direction, golden::normalise(tangent).direction, v[0].handedness,
                            inputs_.map.normal(t, inputs_.parameters.filter))
            .direction;
    }

  private:
    const MachineSetup& setup_;
    const GoldenInputs& inputs_;
    Dequantise dequantise_;
};

}  // namespace

GouraudError measure_gouraud(const EmittedMesh& mesh, const MachineSetup& setup, const GoldenInputs& inputs,
                             const Highlight& highlight) {
    constexpr double degree = 3.14159265358979323846 / 180;
    const double border = std::cos(highlight.angle * degree);
    const Dequantise dequantise(setup.registers.formats);
    const TrueNormals normals(setup, inputs);
    const auto cosine = [&](const glm::dvec3& n) { return std::max(0.0, glm::dot(n, highlight.half_vector)); };
    GouraudError result;
    double squares = 0, highlight_squares = 0;
    for (const EmittedTriangle& triangle : mesh.triangles) {
        std::array<glm::dvec2, 3> corners;
        glm::dvec3 lit;
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] = dequantise.texture(triangle.corners[k].texture);
            lit[static_cast<int>(k)] =
                power(cosine(dequantise.direction(triangle.corners[k].displaced_normal)), highlight.exponent);
        }
        std::uint64_t texels = 0, highlight_texels = 0;
        TexelTriangle(corners).each_texel([&](const glm::dvec2& centre, const glm::dvec3& weights) {
            const double own = cosine(normals.at(triangle.base, centre));
            const double error = glm::dot(weights, lit) - power(own, highlight.exponent);
            ++texels;
            squares += error * error;
            result.largest = std::max(result.largest, std::abs(error));
            if (own > border) {
                ++highlight_texels;
                highlight_squares += error * error;
            }
        });
        result.texels += texels;
        result.highlight_texels += highlight_texels;
        if (texels > 0) {
            const double share = static_cast<double>(highlight_texels) / static_cast<double>(texels);
            result.highlight_triangles += share;
            result.other_triangles += 1 - share;
        }
    }
    const auto over = [](double sum, std::uint64_t count) { return count == 0 ? 0 : sum / static_cast<double>(count); };
    result.rms = std::sqrt(over(squares, result.texels));
    result.highlight_rms = std::sqrt(over(highlight_squares, result.highlight_texels));
    result.highlight_triangles = over(result.highlight_triangles, result.highlight_texels);
    result.other_triangles = over(result.other_triangles, result.texels - result.highlight_texels);
    return result;
}

}  // namespace tessera
