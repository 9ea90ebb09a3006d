#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

#include "golden/golden_model.h"
#include "modules/datapath/bilinear.h"

namespace tessera {

/// Bounds on the hardware's error against the golden model, both starting from the same (dequantised) operands. Derived
/// from the formats and the documented rounding of each operation in modules/datapath, not from observation.
///
/// In golden's units: world, texels, pixels, components of unit vectors. u below is one LSB of a format. A dvec3 bounds
/// the absolute error per component. |.| is taken per component unless it is a length. Only normalisation is
/// linearised; the remainder is bounded there too.
///
/// Rounding to nearest is monotone: if golden's value is v and the hardware's value before rounding differs from it by
/// at most e, the result lies in round(v - e) .. round(v + e), which is often one value. The final error is
/// bounded by the farther end, at most e + u/2 and often much less.
class ErrorBounds {
  public:
    /// The allowed range of hardware minus golden.
    struct Interval {
        double low = 0, high = 0;
        static Interval within(double bound) { return {-bound, bound}; }
    };

    explicit ErrorBounds(const datapath::Formats& formats)
        : position_lsb_(std::ldexp(1.0, -formats.position.fraction)),
          normal_lsb_(std::ldexp(1.0, -formats.normal.fraction)),
          texture_lsb_(std::ldexp(1.0, -formats.texture.fraction)),
          screen_lsb_(std::ldexp(1.0, -formats.screen.fraction)),
          view_distance_lsb_(std::ldexp(1.0, -formats.view_distance.fraction)),
          code_lsb_(std::ldexp(1.0, -datapath::code_fraction(formats))) {}

    /// P_ij, (N_i + N_j) / 2, t_ij. midpoint.h: (a + b) >> 1 rounds down, so the error is 0 or -u/2.
    Interval position_midpoint() const { return {-position_lsb_ / 2, 0}; }
    Interval direction_midpoint() const { return {-normal_lsb_ / 2, 0}; }
    Interval texture_midpoint() const { return {-texture_lsb_ / 2, 0}; }

    /// N_ij, T_ij: the mean is rounded down, by u/2 if the sum is odd, then normalised. `mean`, `direction`,
    /// `length`: golden's mean, its direction and its length.
    glm::dvec3 inserted_direction(const glm::dvec3& mean, const glm::dvec3& direction, double length) const {
        return normalised(direction, length, left_by_rounding_down(mean, normal_lsb_));
    }

    /// The point at which the hardware reads the maps for golden's t: t_ij is rounded down; a base vertex's t is exact.
    glm::dvec2 read_at(const glm::dvec2& t) const { return glm::floor(t / texture_lsb_) * texture_lsb_; }

    /// Error of a map's value at t, in codes or components of N_d; `read`: golden's at read_at(t), in the same texel,
    /// whose value is exact. Interpolated values differ; bilinear.h then rounds to nearest, a code to code_fraction
    /// bits, N_d to the normal's format. Its operand has at most 18 + 26 bits, exact in double precision too.
    double code(double code, double read) const { return std::abs(read - code) + after_rounding(read, 0, code_lsb_); }
    glm::dvec3 map_normal(const glm::dvec3& n, const glm::dvec3& read) const {
        return glm::abs(read - n) + after_rounding(read, glm::dvec3(0), normal_lsb_);
    }

