#include <png.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "testbench/common/parallel.h"
#include "testbench/render/illumination.h"
#include "testbench/render/image.h"
#include "testbench/render/key_light.h"
#include "testbench/render/palette.h"
#include "testbench/render/png_writer.h"
#include "testbench/render/render.h"
#include "testbench/render/render_mesh.h"
#include "testbench/render/view.h"
#include "testbench/render/view_picture.h"
#include "testbench/render/wireframe.h"
#include "testbench/tests/render/render_scenes.h"

using namespace tessera;

namespace {

std::vector<std::uint8_t> decode(const std::string& file, png_image& header) {
    header = {};
    header.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_memory(&header, file.data(), file.size()) != 0);
    REQUIRE(header.format == PNG_FORMAT_RGB);
    std::vector<std::uint8_t> bytes(PNG_IMAGE_SIZE(header));
    REQUIRE(png_image_finish_read(&header, nullptr, bytes.data(), 0, nullptr) != 0);
    return bytes;
}

}  // namespace

TEST_CASE("A picture is the same on any number of threads") {
    const RenderMesh mesh = make_sphere({});
    const View view = look_down(4, 200, 160, 120);
    Style lines;
    lines.wireframe = true;
    const auto pictures = [&](std::size_t threads) {
        const OnThreads on(threads);
        return render_styles(mesh, view, {Style{}, lines});
    };
    const std::vector<Image> one = pictures(1);
    for (const std::size_t threads : {2U, 3U}) {
        const std::vector<Image> other = pictures(threads);
        for (std::size_t k = 0; k < one.size(); ++k)
            CHECK((one[k].bytes == other[k].bytes));
    }
}

TEST_CASE("A sphere's silhouette is a disc of the right radius and centre") {
    const glm::dvec3 origin(1e5, -3e5, 2e5);  // far from 0, where single precision would not suffice
    const RenderMesh mesh = make_sphere(origin);
    View view = look_down(4, 200, 160, 200);
    view.eye += origin;
    view.centre = {90, 85};
    const Image image = render(mesh, view, Style{});
    double count = 0, sum_x = 0, sum_y = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (image.at(x, y) != Style{}.background) {
                ++count;
                sum_x += x + 0.5;
                sum_y += y + 0.5;
            }
    const double radius = view.focal / std::sqrt(4.0 * 4.0 - 1);
    CHECK(sum_x / count == Approx(90).margin(0.1));
    CHECK(sum_y / count == Approx(85).margin(0.1));
    // Partly covered pixels count: the disc appears half a pixel larger.
    CHECK(std::sqrt(count / pi) == Approx(radius + 0.5).margin(0.35));
    const Colour inside = image.at(90 + static_cast<int>(radius) - 2, 85);
    CHECK(inside != Style{}.background);
}

TEST_CASE("The side that faces the key light is brighter") {
    const Image image = render(make_sphere({0, 0, 0}), look_down(4, 120, 120, 120), Style{});
    CHECK(brightness(image, 60 - 15, 60 - 15) > brightness(image, 60 + 15, 60 + 15) + 60);
    Style other;
    other.key_light = {1, -1, 0.5};
    const Image turned = render(make_sphere({0, 0, 0}), look_down(4, 120, 120, 120), other);
    CHECK(brightness(turned, 60 - 15, 60 - 15) + 60 < brightness(turned, 60 + 15, 60 + 15));
}

