#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>

#include "testbench/render/error_range.h"
#include "testbench/render/legend.h"
#include "testbench/render/palette.h"
#include "testbench/render/picture_view.h"
#include "testbench/render/render.h"
#include "testbench/render/view_picture.h"
#include "testbench/tests/render/render_scenes.h"

using namespace tessera;

namespace {

/// The camera's own picture: no framing, and the camera's size in pixels.
PictureOptions as_seen(const View& camera) {
    PictureOptions options;
    options.width = camera.width;
    options.height = camera.height;
    options.whole_viewport = true;
    return options;
}

Picture one_view(const RenderMesh& mesh, const View& camera, PictureView view, const PictureOptions& options) {
    return render_views(mesh, camera, {view}, options).front();
}

/// The paint that a lit pixel most likely has: light changes the brightness, but hardly the hue.
template <typename Paints>
std::size_t nearest_hue(const Colour& pixel, const Paints& paints) {
    const auto hue = [](const Colour& colour) {
        const glm::dvec3 linear = to_linear(colour);
        return linear / (linear.x + linear.y + linear.z);
    };
    std::size_t nearest = 0;
    double least = 10;
    for (std::size_t i = 0; i < paints.size(); ++i) {
        const double distance = glm::length(hue(pixel) - hue(paints[i]));
        if (distance < least) {
            least = distance;
            nearest = i;
        }
    }
    return nearest;
}

bool has_colour(const Image& image, const Colour& colour, int from_row) {
    for (int y = from_row; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (image.at(x, y) == colour)
                return true;
    return false;
}

/// Five quads, each stopped by a different test.
RenderMesh stopped_row() {
    RenderMesh mesh = make_row(5);
    const std::array<std::uint8_t, 5> bits{0, datapath::view_bit, datapath::tex_coord_bit, datapath::generation_bit,
                                           datapath::view_bit | datapath::tex_coord_bit};
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        mesh.triangles[i].stopped_by = bits[i / 2];
    return mesh;
}

}  // namespace

TEST_CASE("render: a mesh is drawn at its projection and nowhere else") {
    RenderMesh mesh;
    mesh.positions = {{-0.7f, -0.4f, 0.1f}, {0.9f, -0.2f, -0.3f}, {0.1f, 0.8f, 0.2f}};
    mesh.normals.assign(3, {0, 0, 1});
    mesh.triangles.push_back({{0, 1, 2}, 0, DecidingTest::base});
    mesh.origin = {1e5, -3e5, 2e5};  // far from 0, where single precision would not suffice
    View view = look_down(3, 240, 180, 200);
    view.eye += mesh.origin;
    view.centre = {115, 85};
    const Image image = one_view(mesh, view, PictureView::shaded, as_seen(view)).image;
    std::array<glm::dvec2, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 p = view.project(mesh.origin + glm::dvec3(mesh.positions[k]));
        corners[k] = {p.x / p.z, p.y / p.z};
    }
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            double depth = 1e9;  // distance from the triangle's border, in pixels
            for (std::size_t k = 0; k < 3; ++k) {
                const glm::dvec2 edge = glm::normalize(corners[(k + 1) % 3] - corners[k]);
                const glm::dvec2 to = glm::dvec2(x + 0.5, y + 0.5) - corners[k];
                depth = std::min(depth, edge.y * to.x - edge.x * to.y);
            }
            CAPTURE(x, y, depth);
            if (depth > 1)
                REQUIRE(image.at(x, y) != Style{}.background);
            if (depth < -1)
                REQUIRE(image.at(x, y) == Style{}.background);
        }
}

TEST_CASE("render: a plane that faces the light is brighter than one that turns away") {
    const View view = look_down(4, 80, 80, 80);
    const auto lit = [&](const glm::vec3& normal, const Style& style) {
        RenderMesh mesh = make_square();
        mesh.normals.assign(4, glm::normalize(normal));
        return brightness(render(mesh, view, style), 40, 30);
    };
    const glm::vec3 left(Style{}.key_light), right(0.6f, -0.5f, 0.5f);
    const int straight = lit({0, 0, 1}, {});
    CHECK(lit(left, {}) > straight + 20);
    CHECK(straight > lit(right, {}) + 20);
    Style other;
    other.key_light = right;
    CHECK(lit(right, other) > lit(left, other) + 20);
}

