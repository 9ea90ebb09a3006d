#include <png.h>

#include <algorithm>
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
    const auto shows_nothing = [](const RenderMesh& mesh, const View& view) {
        const Picture picture = render_pictures(mesh, view, {Style{}}).front();
        return !picture.mesh_in_sight && is_background(picture.image);
    };
    const View view = look_down(4, 50, 40, 50);
    CHECK(shows_nothing(RenderMesh{}, view));
    View away = view;
    away.eye.z = -4;  // the mesh is behind the eye
    CHECK(shows_nothing(make_sphere({0, 0, 0}, 24), away));
    View near = view;
    near.near_plane = 6;
    CHECK(shows_nothing(make_sphere({0, 0, 0}, 24), near));
    CHECK(render_styles(RenderMesh{}, view, {}).empty());
    for (const Picture& picture : render_views(RenderMesh{}, view, {PictureView::overview, PictureView::stopped}, {}))
        CHECK(picture.image.width == 1600);
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

TEST_CASE("A run's mesh has each vertex once, and what its triangles are drawn by") {
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
    const RenderMesh mesh = make_render_mesh({std::vector{first, second}}, MachineSetup{});
    REQUIRE(mesh.triangles.size() == 2);
    CHECK(mesh.positions.size() == 4);
    CHECK(mesh.normals[0] == glm::vec3(0, 0, 1));
    CHECK(mesh.triangles[0].generation == 0);
    CHECK(mesh.triangles[0].deciding_test == DecidingTest::base);
    CHECK(mesh.triangles[1].generation == 5);
    CHECK(mesh.triangles[1].deciding_test == DecidingTest::both);
}
