// The golden model's parameters from a job, against values derived by hand.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "golden/golden_setup.h"
#include "golden/height_tests/rank_test.h"

using namespace tessera::golden;

namespace {

bool near(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::length(a - b) < 1e-12;
}

// Looks down at the origin from (0, 0, 5), at 90 degrees, so that half the viewport's height is the depth.
Camera straight_down() {
    Camera camera;
    camera.eye = {0, 0, 5};
    camera.target = {0, 0, 0};
    camera.up = {0, 3, 0};
    camera.field_of_view = 90;
    camera.near_plane = 0.5;
    camera.viewport = {200, 100};
    return camera;
}

// Pixel and depth of a point of the model.
glm::dvec3 seen(const Camera& camera, const glm::dvec3& model, const Placement& placement = {}) {
    const View view = make_view(camera, placement);
    const glm::dvec4 p(placement.to_world(model), 1);
    const double w = glm::dot(view.row_w, p);
    return {glm::dot(view.row_x, p) / w, glm::dot(view.row_y, p) / w, w};
}

}  // namespace

TEST_CASE("camera: the axis meets the viewport's centre, the field of view its upper edge") {
    const Camera camera = straight_down();
    CHECK(near(seen(camera, {0, 0, 0}), {100, 50, 5}));
    CHECK(near(seen(camera, {0, 0, 4}), {100, 50, 1}));
    CHECK(near(seen(camera, {0, 5, 0}), {100, 100, 5}));  // upper edge
    CHECK(near(seen(camera, {0, -5, 0}), {100, 0, 5}));   // lower edge
    CHECK(near(seen(camera, {10, 0, 0}), {200, 50, 5}));  // right edge: twice as wide as high
    CHECK(near(seen(camera, {-10, 0, 0}), {0, 50, 5}));   // left edge
    CHECK(near(seen(camera, {1, 1, 4}), {150, 100, 1}));  // five times as near, five times as large
}

TEST_CASE("camera: a field of view of 60 degrees is vertical") {
    Camera camera = straight_down();
    camera.field_of_view = 60;
    const double half = 5 / std::sqrt(3.0);  // 5 tan 30 degrees
    CHECK(near(seen(camera, {0, half, 0}), {100, 100, 5}));
    CHECK(near(seen(camera, {half, 0, 0}), {150, 50, 5}));  // square pixels: half a height to the right
}

TEST_CASE("camera: looks along x with z up, from anywhere") {
    Camera camera = straight_down();
    camera.eye = {-2, 7, 1};
    camera.target = {8, 7, 1};
    camera.up = {0.3, 0, 1};  // not perpendicular to the view axis
    const View view = make_view(camera, {});
    CHECK(near(view.backward, {-1, 0, 0}));
    CHECK(near(view.right, {0, -1, 0}));
    CHECK(near(view.up, {0, 0, 1}));
    CHECK(near(seen(camera, {2, 7, 1}), {100, 50, 4}));
    CHECK(near(seen(camera, {2, 7, 3}), {100, 75, 4}));
    CHECK(near(seen(camera, {2, 5, 1}), {125, 50, 4}));
}

TEST_CASE("camera: the world's scale changes depths, not pixels") {
    const Placement placement{{1, 2, 3}, 4};
    const Camera camera = straight_down();
    CHECK(near(placement.to_world({2, 2, 2}), {4, 0, -4}));
    CHECK(near(seen(camera, {10, 5, 0}, placement), {200, 100, 20}));
    CHECK(make_view(camera, placement).near_plane == 2);
    CHECK(near(make_view(camera, placement).eye, {-4, -8, 8}));
}

TEST_CASE("unit vectors are made from vectors of any length") {
    CHECK(near(unit({3e-200, 0, 4e-200}), {0.6, 0, 0.8}));
    CHECK(near(unit({0, -3e200, 4e200}), {0, -0.6, 0.8}));
    CHECK(unit({0, 0, 0}) == glm::dvec3(0));
}