TEST_CASE("A patch is lit like each of its points, and not by a light it faces away from") {
    const View view = look_down(4, 120, 120, 120);
    Illumination::Scratch scratch;
    std::vector<ShadingPoint> points(4);
    std::vector<Light> lights, alone;

    const RenderMesh nothing;
    const RayScene open(nothing);
    const Illumination sky(view, Style{}, open);
    double most_apart = 0;
    for (const glm::vec3& normal : make_sphere({}, 16).normals) {
        const glm::dvec3 first(normal);
        const glm::dvec3 side = glm::normalize(glm::cross(first, glm::dvec3(0.3, 0.5, 0.8)));
        const glm::dvec3 other = glm::cross(first, side);
        points[0].normal = glm::normalize(first);
        for (std::size_t k = 1; k < 4; ++k) {
            const double angle = 2 * pi * static_cast<double>(k) / 3;
            points[k].normal = glm::normalize(first + 0.45 * (std::cos(angle) * side + std::sin(angle) * other));
        }
        for (std::size_t sample = 0; sample < samples_per_pixel; ++sample) {
            sky.light(sample, {points, true}, lights, scratch);
            sky.light(sample, {points, false}, alone, scratch);
            for (std::size_t k = 0; k < 4; ++k)
                most_apart = std::max({most_apart, glm::length(lights[k].diffuse - alone[k].diffuse),
                                       std::abs(lights[k].highlight - alone[k].highlight)});
        }
    }
    CHECK(most_apart < 1e-12);

    // Inside a closed sphere only the fill light remains, which comes from the right and casts no shadow.
    const RenderMesh ball = make_sphere({});
    const RayScene closed(ball);
    const Illumination cave(view, Style{}, closed);
    const auto light_of = [&](const glm::dvec3& normal) {
        for (ShadingPoint& point : points)
            point.normal = glm::normalize(normal);
        cave.light(0, {points, true}, lights, scratch);
        return lights.back().diffuse;
    };
    CHECK(light_of({-1, 0, 0}) == light_of({-1, 0, -1}));
    CHECK(light_of({1, 0, 0}).x > light_of({-1, 0, 0}).x + 0.05);
}

TEST_CASE("A sphere above a sheet casts a shadow") {
    RenderMesh mesh = make_square();
    RenderMesh ball = make_sphere({0, 0, 0}, 32);
    for (const glm::vec3& p : ball.positions)
        mesh.positions.push_back(p * 0.2f + glm::vec3(0, 0, 0.4f));
    mesh.normals.insert(mesh.normals.end(), ball.normals.begin(), ball.normals.end());
    for (RenderMesh::Triangle triangle : ball.triangles) {
        for (std::uint32_t& vertex : triangle.vertices)
            vertex += 4;
        mesh.triangles.push_back(triangle);
    }
    Style style;
    style.key_light = {-1, 0, 1};
    const Image image = render(mesh, look_down(4, 160, 160, 240), style);
    const int shadow = 80 + static_cast<int>(0.4 * 60);
    CHECK(brightness(image, shadow, 80) + 100 < brightness(image, shadow, 130));
    CHECK(std::abs(brightness(image, 35, 80) - brightness(image, 35, 130)) < 30);

    // With other tile positions the shadow's edge must not show the tiles. A pixel may take its light from the nearest
    // of its tile's probes, of which there is one in each square of 2 x 2: a neighbour. So its brightness changes by no
    // more than the differences among its neighbours.
    View moved = look_down(4, 160, 160, 240);
    moved.centre += glm::dvec2(4, 4);
    const Image other = render(mesh, moved, style);
    constexpr int rounding = 3;  // one level of each channel
    int changed = 0, beyond = 0;
    for (int y = 1; y + 5 < image.height; ++y)
        for (int x = 1; x + 5 < image.width; ++x) {
            if (std::hypot(x - 80, y - 80) <= 16)  // the ball itself
                continue;
            int darkest = 3 * 255, brightest = 0;
            for (int k = 0; k < 9; ++k) {
                const int near = brightness(image, x - 1 + k % 3, y - 1 + k / 3);
                darkest = std::min(darkest, near);
                brightest = std::max(brightest, near);
            }
            const int change = std::abs(brightness(image, x, y) - brightness(other, x + 4, y + 4));
            changed += change > 0 ? 1 : 0;
            beyond += change > brightest - darkest + rounding ? 1 : 0;
        }
    CHECK(changed > 0);  // the tiles do change the picture
    CHECK(beyond == 0);
}