    /// N' = bump(N, T, N_d); `n_error`, `t_error` bound the errors of N and T (zero for a base vertex), `map_error` that
    /// of N_d.
    /// `bumped`, `length`: golden's result and its length before normalisation.
    glm::dvec3 displaced_normal(const glm::dvec3& n, const glm::dvec3& n_error, const glm::dvec3& t,
                                const glm::dvec3& t_error, const glm::dvec3& map_normal, const glm::dvec3& map_error,
                                const glm::dvec3& bumped, double length) const {
        // B = N x T, rounded: with N + e, T + f the error before rounding is N x f + e x T + e x f.
        const glm::dvec3 b_error = after_rounding(
            glm::cross(n, t),
            cross_bound(glm::abs(n), t_error) + cross_bound(n_error, glm::abs(t)) + cross_bound(n_error, t_error),
            normal_lsb_);
        // The sum's parts: (N_d.x + g.x) (T + f) - N_d.x T = N_d.x f + g.x (T + f), likewise with B and N.
        const glm::dvec3 frame_error =
            std::abs(map_normal.x) * t_error + std::abs(map_normal.y) * b_error + std::abs(map_normal.z) * n_error;
        const glm::dvec3 sum_error = frame_error + map_error.x * (glm::abs(t) + t_error) +
                                     map_error.y * (glm::abs(glm::cross(n, t)) + b_error) +
                                     map_error.z * (glm::abs(n) + n_error);
        // A zero sum without error is zero on both sides.
        if (length == 0 && sum_error == glm::dvec3(0))
            return glm::dvec3(0);
        // bump.h: the sum is rounded with two more fraction bits, u/8.
        return normalised(bumped, length, sum_error + normal_lsb_ / 8);
    }

    /// P' = P + h N, h = S d + bias; `p`, `height`: golden's P and h; `code_error`: S times the code's error. displace.h:
    /// P was rounded down (a base vertex's is exact), h to nearest, the product to nearest. The error before the last
    /// rounding, b the error of h:
    ///     P + a + (h + b)(N + f) - (P + h N) = a + h f + b (N + f).
    glm::dvec3 displaced_position(const glm::dvec3& p, double height, double code_error, const glm::dvec3& n,
                                  const glm::dvec3& n_error, const glm::dvec3& displaced) const {
        const double height_error = after_rounding(height, code_error, position_lsb_);
        const glm::dvec3 before = left_by_rounding_down(p, position_lsb_) + std::abs(height) * n_error +
                                  height_error * (glm::abs(n) + n_error) +
                                  double_rounding * (glm::abs(p) + std::abs(height) * glm::abs(n));
        return after_rounding(displaced, before, position_lsb_);
    }

    /// P's: pixels and w.
    struct Screen {
        double x = 0, y = 0, w = 0;
        double near_plane = 0;  ///< error of w in the near plane's compare, before rounding to the position's format
    };

    /// Transform of P' with error up to `p_error`. `w`, `pixels`: golden's.
    ///     W = row_w . P' is exact except for P': its error is dW = sum |row_w| p_error; w is W rounded to nearest.
    ///     x = X / W: (X + dX) / (W + dW) - x = (dX - x dW) / (W + dW) exactly, so before the division's own
    ///     error at most sum |row_x - x row_w| p_error / W_min, W_min the least W of a vertex in front.
    ///     transform.h: the division adds |x| 2^-28, then x is rounded to nearest.
    /// x and y are valid only if golden's vertex is in front.
    Screen screen(const golden::Parameters& parameters, const glm::dvec3& p, const glm::dvec3& p_error, double w,
                  const glm::dvec2& pixels) const {
        const auto sum = [](const glm::dvec4& row, const glm::dvec3& v) {
            return std::abs(row.x) * v.x + std::abs(row.y) * v.y + std::abs(row.z) * v.z;
        };
        const auto row_rounding = [&](const glm::dvec4& row) {
            return double_rounding * (sum(row, glm::abs(p)) + std::abs(row.w));
        };
        const double w_rounding = row_rounding(parameters.row_w);
        Screen result;
        result.near_plane = sum(parameters.row_w, p_error) + w_rounding;
        result.w = after_rounding(w, result.near_plane, view_distance_lsb_);
        const double least_w = std::max(w - result.near_plane, parameters.near_plane * (1 - double_rounding));
        const auto divided = [&](const glm::dvec4& row, double x) {
            if (!(least_w > 0))
                return std::numeric_limits<double>::infinity();
            const double input =
                (sum(row - x * parameters.row_w, p_error) + row_rounding(row) + std::abs(x) * w_rounding) / least_w;
            return after_rounding(x, input + (std::abs(x) + input) * 0x1p-28, screen_lsb_);
        };
        result.x = divided(parameters.row_x, pixels.x);
        result.y = divided(parameters.row_y, pixels.y);
        return result;
    }