TEST_CASE("parameters: displacement is in world units, thresholds are cosines") {
    Scene scene;
    scene.camera = straight_down();
    scene.placement.scale = 8;
    scene.lowest = -0.5;
    scene.highest = 1.5;
    scene.highest_code = 4;
    scene.normal_threshold = 0.25;
    scene.view_threshold = 7;
    scene.generation_limit = 9;
    scene.highlight_angle = 60;
    scene.highlight_normal_threshold = 0.125;
    scene.light = {0, 0, 2};
    const Parameters p = make_parameters(scene);
    CHECK(p.scale == 4);  // 8 * 2 / 4
    CHECK(p.bias == -4);  // 8 * -0.5
    CHECK(p.normal_threshold == 0.25);
    CHECK(p.view_threshold == 7);
    CHECK(p.generation_limit == 9);
    CHECK(p.highlight_cosine == Approx(0.5));
    CHECK(p.highlight_normal_threshold == 0.125);
    CHECK(near(p.half_vector, {0, 0, 1}));
    CHECK(p.near_plane == 4);
    CHECK(p.texture_step == 0);
}

TEST_CASE("settings: the Rank Test's thresholds are in pixels at distance 1") {
    Scene scene;
    scene.camera = straight_down();  // 50 pixels are 1 high at distance 1; the tangent to a corner is the root of 5
    scene.placement.scale = 8;
    scene.lowest = 0;
    scene.highest = 2;
    scene.highest_code = 4;                                 // a code is 4 high
    RankSettings asked{400, 0, 8, 8, RankView::per_point};  // 2 codes
    CHECK(on_scales(asked, scene, 0).rank_threshold == Approx(18 * 1024));
    scene.texel_area = 0.25;  // a texel is 25 pixels wide
    asked = {10000, 50 * std::sqrt(6.0), 8, 8, RankView::per_pixel};
    CHECK(on_scales(asked, scene, 0).rank_threshold == Approx(18 * 1024));
    CHECK(on_scales(asked, scene, 0).bound_threshold == Approx((8 + std::log2(1 / (8 * std::sqrt(6.0)))) * 2048));
    CHECK(on_scales(asked, scene, 0).view == RankView::per_pixel);
    CHECK(make_parameters(scene).eye == glm::dvec3(0, 0, 40));
    asked.rank_threshold = 0;
    CHECK(on_scales(asked, scene, 0).rank_threshold == -(1 << 20));
    scene.placement.scale = 0;  // no error is visible: 0 of 0
    CHECK(on_scales(asked, scene, 0).rank_threshold == -(1 << 20));
    asked.view = RankView::none;
    CHECK(on_scales(asked, scene, 0).rank_threshold == 0);
}

TEST_CASE("half vector and light are in the viewer's coordinates") {
    Scene scene;
    scene.camera = straight_down();
    scene.light = {5, 0, 0};
    CHECK(near(make_parameters(scene).half_vector, glm::dvec3(1, 0, 1) / std::sqrt(2.0)));
    CHECK(near(light_as_seen(scene), {1, 0, 0}));
    scene.light = {0, 0, -3};  // straight towards the viewer
    CHECK(make_parameters(scene).half_vector == glm::dvec3(0));
    CHECK(near(light_as_seen(scene), {0, 0, -1}));
    scene.camera.up = {1, 0, 0};
    scene.light = {3, 4, 0};
    CHECK(near(light_as_seen(scene), {-0.8, 0.6, 0}));
}