TEST_CASE("render: lines are drawn along projected edges and nowhere else") {
    const RenderMesh mesh = make_row(4);
    const View view = look_down(4, 400, 160, 160);  // 80 pixels per quad, from x = 40; rows 40 to 120
    const Image plain = one_view(mesh, view, PictureView::shaded, as_seen(view)).image;
    PictureOptions options = as_seen(view);
    options.line_width = 2;
    const Image lines = one_view(mesh, view, PictureView::wireframe, options).image;
    for (int y = 40; y < 120; ++y)
        for (int x = 40; x < 360; ++x) {
            const double in_quad = std::fmod(x + 0.5 - 40, 80.0), row = y + 0.5 - 40;
            const double to_side = std::min({in_quad, 80 - in_quad, row, 80 - row});
            const double to_edge = std::min(to_side, std::abs(in_quad + row - 80) / std::sqrt(2.0));
            CAPTURE(x, y);
            if (to_edge < 0.6)
                REQUIRE(brightness(lines, x, y) + 100 < brightness(plain, x, y));
            if (to_edge > 2.5)
                REQUIRE(lines.at(x, y) == plain.at(x, y));
        }
    options.line_width = 8;
    const Image wide = one_view(mesh, view, PictureView::wireframe, options).image;
    CHECK(brightness(wide, 123, 60) + 100 < brightness(plain, 123, 60));
    CHECK(lines.at(123, 60) == plain.at(123, 60));
}

TEST_CASE("render: triangles smaller than lines give an even tone") {
    // 2.3 pixels per quad: full lines would cause moire with the pixels.
    RenderMesh mesh;
    constexpr std::uint32_t side = 80;
    for (std::uint32_t y = 0; y <= side; ++y)
        for (std::uint32_t x = 0; x <= side; ++x)
            mesh.positions.emplace_back(2.0 * x / side - 1, 2.0 * y / side - 1, 0);
    mesh.normals.assign(mesh.positions.size(), {0, 0, 1});
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            const std::uint32_t first = y * (side + 1) + x;
            add_quad(mesh, first, first + 1, first + side + 2, first + side + 1);
        }
    const View view = look_down(4, 224, 224, 2.3 * side * 2);
    const Image plain = one_view(mesh, view, PictureView::shaded, as_seen(view)).image;
    const Image lines = one_view(mesh, view, PictureView::wireframe, as_seen(view)).image;
    double least = 1e9, most = 0;
    for (int top = 32; top < 184; top += 8)
        for (int left = 32; left < 184; left += 8) {
            double sum = 0;
            for (int y = top; y < top + 8; ++y)
                for (int x = left; x < left + 8; ++x)
                    sum += 1.0 * brightness(lines, x, y) / brightness(plain, x, y);
            least = std::min(least, sum / 64);
            most = std::max(most, sum / 64);
        }
    CHECK(most - least < 0.03);
    CHECK(most < 0.95);   // the lines are visible
    CHECK(least > 0.75);  // and nothing is black
}

