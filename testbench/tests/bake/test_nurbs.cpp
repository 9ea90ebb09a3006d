#include <rapidcheck.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "testbench/bake/nurbs_patch.h"

using namespace tessera;

namespace {

/// Knots of a curve of `count` control points: random, some repeated, with the ends repeated or not.
std::vector<double> random_knots(std::size_t degree, std::size_t count) {
    std::vector<double> knots;
    double at = 0;
    std::size_t alike = 1;
    const bool clamped = *rc::gen::arbitrary<bool>();
    for (std::size_t k = 0; k < count + degree + 1; ++k) {
        const bool end = clamped && (k <= degree || k > count);
        const bool repeat = k > 0 && (end ? k != count + 1 : alike < degree && *rc::gen::inRange(0, 4) == 0);
        if (k > 0 && !repeat)
            at += 0.01 * *rc::gen::inRange(1, 300);
        alike = repeat ? alike + 1 : 1;
        knots.push_back(at);
    }
    return knots;
}

std::vector<double> random_numbers(std::size_t count, int low, int high) {
    std::vector<double> numbers;
    for (std::size_t k = 0; k < count; ++k)
        numbers.push_back(0.01 * *rc::gen::inRange(100 * low, 100 * high));
    return numbers;
}

/// De Boor's algorithm: without basis functions, by repeated interpolation of the control points.
double de_boor(const std::vector<double>& knots, std::size_t degree, const std::vector<double>& control, double t) {
    std::size_t span = degree;
    for (std::size_t k = degree; k < control.size(); ++k)
        if (knots[k] < knots[k + 1] && knots[k] <= t)
            span = k;
    std::vector<double> d(control.begin() + static_cast<std::ptrdiff_t>(span - degree),
                          control.begin() + static_cast<std::ptrdiff_t>(span + 1));
    for (std::size_t level = 1; level <= degree; ++level)
        for (std::size_t i = degree; i >= level; --i) {
            const double low = knots[span - degree + i], high = knots[span + 1 + i - level];
            const double part = (t - low) / (high - low);
            d[i] = (1 - part) * d[i - 1] + part * d[i];
        }
    return d[degree];
}

/// The same for a rational patch: along u in every row, then along v, with numerator and denominator separate.
double de_boor(const NurbsPatch& patch, double u, double v) {
    std::vector<double> numerators, denominators;
    for (std::size_t j = 0; j < patch.rows; ++j) {
        std::vector<double> numerator, denominator;
        for (std::size_t i = 0; i < patch.columns; ++i) {
            const std::size_t k = j * patch.columns + i;
            numerator.push_back(patch.weights[k] * patch.heights[k]);
            denominator.push_back(patch.weights[k]);
        }
        numerators.push_back(de_boor(patch.knots_u, patch.degree_u, numerator, u));
        denominators.push_back(de_boor(patch.knots_u, patch.degree_u, denominator, u));
    }
    return de_boor(patch.knots_v, patch.degree_v, numerators, v) /
           de_boor(patch.knots_v, patch.degree_v, denominators, v);
}

NurbsPatch bezier(std::size_t columns, std::size_t rows, std::vector<double> heights, std::vector<double> weights) {
    NurbsPatch patch;
    patch.columns = columns;
    patch.rows = rows;
    patch.degree_u = columns - 1;
    patch.degree_v = rows - 1;
    patch.knots_u = bezier_knots(patch.degree_u);
    patch.knots_v = bezier_knots(patch.degree_v);
    patch.heights = std::move(heights);
    patch.weights = std::move(weights);
    return patch;
}

double bernstein(std::size_t degree, std::size_t i, double t) {
    double choose = 1;
    for (std::size_t k = 1; k <= i; ++k)
        choose = choose * static_cast<double>(degree + 1 - k) / static_cast<double>(k);
    return choose * std::pow(t, static_cast<double>(i)) * std::pow(1 - t, static_cast<double>(degree - i));
}

}  // namespace

TEST_CASE("nurbs: basis functions are not negative and sum to one, for any parameter and knots") {
    CHECK(rc::check([] {
        const auto degree = static_cast<std::size_t>(*rc::gen::inRange(1, 9));
        const std::size_t count = degree + 1 + static_cast<std::size_t>(*rc::gen::inRange(0, 8));
        const std::vector<double> knots = random_knots(degree, count);
        RC_PRE(knots[degree] < knots[count]);
        const double part = 0.001 * *rc::gen::inRange(0, 1001);
        const double t = parameter_at(knots, degree, part);
        const BasisFunctions basis = basis_functions(knots, degree, t);
        RC_ASSERT(basis.first + degree < count);
        RC_ASSERT(basis.values.size() == degree + 1);
        for (const double value : basis.values)
            RC_ASSERT(value >= 0);
        const double sum = std::accumulate(basis.values.begin(), basis.values.end(), 0.0);
        RC_ASSERT(std::abs(sum - 1) < 1e-14);
    }));
}