TEST_CASE("The wireframe darkens the pixels along edges and no others") {
    const RenderMesh mesh = make_square();
    const View view = look_down(4, 120, 120, 160);  // corners at 20 and 100
    Style lines;
    lines.wireframe = true;
    const std::vector<Image> images = render_styles(mesh, view, {Style{}, lines});
    for (int x = 22; x < 98; ++x)
        for (int y = 22; y < 98; ++y) {
            const double to_diagonal = std::abs((x + 0.5) + (y + 0.5) - 120) / std::sqrt(2.0);
            CAPTURE(x, y);
            if (to_diagonal < 0.1)
                REQUIRE(brightness(images[1], x, y) + 100 < brightness(images[0], x, y));
            else if (to_diagonal > 2)
                REQUIRE(images[1].at(x, y) == images[0].at(x, y));
        }
    for (int k = 30; k < 90; ++k) {
        REQUIRE(brightness(images[1], k, 99) + 50 < brightness(images[0], k, 99));
        REQUIRE(brightness(images[1], 20, k) + 50 < brightness(images[0], 20, k));
    }
}

TEST_CASE("Lines keep their width at any distance and fade on small triangles") {
    const auto at = [](double size, double w) {
        const auto corner = [&](double x, double y) { return glm::dvec3(x * w, y * w, w); };
        return Wireframe({corner(0, 0), corner(size, 0), corner(0, size)}, 1);
    };
    CHECK(at(100, 1).coverage(40, 0) == Approx(1));
    CHECK(at(100, 50).coverage(40, 0) == Approx(1));
    CHECK(at(100, 50).coverage(40, 0.5) == Approx(at(100, 1).coverage(40, 0.5)));
    CHECK(at(100, 1).coverage(30, 30) == 0);
    CHECK(at(1, 1).coverage(0.5, 0) < 0.3);
    CHECK(at(1, 1).coverage(0.5, 0) < at(3, 1).coverage(1.5, 0));
    CHECK(Wireframe({glm::dvec3(0), glm::dvec3(0), glm::dvec3(0)}, 1).coverage(0, 0) == 0);
}

TEST_CASE("A view of nothing shows the background") {
    const View view = look_down(4, 50, 40, 50);
    CHECK(is_background(render(RenderMesh{}, view, Style{})));
    View away = view;
    away.eye.z = -4;  // the mesh is behind the eye
    CHECK(is_background(render(make_sphere({0, 0, 0}, 24), away, Style{})));
    View near = view;
    near.near_plane = 6;
    CHECK(is_background(render(make_sphere({0, 0, 0}, 24), near, Style{})));
    CHECK(render_styles(RenderMesh{}, view, {}).empty());
    CHECK(render_views(RenderMesh{}, view, {PictureView::overview}, {}).front().image.width == 1600);
}

TEST_CASE("Collapsed triangles and missing normals do not change the picture") {
    RenderMesh mesh = make_square();
    mesh.normals.assign(4, glm::vec3(0));
    mesh.triangles.push_back({{0, 0, 1}, 3, DecidingTest::both});
    mesh.triangles.push_back({{2, 2, 2}, 3, DecidingTest::both});
    const View view = look_down(4, 60, 60, 80);
    Style lines;
    lines.wireframe = true;
    const Image flat = render(mesh, view, lines);
    CHECK(flat.bytes == render(make_square(), view, lines).bytes);
}

TEST_CASE("Colour shows the generation and the deciding test") {
    const RenderMesh mesh = make_square();
    const View view = look_down(4, 120, 120, 160);
    Style style;
    style.colour_by = ColourBy::deciding_test;
    const Image tests = render(mesh, view, style);
    const Colour normal = tests.at(40, 50);  // upper left: orange
    CHECK(normal[0] > normal[2] + 80);
    const Colour base = tests.at(80, 70);  // lower right: grey
    CHECK(std::abs(base[0] - base[2]) < 25);
    style.colour_by = ColourBy::generation;
    CHECK(render(mesh, view, style).at(40, 50) != render(mesh, view, style).at(80, 70));
    CHECK(generation_colour(12) == generation_colour(255));
}

TEST_CASE("A PNG file decodes to the same pixels") {
    Style style;
    style.colour_by = ColourBy::generation;
    const Image image = render(make_sphere({0, 0, 0}, 24), look_down(4, 131, 77, 60), style);
    png_image header;
    const std::vector<std::uint8_t> bytes = decode(encode_png(image), header);
    CHECK(header.width == 131);
    CHECK(header.height == 77);
    CHECK(bytes == image.bytes);
}