TEST_CASE("render: each view has its colours at the right triangles") {
    const RenderMesh mesh = stopped_row();
    const View view = look_down(8, 500, 140, 320);  // 80 pixels per quad from x = 50, rows 30 to 110
    const auto at_quad = [&](const Image& image, int quad) {
        return image.at(50 + 80 * quad + 20, 70 + 12);  // clear of lines
    };
    PictureOptions options = as_seen(view);
    options.height = 0;  // the legend is added to the height
    SECTION("stopped") {
        const Image image = one_view(mesh, view, PictureView::stopped, options).image;
        std::array<Colour, stops> paints;
        for (unsigned s = 0; s < stops; ++s)
            paints[s] = stop_colour(static_cast<Stop>(s));
        for (int quad = 0; quad < 5; ++quad) {
            CAPTURE(quad);
            CHECK(nearest_hue(at_quad(image, quad), paints) == static_cast<std::size_t>(quad));
        }
        for (const Colour& paint : paints)
            CHECK(has_colour(image, paint, 120));
    }
    SECTION("test") {
        const Image image = one_view(mesh, view, PictureView::test, options).image;
        std::array<Colour, 4> paints;
        for (unsigned t = 0; t < 4; ++t)
            paints[t] = deciding_test_colour(static_cast<DecidingTest>(t));
        for (int quad = 0; quad < 5; ++quad) {  // of add_quad: upper left one due to the Normal Test, lower right base
            CHECK(nearest_hue(at_quad(image, quad), paints) == 1);
            CHECK(nearest_hue(image.at(50 + 80 * quad + 60, 70 + 12), paints) == 0);
        }
        for (const Colour& paint : paints)
            CHECK(has_colour(image, paint, 120));
    }
    SECTION("generation") {
        RenderMesh generations = mesh;
        for (std::size_t i = 0; i < generations.triangles.size(); ++i)
            generations.triangles[i].generation = static_cast<std::uint8_t>(i / 2 * 3);
        const Image image = one_view(generations, view, PictureView::generation, options).image;
        std::array<Colour, 5> paints;
        for (unsigned g = 0; g < 5; ++g)
            paints[g] = generation_colour(3 * g);
        for (int quad = 0; quad < 5; ++quad) {
            CAPTURE(quad);
            CHECK(nearest_hue(at_quad(image, quad), paints) == static_cast<std::size_t>(quad));
        }
        CHECK(generation_colour(255) == generation_colour(12));
        CHECK(has_colour(image, generation_colour(12), 120));
        CHECK_FALSE(has_colour(one_view(mesh, view, PictureView::generation, options).image, generation_colour(12),
                               120));  // the legend omits what the mesh lacks
    }
    SECTION("shaded and wireframe have none") {
        for (const PictureView plain : {PictureView::shaded, PictureView::wireframe}) {
            const Image image = one_view(mesh, view, plain, options).image;
            const std::array<Colour, 3> paints{Style{}.surface, stop_colour(Stop::view), stop_colour(Stop::generation)};
            for (int quad = 0; quad < 5; ++quad)
                CHECK(nearest_hue(at_quad(image, quad), paints) == 0);
            CHECK(image.height == 150);  // 0.3 of the width, with no space for a legend
        }
    }
}

TEST_CASE("render: errors of triangles and of vertices get the ramp's colours") {
    RenderMesh mesh = make_row(3);
    const View view = look_down(8, 400, 160, 320);  // 80 pixels per quad from x = 80
    PictureOptions options = as_seen(view);
    options.errors = {0.5, 0, 0.1};
    std::array<Colour, 3> paints{error_colour(0), error_colour(0.5), error_colour(1)};
    options.height = 0;
    SECTION("known") {
        mesh.triangle_errors = {0, 0, 0.25f, 0.25f, 0.5f, 7};
        const Image image = one_view(mesh, view, PictureView::error, options).image;
        for (int quad = 0; quad < 3; ++quad)
            for (const int x : {10, 40, 70})
                CHECK(nearest_hue(image.at(80 + 80 * quad + x, 60), paints) == static_cast<std::size_t>(quad));
        CHECK(has_colour(image, error_colour(1), 120));
    }
    SECTION("unknown: drawn as no error") {
        CHECK(nearest_hue(one_view(mesh, view, PictureView::error, options).image.at(200, 60), paints) == 0);
        options.errors = {};
        CHECK(nearest_hue(one_view(mesh, view, PictureView::error, options).image.at(200, 60), paints) == 0);
    }
}

TEST_CASE("render: the error ramp falls in lightness all the way") {
    double last = 2;
    for (int i = 0; i <= 64; ++i) {
        const glm::dvec3 linear = to_linear(error_colour(i / 64.0));
        const double lightness = 0.2126 * linear.x + 0.7152 * linear.y + 0.0722 * linear.z;
        CHECK(lightness < last);
        last = lightness;
    }
    CHECK(error_colour(-1) == error_colour(0));
    CHECK(error_colour(2) == error_colour(1));
}

