#include <catch2/catch.hpp>
#include <filesystem>

#include "testbench/common/atomic_file.h"
#include "testbench/common/error.h"
#include "testbench/job/dump_job.h"
#include "testbench/output/report/ply_writer.h"
#include "testbench/run_folder/ply_reader.h"
#include "testbench/run_folder/read_run.h"
#include "testbench/tests/support/test_folder.h"
#include "testbench/tests/support/text.h"

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

/// Two triangles with a common edge, and one that was culled.
EmittedMesh small_mesh() {
    EmittedMesh mesh;
    const auto corner = [](std::int32_t x, std::int32_t y, std::uint8_t generation) {
        EmittedTriangle::Corner c;
        c.position = {x, y, 0};
        c.displaced = {x, y, x + 2 * y};
        c.displaced_normal = {0, x, 16384};
        c.texture = {static_cast<std::uint32_t>(4096 * x), static_cast<std::uint32_t>(4096 * y)};
        c.generation = generation;
        return c;
    };
    EmittedTriangle a, b;
    a.corners = {corner(0, 0, 0), corner(4, 0, 1), corner(0, 4, 2)};
    a.base = 5;
    a.split_by = 3;
    a.stopped_by = 4 | 16;
    b.corners = {corner(4, 0, 1), corner(4, 4, 0), corner(0, 4, 2)};
    b.base = 1;
    b.split_by = 1;
    b.stopped_by = 8;
    EmittedTriangle culled = a;
    culled.culled = true;
    mesh.triangles = std::vector{a, culled, b};
    return mesh;
}

MeshUnits units() {
    MeshUnits units;
    units.map.width = units.map.height = 8;
    units.scale = 0.5;
    units.centre = {10, 20, 30.1};
    return units;
}

/// Reads the bytes as a file; returns the message if they are refused, which must name the file and the remedy.
std::string refusal(const TestFolder& here, const std::string& bytes) {
    write_all(here / "mesh.ply", bytes);
    try {
        read_ply(here / "mesh.ply");
    } catch (const InputError& error) {
        const std::string message = error.what();
        CHECK_THAT(message, Contains("mesh.ply") && Contains("run the job again"));
        CHECK(message.find('\n') == std::string::npos);
        return message;
    }
    return {};
}

}  // namespace

TEST_CASE("a written mesh is read back") {
    const TestFolder here;
    const EmittedMesh mesh = small_mesh();
    write_ply(here / "mesh.ply", mesh, units());
    const RecordedMesh read = read_ply(here / "mesh.ply");
    REQUIRE(read.positions.size() == 4);
    REQUIRE(read.normals.size() == 4);
    REQUIRE(read.textures.size() == 4);
    REQUIRE(read.triangles.size() == 2);
    std::size_t next = 0;
    for (const EmittedTriangle& t : mesh.triangles) {
        if (t.culled)
            continue;
        const RecordedMesh::Triangle& r = read.triangles[next++];
        CHECK(r.base == t.base);
        CHECK(r.split_by == t.split_by);
        CHECK(r.stopped_by == t.stopped_by);
        CHECK(r.generation == 2);
        for (std::size_t k = 0; k < 3; ++k) {
            CHECK(read.positions[r.vertices[k]] == units().position(t.corners[k].displaced));
            CHECK(read.normals[r.vertices[k]] == units().normal(t.corners[k].displaced_normal));
            CHECK(read.textures[r.vertices[k]] == units().texture(t.corners[k].texture));
        }
    }
    write_ply(here / "mesh.ply", EmittedMesh{}, units());
    CHECK(read_ply(here / "mesh.ply").triangles.empty());
}

TEST_CASE("a mesh file cut off anywhere, or longer than in its header, is refused") {
    const TestFolder here;
    write_ply(here / "mesh.ply", small_mesh(), units());
    const std::string whole = read_all(here / "mesh.ply");
    REQUIRE(refusal(here, whole).empty());
    for (std::size_t length = 0; length < whole.size(); ++length) {
        INFO(length);
        REQUIRE_FALSE(refusal(here, whole.substr(0, length)).empty());
    }
    CHECK_THAT(refusal(here, whole + '\0'), Contains("bytes after its header"));
}

TEST_CASE("a mesh file with one byte changed is refused or read, in its header it is refused") {
    const TestFolder here;
    write_ply(here / "mesh.ply", small_mesh(), units());
    const std::string whole = read_all(here / "mesh.ply");
    const std::size_t body = whole.find("end_header\n") + 11;
    const std::size_t first_comment = whole.find("comment"), after_comments = whole.find("element vertex");
    for (std::size_t place = 0; place < whole.size(); ++place) {
        for (const int flip : {0x01, 0x80, 0xff}) {
            std::string bytes = whole;
            bytes[place] = static_cast<char>(bytes[place] ^ flip);
            INFO(place << ' ' << flip);
            const std::string message = refusal(here, bytes);
            const bool in_comments = place >= first_comment && place < after_comments;
            if (place < body && !in_comments)
                REQUIRE_FALSE(message.empty());
        }
    }
}

