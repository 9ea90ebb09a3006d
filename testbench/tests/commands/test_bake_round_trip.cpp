#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "testbench/run_folder/ply_reader.h"
#include "testbench/tests/support/program_runner.h"

using namespace tessera;
namespace fs = std::filesystem;

namespace {

/// Runs a job in functional mode, with all checks, and returns its mesh.
RecordedMesh mesh_of_run(const std::string& job, const Arguments& settings, const fs::path& here) {
    succeed(Arguments{"run", job} +
                set({"mode=functional", "output.picture=false", "output.obj=false", "output.folder=run"}) +
                set(settings),
            here);
    return read_ply(here / "run/mesh.ply");
}

std::uint64_t invariant(const fs::path& here, const char* name) {
    const auto conformance = nlohmann::json::parse(read_all(here / "run/conformance.json"));
    return conformance.at("invariants").at(name).at("value").get<std::uint64_t>();
}

/// A square of the plane whose corners are the centres of the corner texels of a map of 129 x 129 over -1..1. Inserted
/// vertices lie on texel centres, down to seven generations, and read the surface's height at their own position.
const std::string centred_square = [] {
    const double end = 128 / 129.0, low = 0.5 / 129, high = 128.5 / 129;
    std::string text;
    for (const double y : {-end, end})
        for (const double x : {-end, end})
            text += fmt::format("v {} {} 0\n", x, y);
    for (const double v : {low, high})
        for (const double u : {low, high})
            text += fmt::format("vt {} {}\n", u, v);
    return text + "vn 0 0 1\nf 1/1/1 2/2/1 4/4/1\nf 1/1/1 4/4/1 3/3/1\n";
}();

/// Bakes 129 x 129 texels, runs them on the square, and requires that every vertex is within half a step of `range`
/// quantised to 16 bits.
void check_round_trip(const std::string& surface, const std::string& map, double range,
                      const std::function<double(double, double)>& height) {
    const TestFolder here;
    write_all(here.path() / "surface.toml", surface);
    write_all(here.path() / "square.obj", centred_square);
    succeed({"bake", "surface.toml", "--size", "129x129", "--output", map}, here.path());
    const RecordedMesh mesh = mesh_of_run(map.substr(0, map.find('.')) + ".job.toml",
                                          {"mesh.source=file", "mesh.file=square.obj", "tests.generation_limit=7",
                                           "tests.view=false", "tests.normal_threshold=0.02"},
                                          here.path());
    CHECK(mesh.triangles.size() > 1500);
    // Positions have some 28 fraction bits here; the rounding of seven midpoints is far below 1e-7.
    const double bound = 0.5 * range / 65535 + 1e-7;
    double worst = 0;
    for (const glm::dvec3& p : mesh.positions)
        worst = std::max(worst, std::abs(p.z - height(p.x, p.y)));
    CHECK(worst <= bound);
    CHECK(worst > 0.2 * bound);  // the map is quantised
}

}  // namespace

TEST_CASE("round trip: a baked paraboloid's vertices lie on the paraboloid") {
    const auto paraboloid = [](double x, double y) { return 0.6 - 0.5 * (x * x + y * y / 4); };
    const double end = 128 / 129.0;
    for (const std::string map : {"map.pgm", "map.png", "map.exr"}) {
        INFO(map);
        check_round_trip("[quadric]\nshape = \"paraboloid\"\ncentre = [0, 0, 0.6]\nsemi_axes = [1, 2, 0.5]\n", map,
                         paraboloid(0, 0) - paraboloid(end, end), paraboloid);
    }
}

TEST_CASE("round trip: a baked sphere cap's vertices lie on the sphere") {
    const auto sphere = [](double x, double y) { return std::sqrt(2.25 - x * x - y * y) - 1; };
    const double end = 128 / 129.0;
    check_round_trip("[quadric]\nshape = \"sphere\"\ncentre = [0, 0, -1]\nradius = 1.5\n", "cap.pgm",
                     sphere(0, 0) - sphere(end, end), sphere);
}

TEST_CASE("round trip: a baked Bezier patch's vertices lie on the patch") {
    const auto patch = [](double x, double y) {  // h = 2 u (1 - u) v
        const double u = (x + 1) / 2, v = (y + 1) / 2;
        return 2 * u * (1 - u) * v;
    };
    check_round_trip("[bezier]\nheights = [[0, 0, 0], [0, 1, 0]]\n", "patch.pgm", 0.5, patch);
}

TEST_CASE("round trip: on the default plane a vertex lies on the dome at the texel it reads") {
    const TestFolder here;
    succeed({"bake", (source_folder() / "testbench/examples/surfaces/dome.toml").string(), "--output", "dome.pgm"},
            here.path());
    const RecordedMesh mesh = mesh_of_run("dome.job.toml", {}, here.path());
    CHECK(mesh.triangles.size() > 1000);
    const auto centre = [](double t) {  // the position, in the plane -1..1, of the centre of the texel that t reads
        return (std::min(255.0, std::floor(256 * t)) + 0.5) / 128 - 1;
    };
    double worst = 0, highest = 0;
    for (std::size_t k = 0; k < mesh.positions.size(); ++k) {
        const double x = centre(mesh.textures[k].x), y = centre(mesh.textures[k].y);
        const double square = 1 - x * x - y * y;
        const double height = square > 0 ? std::max(0.0, std::sqrt(square) - 0.25) : 0.0;
        worst = std::max(worst, std::abs(mesh.positions[k].z - height));
        highest = std::max(highest, mesh.positions[k].z);
    }
    CHECK(worst <= 0.5 * 0.75 / 65535 + 1e-7);
    CHECK(highest > 0.74);
}

TEST_CASE("round trip: a cylinder baked to a sphere closes at its seam, and only if the map repeats") {
    const TestFolder here;
    const fs::path examples = source_folder() / "testbench/examples/surfaces";
    // Off the axis, so that the two sides of the seam do not mirror each other.
    write_all(here.path() / "ball.toml", "[quadric]\nshape = \"sphere\"\nradius = 1.4\ncentre = [0.25, 0.1, 0.05]\n");
    const std::string out = succeed({"bake", "ball.toml", "--mesh", (examples / "barrel_base.toml").string(), "--size",
                                     "512x256", "--output", "ball.pgm"},
                                    here.path())
                                .out;
    CHECK(out.find("note") == std::string::npos);
    const RecordedMesh mesh = mesh_of_run("ball.job.toml", {}, here.path());
    CHECK(invariant(here.path(), "open_texture_seam_edges") == 0);
    CHECK(invariant(here.path(), "border_base_edges") == 60);
    CHECK(invariant(here.path(), "cracks") == 0);
    CHECK(mesh.triangles.size() > 2000);
    // A vertex reads the texel that contains it, whose centre is up to half a texel away: 0.0062 around and 0.0039
    // along the axis, times the slope, at most 0.3 around and 1.4 along.
    double worst = 0, mean = 0;
    for (const glm::dvec3& p : mesh.positions) {
        const double off = glm::length(p - glm::dvec3(0.25, 0.1, 0.05)) - 1.4;
        worst = std::max(worst, std::abs(off));
        mean += off / static_cast<double>(mesh.positions.size());
    }
    CHECK(worst < 0.0039 * 1.4 + 0.0062 * 0.3);
    CHECK(std::abs(mean) < 0.2 * worst);
    mesh_of_run("ball.job.toml", {"map.address_u=clamp"}, here.path());
    CHECK(invariant(here.path(), "open_texture_seam_edges") > 0);
}