TEST_CASE("render: a legend names the meaning of its colours") {
    RenderMesh mesh = make_row(5);
    mesh.base_triangles = 4;
    const auto legend_of = [&](PictureView view, const ErrorScale& errors = {}) {
        Style style = style_of(view);
        style.errors = errors;
        const Legend legend = make_legend(mesh, style);
        std::vector<std::string> labels;
        for (const Legend::Entry& entry : legend.entries)
            labels.push_back(entry.label);
        return std::pair(legend.title, labels);
    };
    using Words = std::vector<std::string>;
    CHECK(legend_of(PictureView::generation) ==
          std::pair<std::string, Words>("10 triangles from 4, by generation", {"0", "1"}));
    mesh.base_triangles = 0;
    mesh.triangles[0].generation = 12;
    CHECK(legend_of(PictureView::generation).first == "10 triangles, by generation");
    CHECK(legend_of(PictureView::generation).second.back() == "12");
    mesh.triangles[0].generation = 40;  // it has the colour of 12
    CHECK(legend_of(PictureView::generation).second.size() == 13);
    CHECK(legend_of(PictureView::generation).second.back() == "12+");

    CHECK(legend_of(PictureView::test).second == Words{"normal", "summed height", "both", "none: base"});
    mesh.triangles[0].deciding_test = DecidingTest::highlight;
    CHECK(legend_of(PictureView::test).second == Words{"normal", "summed height", "both", "highlight", "none: base"});
    CHECK(legend_of(PictureView::stopped).second == Words{"no test", "view", "tex coord", "generation", "several"});

    const auto [title, labels] = legend_of(PictureView::error, {0.08, 0.3, 0.016});
    CHECK(title == "error, model units, largest 0.3 (one texel: 0.016)");
    CHECK(labels == Words{"0", "0.01", "0.02", "0.03", "0.04", "0.05", "0.06", "0.07", "0.08"});
    CHECK(legend_of(PictureView::error, {0.08, 0.08, 0}).first == "error, model units");
    for (const PictureView none : {PictureView::shaded, PictureView::wireframe})
        CHECK(legend_of(none).second.empty());
}

TEST_CASE("render: the error of most of a mesh ignores a small part") {
    RenderMesh mesh = make_row(100);
    mesh.triangle_errors.assign(200, 0.1f);
    mesh.triangle_errors[17] = 5;
    CHECK(error_of_most(mesh, 0.99) == Approx(0.1));
    CHECK(error_of_most(mesh, 1) == Approx(5));
    CHECK(largest_of(mesh.triangle_errors) == Approx(5));
    CHECK(error_of_most(RenderMesh{}, 0.99) == 0);
    mesh.positions.assign(mesh.positions.size(), glm::vec3(0));
    CHECK(error_of_most(mesh, 0.99) == Approx(5));
}

TEST_CASE("render: a zoom enlarges around the given point") {
    const RenderMesh mesh = make_square();  // from 20 to 100 in both axes
    const View view = look_down(4, 120, 120, 160);
    PictureOptions options = as_seen(view);
    options.zoom = {100 / 120.0, 20 / 120.0, 6};  // the upper right corner moves to the middle
    const Image image = one_view(mesh, view, PictureView::shaded, options).image;
    CHECK(image.at(57, 63) != Style{}.background);
    CHECK(image.at(3, 117) != Style{}.background);
    CHECK(image.at(63, 63) == Style{}.background);
    CHECK(image.at(57, 57) == Style{}.background);
    CHECK(image.at(117, 3) == Style{}.background);
    const View close = zoomed(view, 0.25, 0.5, 3);
    const glm::dvec3 before = view.project({-0.3, 0.2, 0});
    const glm::dvec3 after = close.project({-0.3, 0.2, 0});
    CHECK(after.x / after.z == Approx(60 + (before.x / before.z - 30) * 3));
    CHECK(after.y / after.z == Approx(60 + (before.y / before.z - 60) * 3));
    const View same = zoomed(view, 0.5, 0.5, 1);
    CHECK(same.focal == view.focal);
    CHECK(same.centre == view.centre);
}

TEST_CASE("render: a view is the same alone and with others") {
    RenderMesh mesh = stopped_row();
    mesh.triangle_errors.assign(mesh.triangles.size(), 0.3f);
    const View view = look_down(8, 200, 90, 120);
    PictureOptions options;
    options.width = 200;
    options.height = 130;
    options.errors = {0.5, 0.7, 0.1};
    const std::vector<PictureView> all(std::begin(picture_views), std::end(picture_views));
    const std::vector<Picture> together = render_views(mesh, view, all, options);
    REQUIRE(together.size() == all.size());
    std::set<std::vector<std::uint8_t>> different;
    for (std::size_t i = 0; i < all.size(); ++i) {
        CAPTURE(name_of(all[i]));
        const Picture alone = one_view(mesh, view, all[i], options);
        CHECK(alone.image.bytes == together[i].image.bytes);
        CHECK(alone.image.width == 200);
        CHECK(alone.image.height == 130);
        CHECK(alone.mesh_in_sight);
        different.insert(alone.image.bytes);
    }
    CHECK(different.size() == all.size());
}