TEST_CASE("values that are no heights get the lowest or the highest height") {
    const float infinity = std::numeric_limits<float>::infinity(), lowest = std::numeric_limits<float>::lowest();
    const auto heights = [](std::vector<float> values, const MapSource& source) { return heights_of(values, source); };
    CHECK(heights({3, NAN, -infinity, 5, infinity}, {}) == std::vector<float>{3, 3, 3, 5, 5});
    CHECK(heights({-9999, 3, 5, -9998}, {{-9999, -9998}}) == std::vector<float>{3, 3, 5, 3});
    CHECK(heights({-9999, 3, 5, -9998}, {{-9998.5}}) == std::vector<float>{-9999, 3, 5, -9998});
    CHECK(heights({lowest, 3}, {{-3.4e38}}) == std::vector<float>{3, 3});
    CHECK(heights({-infinity, infinity, 3, 4}, {{-1.7e308}}) == std::vector<float>{3, 4, 3, 4});
    CHECK(heights({0.1F, 3}, {{0.1}}) == std::vector<float>{3, 3});
    INFO("half precision has steps of 8 above 8192, and ends at 65504");
    CHECK(heights({-10000, 3, -9992}, {{-9999}, 1, 11}) == std::vector<float>{-9992, 3, -9992});
    CHECK(heights({infinity, 3, 4}, {{1e20}, 1, 11}) == std::vector<float>{3, 3, 4});
    INFO("samples of an integer format");
    CHECK(heights({1, 30 / 255.F, 29 / 255.F}, {{255, 29}, 255}) ==
          std::vector<float>{30 / 255.F, 30 / 255.F, 30 / 255.F});
    CHECK(heights({0, 1, 2}, {{0}}) == std::vector<float>{1, 1, 2});
}

TEST_CASE("codes span the map's range and no more") {
    CHECK(code_of(0.5, 0, 1, 255) == 127.5);
    CHECK(code_of(-3, -3, 5, 15) == 0);
    CHECK(code_of(3, -3, 5, 16) == 12);
    CHECK(code_of(9, -3, 5, 15) == 15);
    CHECK(code_of(-9, -3, 5, 15) == 0);
    CHECK(code_of(2, 2, 2, 15) == 0);  // a constant map
}

TEST_CASE("base vertices: texture coordinates are in texels, clamped to the map and rounded to the grid") {
    const Map map(10, 20, AddressMode::clamp, AddressMode::repeat, std::vector<double>(200, 1));
    Vertex given;
    given.position = {1, 2, 4};
    given.normal = {0, 0, 1};
    const Placement placement{{1, 1, 1}, 2};
    const Vertex inside = place_vertex(given, {0.25, 0.5}, placement, map);
    CHECK(near(inside.position, {0, 2, 6}));
    CHECK(inside.normal == given.normal);
    CHECK(inside.texture == glm::dvec2(2.5, 10));
    CHECK(place_vertex(given, {1.5, 1.5}, placement, map).texture == glm::dvec2(10, 30));
    CHECK(place_vertex(given, {-0.5, -0.5}, placement, map).texture == glm::dvec2(0, -10));
    CHECK(on_grid({0.3, 0.45}, 0.25) == glm::dvec2(0.25, 0.5));
    CHECK(on_grid({0.125, 0.375}, 0.25) == glm::dvec2(0, 0.5));  // ties: even
}

TEST_CASE("the mean of two directions that are opposite but for rounding is 0") {
    const Map map(1, 1, AddressMode::clamp, AddressMode::clamp, {0});
    Vertex i, j;
    i.normal = i.tangent = {0.6, 0.8, 0};
    j.normal = j.tangent = {-0.6, 1e-9 - 0.8, 0};
    Parameters parameters;
    CHECK(insert_vertex(i, j, map, parameters).vertex.normal == glm::dvec3(0, 1, 0));
    parameters.direction_step = 1.0 / 16384;
    CHECK(insert_vertex(i, j, map, parameters).vertex.normal == glm::dvec3(0));
    CHECK(insert_vertex(i, j, map, parameters).vertex.tangent == glm::dvec3(0));
    j.normal.y = 1.01 / 16384 - 0.8;
    CHECK(insert_vertex(i, j, map, parameters).vertex.normal.y > 0.99);
}

TEST_CASE("an inserted texture coordinate is rounded down to the grid, if any") {
    const Map map(10, 20, AddressMode::clamp, AddressMode::clamp, std::vector<double>(200, 1));
    Vertex i, j;
    i.texture = {1, 2.25};
    j.texture = {1.75, 2.5};
    Parameters parameters;
    CHECK(insert_vertex(i, j, map, parameters).vertex.texture == glm::dvec2(1.375, 2.375));
    parameters.texture_step = 0.25;
    CHECK(insert_vertex(i, j, map, parameters).vertex.texture == glm::dvec2(1.25, 2.25));
}