TEST_CASE("nurbs: rational patches of any degree agree with de Boor's algorithm") {
    CHECK(rc::check([] {
        NurbsPatch patch;
        patch.degree_u = static_cast<std::size_t>(*rc::gen::inRange(1, 6));
        patch.degree_v = static_cast<std::size_t>(*rc::gen::inRange(1, 6));
        patch.columns = patch.degree_u + 1 + static_cast<std::size_t>(*rc::gen::inRange(0, 5));
        patch.rows = patch.degree_v + 1 + static_cast<std::size_t>(*rc::gen::inRange(0, 5));
        patch.knots_u = random_knots(patch.degree_u, patch.columns);
        patch.knots_v = random_knots(patch.degree_v, patch.rows);
        RC_PRE(patch.knots_u[patch.degree_u] < patch.knots_u[patch.columns]);
        RC_PRE(patch.knots_v[patch.degree_v] < patch.knots_v[patch.rows]);
        patch.heights = random_numbers(patch.columns * patch.rows, -5, 5);
        patch.weights = random_numbers(patch.columns * patch.rows, 1, 9);
        for (const auto& [u, v] : {std::pair{0.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}, {0.37, 0.5}, {0.123, 0.987}}) {
            const double expected = de_boor(patch, parameter_at(patch.knots_u, patch.degree_u, u),
                                            parameter_at(patch.knots_v, patch.degree_v, v));
            RC_ASSERT(std::abs(height_of(patch, u, v) - expected) < 1e-12);
        }
    }));
}

TEST_CASE("nurbs: a Bezier patch agrees with its Bernstein form and interpolates its corners") {
    const NurbsPatch patch = bezier(4, 3, {0, 1, 2, 5, -1, 3, 0, 2, 7, 1, 1, -2}, std::vector<double>(12, 1.0));
    CHECK(height_of(patch, 0, 0) == 0);
    CHECK(height_of(patch, 1, 0) == 5);
    CHECK(height_of(patch, 0, 1) == 7);
    CHECK(height_of(patch, 1, 1) == -2);
    for (int step = 0; step <= 20; ++step) {
        const double u = step / 20.0, v = (20 - step) * step / 100.0;
        double expected = 0;
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t i = 0; i < 4; ++i)
                expected += bernstein(3, i, u) * bernstein(2, j, v) * patch.heights[4 * j + i];
        CHECK(height_of(patch, u, v) == Approx(expected).margin(1e-14));
    }
}

TEST_CASE("nurbs: a rational quarter circle lies on the circle") {
    const double half = std::sqrt(0.5);
    const std::vector<double> weights{1, half, 1, 1, half, 1};
    const NurbsPatch x = bezier(3, 2, {1, 1, 0, 1, 1, 0}, weights), y = bezier(3, 2, {0, 1, 1, 0, 1, 1}, weights);
    for (int step = 0; step <= 1000; ++step) {
        const double u = step / 1000.0;
        REQUIRE(std::abs(std::hypot(height_of(x, u, 0.3), height_of(y, u, 0.3)) - 1) < 4e-16);
    }
    CHECK(height_of(x, 0.5, 1) == Approx(half).margin(1e-15));
    // Without the weights this is a parabola.
    const NurbsPatch p = bezier(3, 2, {1, 1, 0, 1, 1, 0}, std::vector<double>(6, 1.0)),
                     q = bezier(3, 2, {0, 1, 1, 0, 1, 1}, std::vector<double>(6, 1.0));
    CHECK(std::hypot(height_of(p, 0.5, 0), height_of(q, 0.5, 0)) > 1.05);
}

TEST_CASE("nurbs: a surface is as smooth as its knots allow") {
    NurbsPatch patch = bezier(2, 2, {}, {});
    patch.columns = 4;
    patch.degree_u = 2;
    patch.heights = {0, 1, 0, 1, 0, 1, 0, 1};
    patch.weights.assign(8, 1);
    const auto kink = [&] {
        const double h = 1e-6;
        return height_of(patch, 0.5 + h, 0) - 2 * height_of(patch, 0.5, 0) + height_of(patch, 0.5 - h, 0);
    };
    patch.knots_u = {0, 0, 0, 0.5, 1, 1, 1};
    CHECK(std::abs(kink()) < 1e-10);
    patch.columns = 5;
    patch.heights = {0, 1, 0, 1, 0, 0, 1, 0, 1, 0};
    patch.weights.assign(10, 1);
    patch.knots_u = {0, 0, 0, 0.5, 0.5, 1, 1, 1};
    CHECK(std::abs(kink()) > 1e-6);
}