TEST_CASE("a mesh file with other contents in its header is refused with these contents") {
    const TestFolder here;
    write_ply(here / "mesh.ply", small_mesh(), units());
    const std::string whole = read_all(here / "mesh.ply");
    const auto with = [&](const std::string& what, const std::string& by) {
        return refusal(here, testing::replaced(whole, what, by));
    };
    CHECK_THAT(with("ply\n", "obj\n"), Contains("\"obj\""));
    CHECK_THAT(with("binary_little_endian", "ascii"), Contains("ascii"));
    CHECK_THAT(with("double x", "float x"), Contains("property float x"));
    CHECK_THAT(with("element vertex 4", "element vertex -4"), Contains("-4"));
    CHECK_THAT(with("element vertex 4", "element vertex "), Contains("a number"));
    CHECK_THAT(with("element vertex 4", "element vertex 99999999999"), Contains("a number"));
    CHECK_THAT(with("element vertex 4", "element vertex 4000000000"), Contains("the limit is"));
    CHECK_THAT(with("element vertex 4", "element vertex 2000000000"), Contains("announces 104000000040"));
    CHECK_THAT(with("element face 2", "element face 2147483647"), Contains("announces"));
    CHECK_THAT(with("comment x", "comment " + std::string(300, 'x')), Contains("longer than"));
    std::string comments;
    for (int k = 0; k < 100; ++k)
        comments += "comment\n";
    CHECK_THAT(with("comment x", comments + "comment x"), Contains("more than 64 lines"));

    const std::size_t vertices = whole.find("end_header\n") + 11, faces = vertices + 4 * 52;
    const auto with_bytes = [&](std::size_t place, const std::string& bytes) {
        std::string changed = whole;
        changed.replace(place, bytes.size(), bytes);
        return refusal(here, changed);
    };
    CHECK_THAT(with_bytes(vertices, std::string("\0\0\0\0\0\0\xf8\x7f", 8)), Contains("vertex 0: its position"));
    CHECK_THAT(with_bytes(vertices, "\xff\xff\xff\xff\xff\xff\xef\x7f"), Contains("vertex 0: its position"));
    CHECK_THAT(with_bytes(vertices + 52 + 24, std::string("\0\0\x80\x7f", 4)), Contains("vertex 1: its normal"));
    CHECK_THAT(with_bytes(vertices + 36, std::string("\0\0\0\0\0\0\xf0\xff", 8)), Contains("its texture coordinate"));
    CHECK_THAT(with_bytes(faces, "\x04"), Contains("4 corners"));
    CHECK_THAT(with_bytes(faces + 1, std::string("\x04\0\0\0", 4)), Contains("vertex 4 of 4"));
    CHECK_THAT(with_bytes(faces + 1, "\xff\xff\xff\xff"), Contains("face 0 names vertex"));
    CHECK_THAT(with_bytes(faces + 14, "\x04"), Contains("split_by"));
    CHECK_THAT(with_bytes(faces + 15, "\x03"), Contains("stopped_by"));
    CHECK_THAT(with_bytes(faces + 20 + 16, "\xff\xff\xff\xff"), Contains("face 1: its base triangle"));

    CHECK_THROWS_AS(read_ply(here.path()), InputError);
    CHECK_THROWS_AS(read_ply(here / "absent.ply"), InputError);
}

TEST_CASE("a run's folder is read back, with resolved paths") {
    const TestFolder here;
    const fs::path run = here / "runs/one";
    fs::create_directories(run);
    fs::create_directories(here / "data");
    write_file(here / "map.pgm", "P2 1 1 9\n5\n");
    write_file(here / "data/map.pgm", "P2 1 1 9\n5\n");
    Job job;
    job.folder = here.path().string();
    job.map.source = MapSource::file;
    job.map.file = "map.pgm";
    const std::string unresolved = dump_job(job, run);
    job.displacement.scale = 1;
    job.camera.eye = {0, -1, 1};
    job.camera.target = {0, 0, 0};
    job.camera.up = {0, 0, 1};
    job.camera.near_plane = 0.1;
    write_file(run / "job.toml", dump_job(job, run));
    const auto read = [&] { return read_run(run, here / "data"); };
    CHECK_THROWS_WITH(read(), Contains("mesh.ply") && Contains("deadlocked"));
    write_ply(run / "mesh.ply", small_mesh(), units());
    const RecordedRun result = read();
    CHECK(result.mesh.triangles.size() == 2);
    CHECK(fs::equivalent(result.job.map.path, here / "map.pgm"));
    CHECK(result.folder == run);
    write_file(run / "job.toml", unresolved);
    CHECK_THROWS_WITH(read_run(run, ""), Contains("displacement.scale = \"auto\", which a run never writes"));

    fs::remove(here / "map.pgm");
    CHECK_THROWS_WITH(read(), Contains("map.file") && Contains("map.pgm") && Contains("restore it"));
    job.map.file = "data:map.pgm";
    write_file(run / "job.toml", dump_job(job, run));
    CHECK(read().job.map.file == "data:map.pgm");
    CHECK(read().job.map.path == here / "data/map.pgm");
    CHECK_THROWS_WITH(read_run(run, here.path()), Contains("--data FOLDER"));
    job.output.ply = false;
    write_file(run / "job.toml", dump_job(job, run));
    fs::remove(run / "mesh.ply");
    CHECK_THROWS_WITH(read(), Contains("--set output.ply=true"));
    write_file(run / "job.toml", "[tests]\nview_threshold = -1\n");
    CHECK_THROWS_AS(read(), InputError);
    fs::remove(run / "job.toml");
    CHECK_THROWS_WITH(read(), Contains("no job.toml"));
    CHECK_THROWS_WITH(read_run(here / "absent", ""), Contains("no such folder"));
    CHECK_THROWS_AS(read_run(here / "data/map.pgm", ""), InputError);
}
