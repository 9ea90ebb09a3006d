#include <rapidcheck.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "testbench/bake/quadric.h"

using namespace tessera;

namespace {

double value_at(const Quadric& q, const glm::dvec3& p) {
    const glm::dvec3 from = p - q.centre;
    return glm::dot(from, q.form * from) + glm::dot(q.linear, from) + q.constant;
}

glm::dvec3 random_vector(int size) {
    glm::dvec3 v;
    for (int k = 0; k < 3; ++k)
        v[k] = 0.001 * *rc::gen::inRange(-1000 * size, 1000 * size + 1);
    return v;
}

/// Height over x, y of a shape with centre (1, 2, 3) and semi-axes (2, 1, 0.5).
std::optional<double> height(QuadricShape shape, double x, double y, Root root, int axis = 2, int sheets = 1) {
    return intersect(make_quadric(shape, {1, 2, 3}, {2, 1, 0.5}, axis, sheets), {x, y, 0}, {0, 0, 1}, root);
}

}  // namespace

TEST_CASE("quadric: heights of the named shapes equal their equations solved by hand") {
    const double x = 1.6, y = 2.3, s = 0.3 * 0.3 + 0.3 * 0.3;  // ((x - 1) / 2)^2 + ((y - 2) / 1)^2
    using Shape = QuadricShape;
    CHECK(height(Shape::ellipsoid, x, y, Root::highest).value() == Approx(3 + 0.5 * std::sqrt(1 - s)).epsilon(1e-15));
    CHECK(height(Shape::ellipsoid, x, y, Root::lowest).value() == Approx(3 - 0.5 * std::sqrt(1 - s)).epsilon(1e-15));
    CHECK(height(Shape::ellipsoid, x, y, Root::nearest).value() ==
          height(Shape::ellipsoid, x, y, Root::lowest).value());
    for (const Root root : {Root::highest, Root::lowest, Root::nearest})
        CHECK(height(Shape::paraboloid, x, y, root).value() == Approx(3 - 0.5 * s).epsilon(1e-15));
    CHECK(height(Shape::cone, x, y, Root::lowest).value() == Approx(3 - 0.5 * std::sqrt(s)).epsilon(1e-15));
    CHECK(height(Shape::cone, 1, 2, Root::lowest).value() == Approx(3).epsilon(1e-15));
    CHECK(height(Shape::hyperboloid, x, y, Root::highest, 2, 2).value() ==
          Approx(3 + 0.5 * std::sqrt(1 + s)).epsilon(1e-15));
    CHECK_FALSE(height(Shape::hyperboloid, x, y, Root::highest, 2, 1));
    CHECK(height(Shape::hyperboloid, 4, 2, Root::highest, 2, 1).value() ==
          Approx(3 + 0.5 * std::sqrt(2.25 - 1)).epsilon(1e-15));
    CHECK_FALSE(height(Shape::cylinder, x, y, Root::highest, 2));  // the line is parallel to it
    CHECK(height(Shape::cylinder, 99, y, Root::highest, 0).value() ==
          Approx(3 + 0.5 * std::sqrt(1 - 0.09)).epsilon(1e-15));
    CHECK_FALSE(height(Shape::ellipsoid, 3.01, 2, Root::highest));
    CHECK(height(Shape::ellipsoid, 3, 2, Root::highest).value() == Approx(3));  // touches at one point
    CHECK(make_quadric(Shape::paraboloid, {0, 0, 0}, {1, 1, -2}, 2, 0).linear.z == -0.5);
}

TEST_CASE("quadric: a root found is on the quadric, and no root is missed") {
    CHECK(rc::check([] {
        Quadric q;
        const glm::dvec3 diagonal = random_vector(2), mixed = random_vector(1);
        q.form = glm::dmat3(diagonal.x, mixed.x, mixed.y, mixed.x, diagonal.y, mixed.z, mixed.y, mixed.z, diagonal.z);
        q.linear = random_vector(2);
        q.centre = random_vector(3);
        q.constant = 0.001 * *rc::gen::inRange(-2000, 2000);
        const glm::dvec3 origin = random_vector(4), direction = random_vector(2);
        RC_PRE(glm::length(direction) > 0.1);
        const glm::dvec3 n = glm::normalize(direction);
        const std::optional<double> high = intersect(q, origin, n, Root::highest),
                                    low = intersect(q, origin, n, Root::lowest),
                                    near = intersect(q, origin, n, Root::nearest);
        RC_ASSERT(high.has_value() == low.has_value());
        RC_ASSERT(high.has_value() == near.has_value());
        if (high) {
            RC_ASSERT(*low <= *high);
            RC_ASSERT(*near == *low || *near == *high);
            RC_ASSERT(std::abs(*near) <= std::min(std::abs(*low), std::abs(*high)) * (1 + 1e-8));
            for (const double t : {*low, *high}) {
                const double terms = 60 + 10 * t * t;
                RC_ASSERT(std::abs(value_at(q, origin + t * n)) < 1e-12 * terms);
            }
        } else {
            // A quadratic function without roots has a constant sign.
            const double sign = value_at(q, origin);
            for (int k = -50; k <= 50; ++k)
                RC_ASSERT(value_at(q, origin + 0.3 * k * n) * sign >= -1e-9);
        }
    }));
}

TEST_CASE("quadric: of two equally near roots the one along the normal is taken, roots beyond 1e6 are not") {
    const Quadric sphere = make_quadric(QuadricShape::ellipsoid, {0.1, 0.2, 0}, glm::dvec3(0.7), 2, 0);
    for (int k = 0; k < 60; ++k) {
        const std::optional<double> t = intersect(sphere, {0.01 * k, 0.3, 0}, {0, 0, 1}, Root::nearest);
        REQUIRE(t);
        CHECK(*t > 0);
    }
    const Quadric plane{{0, 0, 0}, glm::dmat3(0), {0, 0, 1}, -1e6};  // z = 1e6
    CHECK(intersect(plane, {0, 0, 0}, {0, 0, 1}, Root::highest).value() == 1e6);
    CHECK_FALSE(intersect(plane, {0, 0, -1}, {0, 0, 1}, Root::highest));
    CHECK_FALSE(intersect(plane, {0, 0, 0}, {1, 0, 0}, Root::highest));
    CHECK(intersect(plane, {0, 0, 1e6}, {1, 0, 0}, Root::highest).value() == 0);  // lies in the plane
}