TEST_CASE("render: the legend is a strip below the surface, and fits") {
    RenderMesh mesh = stopped_row();
    mesh.triangles[0].deciding_test = DecidingTest::highlight;
    mesh.triangles[0].generation = 40;
    const View view = look_down(8, 400, 112, 256);
    PictureOptions options;
    options.errors = {1e-7, 123456, 1.5e-8};  // long labels
    for (const int width : {100, 400, 1000})
        for (const PictureView each : picture_views) {
            CAPTURE(width, name_of(each));
            options.width = width;
            options.height = 0;
            const Image image = one_view(mesh, view, each, options).image;
            CHECK(image.height == picture_height(mesh, view, each, options));
            const bool plain = each == PictureView::shaded || each == PictureView::wireframe;
            const int panel_width = each == PictureView::overview ? width / 2 : width;
            Style style = style_of(each == PictureView::overview ? PictureView::generation : each);
            style.errors = options.errors;
            const int strip = legend_height(make_legend(mesh, style), panel_width, width, 1000);
            CHECK((strip == 0) == plain);
            if (plain)
                continue;
            const int top = image.height - strip;
            for (int y = top; y < image.height; ++y) {  // nothing is cut off
                CHECK(image.at(0, y) == style.background);
                CHECK(image.at(width - 1, y) == style.background);
            }
            for (int x = 0; x < width; ++x) {
                CHECK(image.at(x, top) == style.background);
                CHECK(image.at(x, image.height - 1) == style.background);
            }
            if (width == 1000)
                CHECK(has_colour(image, legend_ink, top));
            options.height = 300;
            CHECK(one_view(mesh, view, each, options).image.height == 300);
        }
}

TEST_CASE("render: the overview shows the shaded surface and its triangles by generation") {
    const RenderMesh mesh = stopped_row();
    const View view = look_down(8, 400, 112, 256);
    PictureOptions options;
    options.width = 400;
    const Image both = one_view(mesh, view, PictureView::overview, options).image;
    options.width = 200;
    options.height = 0;
    const int strip = legend_height(make_legend(mesh, style_of(PictureView::generation)), 200, 400, 1000);
    options.height = both.height - strip;
    const Image shaded = one_view(mesh, view, PictureView::shaded, options).image;
    const auto panel = [&](int left) {
        Image image(200, both.height - strip, {});
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < 200; ++x)
                image.set(x, y, both.at(left + x, y));
        return image;
    };
    CHECK(panel(0).bytes == shaded.bytes);
    const Image triangles = panel(200);
    CHECK(has_colour(triangles, Style{}.background, 0));
    CHECK(triangles.bytes != shaded.bytes);
    std::set<std::size_t> seen;
    const std::array<Colour, 3> paints{generation_colour(0), generation_colour(1), Style{}.surface};
    for (int x = 30; x < 170; x += 3)
        seen.insert(nearest_hue(triangles.at(x, triangles.height / 2 + 3), paints));
    CHECK(seen.count(0) == 1);
}

TEST_CASE("render: small and odd sizes are drawn without an error") {
    const View view = look_down(8, 320, 200, 200);
    for (const int width : {1, 2, 17, least_picture_side})
        for (const int height : {1, 2, 17, least_picture_side}) {
            CAPTURE(width, height);
            PictureOptions options;
            options.width = width;
            options.height = height;
            options.errors = {1, 2, 3};
            for (const PictureView each : picture_views) {
                const Image image = one_view(stopped_row(), view, each, options).image;
                CHECK(image.width == width);
                CHECK(image.height == height);
            }
        }
}

TEST_CASE("render: a mesh looks the same from very far away as from near") {
    const RenderMesh mesh = make_sphere({0, 0, 0}, 96);
    // In single precision the whole mesh would be only a few steps deep.
    const View near = look_down(1e3, 100, 100, 40 * 1e3);
    const View far = look_down(1e7, 100, 100, 40 * 1e7);
    const Image a = render(mesh, near, Style{});
    const Image b = render(mesh, far, Style{});
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x) {
            CAPTURE(x, y);
            REQUIRE(std::abs(brightness(a, x, y) - brightness(b, x, y)) < 60);
        }
}
