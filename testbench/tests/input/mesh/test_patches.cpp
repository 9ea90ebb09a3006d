#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "testbench/common/error.h"
#include "testbench/input/mesh/bezier_patches.h"
#include "testbench/input/mesh/make_base_mesh.h"
#include "testbench/input/mesh/mesh_limits.h"
#include "testbench/input/mesh/obj_reader.h"
#include "testbench/tests/input/mesh/mesh_checks.h"
#include "testbench/tests/support/refusals.h"
#include "testbench/tests/support/shared_data.h"
#include "testbench/tests/support/source_folder.h"

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const fs::path teapot_file = source_folder() / "testbench/examples/jobs/teapot_newell.txt";

BezierPatches teapot() {
    return read_bezier_patches(teapot_file.string());
}

/// One patch with control points at(i, j), i along u.
template <class At>
BezierPatches one_patch(At at) {
    BezierPatches patches;
    patches.patches.emplace_back();
    for (std::uint32_t k = 0; k < 16; ++k) {
        patches.patches.front()[k] = k;
        patches.points.push_back(at(static_cast<int>(k % 4), static_cast<int>(k / 4)));
    }
    return patches;
}

/// In Newell's format.
std::string text_of(const BezierPatches& patches) {
    std::string text = fmt::format("{}\n", patches.patches.size());
    for (const auto& patch : patches.patches)
        for (std::size_t k = 0; k < 16; ++k)
            text += fmt::format("{}{}", patch[k] + 1, k < 15 ? "," : "\n");
    text += fmt::format("{}\n", patches.points.size());
    for (const glm::dvec3& p : patches.points)
        text += fmt::format("{},{},{}\n", p.x, p.y, p.z);
    return text;
}

double largest_of(const glm::dvec3& a) {
    return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
}

/// The text with one line, counted from 1, replaced.
std::string with_line(std::string text, int number, const std::string& line) {
    std::size_t at = 0;
    for (int k = 1; k < number; ++k)
        at = text.find('\n', at) + 1;
    return text.replace(at, text.find('\n', at) - at, line);
}