    /// D of P' with error up to `p_error`; `distance` is golden's. Two norms differ by at most the norm of the
    /// difference. rank_view.h rounds down.
    Interval distance(const glm::dvec3& p_error, double distance) const {
        const double before = golden::eye_distance(p_error) + double_rounding * distance;
        return {-before - view_distance_lsb_, before};
    }

    /// N' . H, H the same on both sides; `n_error` bounds the errors of N'. edge_tests.h is exact:
    ///     (N' + e) . H - N' . H = e . H, at most sum |e_c| |H_c|.
    double cosine(const glm::dvec3& n, const glm::dvec3& n_error, const glm::dvec3& half_vector) const {
        const glm::dvec3 h = glm::abs(half_vector);
        return glm::dot(n_error, h) + double_rounding * glm::dot(glm::abs(n), h);
    }

  private:
    /// Golden's own error over a few double operations, relative to the sum of the terms' absolute values.
    static constexpr double double_rounding = 0x1p-50;

    /// The distance from v to the farther of round(v - e) and round(v + e); all in LSB.
    static double rounded_away(double v, double e) {
        return std::max(std::abs(std::floor(v + e + 0.5) - v), std::abs(std::floor(v - e + 0.5) - v));
    }
    static double after_rounding(double value, double error, double lsb) {
        return rounded_away(value / lsb, error / lsb) * lsb;
    }
    static glm::dvec3 after_rounding(const glm::dvec3& value, const glm::dvec3& error, double lsb) {
        const double per_lsb = 1 / lsb;  // exact, a power of two
        const glm::dvec3 v = value * per_lsb, e = error * per_lsb;
        return lsb * glm::dvec3(rounded_away(v.x, e.x), rounded_away(v.y, e.y), rounded_away(v.z, e.z));
    }
    /// Rounding error of a mean of two integers: 0 or u/2.
    static glm::dvec3 left_by_rounding_down(const glm::dvec3& mean, double lsb) {
        const glm::dvec3 v = mean * (1 / lsb);
        return (v - glm::floor(v)) * lsb;
    }
    /// |a x b| for components of any sign.
    static glm::dvec3 cross_bound(const glm::dvec3& a, const glm::dvec3& b) {
        return {a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x};
    }

    /// normalise(m + e) - n, n = m / |m|, |e| <= `error` per component, rho = |e| / |m| as lengths.
    ///     First order: (e - n (n . e)) / |m|, so sum_k |delta_ck - n_c n_k| error_k / |m|.
    ///     Remainder: at most 0.6 rho^2 / (1 - rho) (0.577, found by sampling rho in 0..1 and every angle).
    ///     Without expansion: the angle is at most asin(rho), a chord of at most sqrt(2) rho; for rho >= 1 the
    ///     result may be any unit vector or zero: 1 + |n_c|. A zero vector gives zero.
    /// normalise.h: the reciprocal root has a relative error of 2^-28, then the component is rounded to nearest.
    glm::dvec3 normalised(const glm::dvec3& n, double length, const glm::dvec3& error) const {
        const glm::dvec3 size = glm::abs(n);
        const double error_length = glm::length(error);
        if (length == 0 && error_length == 0)
            return glm::dvec3(0);
        glm::dvec3 before = 1.0 + size;
        const double rho = error_length / length;
        if (rho < 1) {
            const double along = glm::dot(size, error);
            // sum_k |delta_ck - n_c n_k| e_k = (1 - n_c^2) e_c + |n_c| (along - |n_c| e_c)
            const glm::dvec3 first = (error + size * (along - 2.0 * size * error)) / length;
            const glm::dvec3 expanded = first + 0.6 * rho * rho / (1 - rho);
            before = glm::min(glm::min(expanded, glm::dvec3(rho * 1.41421356237309515)), before);
        }
        return after_rounding(n, before + 0x1p-28 * (size + before), normal_lsb_);
    }

    double position_lsb_, normal_lsb_, texture_lsb_, screen_lsb_, view_distance_lsb_;
    double code_lsb_;
};

}  // namespace tessera