TEST_CASE("The run's camera projects like the hardware's Transform") {
    Job::Camera camera;
    camera.eye = {1.05, -2.9, 2.45};
    camera.target = {0.2, 0.1, 0.3};
    camera.up = {0, 0, 1};
    camera.near_plane = 0.01;
    const View view = make_view(camera);
    CHECK(view.width == 1024);
    const glm::dvec3 p = view.project({0.2, 0.1, 0.3});
    CHECK(p.x / p.z == Approx(512));
    CHECK(p.y / p.z == Approx(384));
    const glm::dvec3 point(0.5, -0.4, 0.2);
    const glm::dvec3 q = view.project(point);
    const glm::dvec3 back = view.eye + q.z * view.ray(q.x / q.z, q.y / q.z);
    CHECK(glm::length(back - point) < 1e-12);
    const glm::dvec3 above = view.project({0.2, 0.1, 0.8});
    CHECK(above.y / above.z < 384);  // rows count downwards

    const View small = resized(view, 400, 400);
    const glm::dvec3 r = small.project(point);
    CHECK(r.x / r.z == Approx(200 + (q.x / q.z - 512) * 400 / 1024));
    CHECK(r.y / r.z == Approx(200 + (q.y / q.z - 384) * 400 / 1024));
}

TEST_CASE("framed() shows all of the mesh, as large as the margin allows") {
    const RenderMesh mesh = make_square();
    const View view = look_down(4, 640, 480, 100);
    const View close = framed(view, mesh, 200, 300, 0.1);
    const glm::dvec3 corner = close.project({1, 1, 0});
    CHECK(corner.x / corner.z == Approx(180));
    CHECK(corner.y / corner.z == Approx(150 - 80));
    CHECK(proportions(view, mesh) == Approx(1));
    const View beyond = framed(look_down(0.5, 640, 480, 1000), mesh, 320, 240, 0);
    CHECK(beyond.focal == Approx(500));  // it already fills the run's own viewport and is not enlarged
    CHECK(framed(view, RenderMesh{}, 320, 240, 0).focal == Approx(50));
}

TEST_CASE("The key light is low over a sheet, else it comes from behind the viewer") {
    const View view = look_down(4, 64, 48, 50);
    CHECK(choose_key_light(make_square(), view).z == Approx(0.616).margin(1e-3));
    CHECK(choose_key_light(make_square(), view).x < 0);
    CHECK(choose_key_light(make_sphere({0, 0, 0}, 24), view) == Style{}.key_light);
    CHECK(choose_key_light(RenderMesh{}, view) == Style{}.key_light);
}

TEST_CASE("A run's mesh is read back in model units, each vertex once") {
    MachineSetup setup;
    setup.model_scale = {4, {10, 20, 30}};
    const auto at = [](int x, int y) {
        EmittedTriangle::Corner corner;
        corner.displaced = {x * 65536, y * 65536, 0};
        corner.displaced_normal = {0, 0, 1 << 14};
        return corner;
    };
    EmittedTriangle first, second;
    first.corners = {at(0, 0), at(8, 0), at(8, 4)};
    second.corners = {at(0, 0), at(8, 4), at(-8, 4)};
    second.corners[2].generation = 5;
    second.split_by = datapath::normal_bit | datapath::summed_height_bit;
    const RenderMesh mesh = make_render_mesh({std::vector{first, second}}, setup);
    REQUIRE(mesh.triangles.size() == 2);
    CHECK(mesh.positions.size() == 4);
    const auto corner = [&](std::size_t triangle, std::size_t k) {
        return mesh.origin + glm::dvec3(mesh.positions[mesh.triangles[triangle].vertices[k]]);
    };
    CHECK(corner(0, 0) == glm::dvec3(10, 20, 30));
    CHECK(corner(0, 2) == glm::dvec3(12, 21, 30));
    CHECK(mesh.normals[0] == glm::vec3(0, 0, 1));
    CHECK(mesh.triangles[0].generation == 0);
    CHECK(mesh.triangles[0].deciding_test == DecidingTest::base);
    CHECK(mesh.triangles[1].generation == 5);
    CHECK(mesh.triangles[1].deciding_test == DecidingTest::both);
}