std::string parse_error(const std::string& text) {
    try {
        parse_bezier_patches(text, "p.txt");
    } catch (const InputError& error) {
        return error.what();
    } catch (const ResourceError& error) {
        return std::string("limit: ") + error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("patches: the teapot has 32 patches and 992 triangles, closed except for its own openings") {
    const BezierPatches patches = teapot();
    CHECK(patches.patches.size() == 32);
    CHECK(patches.points.size() == 306);
    Job::Mesh job;
    job.source = MeshSource::patches;
    const BaseMesh mesh = make_base_mesh(job, teapot_file.string());
    require_complete(mesh);
    CHECK(mesh.triangles.size() == 992);
    CHECK(mesh.dropped_degenerate == 32);
    CHECK_THAT(mesh.repairs.front(), Contains("32 triangle(s) of zero area"));
    const EdgeCounts edges = count_edges(mesh);
    CHECK(edges.odd == 0);
    // The rims of the body and the lid have 16 edges each, the two ends of spout and handle 8 each.
    CHECK(edges.border == 64);
    for (const BaseVertex& v : mesh.vertices)
        if (v.position.x == 0 && v.position.y == 0)
            CHECK(largest_of(v.normal - glm::dvec3(0, 0, v.position.z > 1 ? 1 : -1)) < 1e-15);
}

TEST_CASE("patches: the teapot equals that of the shared data") {
    const fs::path file = shared_data("meshes/teapot_n4.obj");
    if (file.empty())
        return;
    const BaseMesh expected = read_obj(file.string()), mesh = make_patch_mesh(teapot(), 4, 4, "teapot");
    REQUIRE(mesh.vertices.size() == expected.vertices.size());
    CHECK(mesh.triangles == expected.triangles);
    double position = 0, normal = 0, tangent = 0;
    std::size_t texture = 0, handedness = 0;
    for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
        const BaseVertex &a = mesh.vertices[k], &b = expected.vertices[k];
        position = std::max(position, largest_of(a.position - b.position));
        normal = std::max(normal, largest_of(a.normal - b.normal));
        texture += a.texture != b.texture;
        // At poles, where directions of dp/du cancel, rounding decides.
        const bool pole = b.position.x == 0 && b.position.y == 0;
        tangent = std::max(tangent, pole ? 0 : largest_of(a.tangent - b.tangent));
        handedness += !pole && a.handedness != b.handedness;
    }
    CHECK(position < 0.6e-6);  // the file has six decimals
    CHECK(normal < 1.1e-6);
    CHECK(tangent < 1e-5);
    CHECK(texture == 0);
    CHECK(handedness == 0);
}

TEST_CASE("patches: a bilinear patch is evaluated exactly, and more finely on request") {
    const BezierPatches patches = one_patch([](int i, int j) { return glm::dvec3(3 * i, 6 * j, i * j); });
    const BaseMesh mesh = make_patch_mesh(patches, 2, 8, "p");
    require_complete(mesh);
    CHECK(mesh.triangles.size() == 32);
    for (const BaseVertex& v : mesh.vertices) {
        const double u = v.texture.x, w = v.texture.y;
        CHECK(largest_of(v.position - glm::dvec3(9 * u, 18 * w, 9 * u * w)) < 1e-14);
        const glm::dvec3 n = glm::normalize(glm::cross(glm::dvec3(9, 0, 9 * w), glm::dvec3(0, 18, 9 * u)));
        CHECK(largest_of(v.normal - n) < 1e-15);
    }
}

TEST_CASE("patches: a patch agrees with Bernstein's polynomials") {
    const BezierPatches patches = one_patch(
        [](int i, int j) { return glm::dvec3(i + 0.3 * j * j, j - 0.2 * i * j, 0.5 * i * i - 0.7 * j * (i - 1)); });
    const auto bernstein = [](double t) {
        const double s = 1 - t;
        return std::array<double, 4>{s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
    };
    const auto slope = [](double t) {
        const double s = 1 - t;
        return std::array<double, 4>{-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t};
    };
    const auto sum = [&](const std::array<double, 4>& u, const std::array<double, 4>& v) {
        glm::dvec3 p(0);
        for (std::size_t k = 0; k < 16; ++k) {
            p += u[k % 4] * v[k / 4] * patches.points[k];
        }
        return p;
    };
    for (const BaseVertex& v : make_patch_mesh(patches, 7, 5, "p").vertices) {
        const double s = v.texture.x, t = v.texture.y;
        CHECK(largest_of(v.position - sum(bernstein(s), bernstein(t))) < 1e-14);
        const glm::dvec3 n = glm::cross(sum(slope(s), bernstein(t)), sum(bernstein(s), slope(t)));
        CHECK(largest_of(v.normal - glm::normalize(n)) < 1e-13);
    }
}

TEST_CASE("patches: a border shared in reverse, or by another side, is bit-identical") {
    // Awkward numbers; the second patch meets border u = 1 of the first with its border v = 0, reversed.
    const auto at = [](int i, int j) {
        return glm::dvec3(0.1 * i + 0.07 * j, 0.3 * j + 0.01 * i * i, 0.123 * i * j - 0.37 * i + 1 / 3.0);
    };
    BezierPatches patches = one_patch(at);
    patches.patches.emplace_back();
    for (std::uint32_t k = 0; k < 16; ++k) {
        if (k < 4) {
            patches.patches[1][k] = 4 * (3 - k) + 3;
        } else {
            patches.patches[1][k] = static_cast<std::uint32_t>(patches.points.size());
            patches.points.push_back(at(3 + static_cast<int>(k / 4), 3 - static_cast<int>(k % 4)));
        }
    }
    for (const std::int64_t quads : {1, 3, 7, 10, 31}) {
        INFO(quads);
        const EdgeCounts edges = count_edges(make_patch_mesh(patches, quads, quads, "p"));
        CHECK(edges.border == static_cast<std::size_t>(6 * quads));
    }
}

TEST_CASE("patches: a collapsed border at any of the four sides has the limit's normal") {
    // A quarter of a disk-like fan in the plane z = 2, with the apex at the collapsed side.
    for (const int side : {0, 1, 2, 3}) {
        INFO(side);
        const BezierPatches patches = one_patch([side](int i, int j) {
            const int along = side % 2 == 0 ? i : j, across = side % 2 == 0 ? j : i;
            const int from = side < 2 ? across : 3 - across;
            return glm::dvec3(from * (3 - along), from * along, 2);
        });
        const BaseMesh mesh = make_patch_mesh(patches, 4, 4, "p");
        require_complete(mesh);
        CHECK(mesh.triangles.size() == 28);
        CHECK(mesh.dropped_degenerate == 4);
        CHECK(mesh.repairs.size() <= 2);  // about the triangles, and perhaps a pole
        const double up = mesh.vertices.back().normal.z;
        CHECK(std::abs(up) == 1);
        for (const BaseVertex& v : mesh.vertices)
            CHECK(v.normal == glm::dvec3(0, 0, up));
    }
}

TEST_CASE("patches: a cusp gets a smooth normal, with a repair") {
    // Two rows of control points collapsed: both derivatives vanish there.
    const BezierPatches patches =
        one_patch([](int i, int j) { return j < 2 ? glm::dvec3(0) : glm::dvec3(i, j, 0.1 * i * j); });
    const BaseMesh mesh = make_patch_mesh(patches, 4, 4, "p");
    require_complete(mesh);
    CHECK_THAT(mesh.repairs.at(1), Contains("4 vertices at cusps"));
}

TEST_CASE("patches: patches that give no mesh are refused") {
    const BezierPatches point = one_patch([](int, int) { return glm::dvec3(1, 2, 3); });
    CHECK_THROWS_WITH(make_patch_mesh(point, 4, 4, "p.txt"), Contains("p.txt: no triangle is left"));
    const BezierPatches line = one_patch([](int i, int j) { return glm::dvec3(i + j); });
    CHECK_THROWS_AS(make_patch_mesh(line, 4, 4, "p.txt"), InputError);
    CHECK_THROWS_WITH(make_patch_mesh(teapot(), 4097, 4, "p.txt"), Contains("mesh.columns = 4097"));
    CHECK_THROWS_WITH(make_patch_mesh(teapot(), 4, 0, "p.txt"),
                      Contains("mesh.rows = 0: must be 1 to 4096 for a patch mesh"));
    CHECK_NOTHROW(make_patch_mesh(teapot(), 4, 1, "p.txt"));
    CHECK_THROWS_AS(make_patch_mesh(teapot(), 2048, 2048, "p.txt"), ResourceError);
    Job::Mesh job;
    job.source = MeshSource::patches;
    CHECK_THROWS_WITH(make_base_mesh(job, ""), Contains("mesh.file is empty"));
    CHECK_THROWS_WITH(make_base_mesh(job, "nowhere.txt"), Contains("nowhere.txt: no such file") && Contains("Bezier"));
    CHECK_THROWS_WITH(make_base_mesh(job, "."), Contains("not a regular file"));
}

TEST_CASE("patches: text with other line ends, spaces and number forms loads") {
    const BezierPatches patches = one_patch([](int i, int j) { return glm::dvec3(i, j, i * j); });
    const std::string text = text_of(patches);
    CHECK(parse_error(text).empty());
    CHECK(parse_bezier_patches(text, "p").points == patches.points);
    CHECK(parse_bezier_patches(text, "p").patches == patches.patches);
    std::string windows;
    for (const char c : text)
        windows += c == '\n' ? "\r\n\r\n" : c == ',' ? " ,\t" : std::string(1, c);
    CHECK(parse_bezier_patches(windows, "p").points == patches.points);
    CHECK(parse_error(text.substr(0, text.size() - 1)).empty());
    CHECK(parse_error(with_line(text, 5, "1e-3,+2.5,.5")).empty());
}

TEST_CASE("patches: hostile text ends in one message with its line") {
    const std::string text = text_of(one_patch([](int i, int j) { return glm::dvec3(i, j, i * j); }));
    const std::string row = "1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,";
    expect_refusals(
        {
            {"", {"p.txt:0: the file ends before the number of patches"}},
            {"\n \n", {"the file ends before the number of patches"}},
            {"0\n", {"p.txt:1: '0'"}},
            {"-3\n", {"p.txt:1: '-3'"}},
            {"1.5\n", {"'1.5'"}},
            {"nan\n", {"'nan'"}},
            {"v 1 2 3\n", {"'v 1 2 3'"}},
            {std::string("\0\0\0", 3), {"\\x00"}},
            {"99999999999999999999\n", {"limit: p.txt:1:", "4000000"}},
            {"inf\n", {"limit: p.txt:1:"}},
            {"4000000\n", {"before patch 1 of 4000000"}},
            {with_line(text, 3, "17000000"), {"limit: p.txt:3:", "16000000"}},
            {with_line(text, 3, "4"), {"p.txt:8:", "after the last of 4 points"}},
            {with_line(text, 3, "17"), {"before point 17 of 17"}},
            {with_line(text, 2, row + "17"), {"p.txt:2: patch 1 names point 17, but the file has 16"}},
            {with_line(text, 2, "1,2,3"), {"p.txt:2: patch 1 of 1", "3 number(s)"}},
            {with_line(text, 2, row + "16,1"), {"17 number(s)"}},
        },
        parse_error);
    for (const std::string last : {"0", "-1", "1.5", "x", "", "1e300", "nan"}) {
        INFO(last);
        CHECK_THAT(parse_error(with_line(text, 2, row + last)), Contains("p.txt:2:") && Contains("'" + last + "'"));
    }
    for (const std::string point : {"1,2", "1,2,3,4", "1 2 3"})
        CHECK_THAT(parse_error(with_line(text, 7, point)), Contains("p.txt:7: point 4 of 16"));
    for (const std::string bad : {"nan", "inf", "1e39", "1e999", "one", "", "0x10", "1.2.3"}) {
        INFO(bad);
        CHECK_THAT(parse_error(with_line(text, 7, "1," + bad + ",3")), Contains("p.txt:7: '" + bad + "'"));
    }
    // Truncated anywhere it is refused, except within the last digits of its last number.
    const std::size_t whole = text.find_last_of(',') + 1;
    for (std::size_t size = 0; size < whole; ++size) {
        INFO(size);
        CHECK_FALSE(parse_error(text.substr(0, size)).empty());
    }
}
