#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include <tiny_obj_loader.h>

#include "testbench/common/atomic_file.h"
#include "testbench/output/report/obj_writer.h"
#include "testbench/output/report/ply_writer.h"
#include "testbench/tests/support/edited_mesh.h"
#include "testbench/tests/support/emitted_mesh_maker.h"
#include "testbench/tests/support/refusals.h"
#include "testbench/tests/support/test_folder.h"
#include "testbench/tests/support/text.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

/// Limits the size of files during its lifetime, to simulate a full disk.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit now{bytes, before_.rlim_max};
        REQUIRE(::setrlimit(RLIMIT_FSIZE, &now) == 0);
        handler_ = std::signal(SIGXFSZ, SIG_IGN);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

  private:
    rlimit before_{};
    void (*handler_)(int) = nullptr;
};

struct Sample {
    MeshUnits units;
    EmittedMesh mesh;

    Sample() {
        units.map.width = 64;
        units.map.height = 32;
        units.scale = 0.125;
        units.centre = {1.5, -2, 1000.0625};
        const auto base = make_grid(2, 1, [](int i, int j) {
            return flat_vertex(static_cast<std::uint32_t>(32 * i), static_cast<std::uint32_t>(32 * j));
        });
        const MeshMaker maker{
            [](const datapath::Vertex& a, const datapath::Vertex& b) {
                return datapath::absolute_difference(a.texture.u, b.texture.u) > a.texture.u / 4 + 9000;
            },
            [](const datapath::TexCoord& t) { return static_cast<std::int32_t>((t.u ^ t.v) % 977); }, 12};
        std::size_t i = 0;
        mesh = changed(maker.make(base), [&](EmittedTriangle& t) {
            t.split_by = static_cast<std::uint8_t>(t.corners[2].generation == 0 ? 0 : 1 + i % 3);
            t.stopped_by = static_cast<std::uint8_t>(4 * (i % 8));
            t.culled = i++ % 11 == 5;
        });
        mesh.sort();
    }
};

std::uint8_t generation(const EmittedTriangle& t) {
    return std::max({t.corners[0].generation, t.corners[1].generation, t.corners[2].generation});
}

template <class T>
T take(const std::string& bytes, std::size_t& at) {
    T value;
    REQUIRE(at + sizeof value <= bytes.size());
    std::memcpy(&value, bytes.data() + at, sizeof value);
    at += sizeof value;
    return value;
}

using VertexKey = std::array<std::int64_t, 11>;
VertexKey key(const EmittedTriangle::Corner& c) {
    return {c.position.x,         c.position.y,  c.position.z,         c.displaced.x,
            c.displaced.y,        c.displaced.z, c.displaced_normal.x, c.displaced_normal.y,
            c.displaced_normal.z, c.texture.u,   c.texture.v};
}

std::size_t distinct_vertices(const EmittedMesh& mesh) {
    std::set<VertexKey> seen;
    for (const auto& t : mesh.triangles)
        if (!t.culled)
            for (const auto& c : t.corners)
                seen.insert(key(c));
    return seen.size();
}

}  // namespace

TEST_CASE("a PLY file read back holds the mesh, in model units") {
    const TestFolder folder;
    const Sample sample;
    write_ply(folder / "mesh.ply", sample.mesh, sample.units);
    CHECK(folder.names().size() == 1);
    const std::string bytes = read_all(folder / "mesh.ply");
    const std::string end = "end_header\n";
    const std::string header = bytes.substr(0, bytes.find(end) + end.size());
    CHECK(header.find("ply\nformat binary_little_endian 1.0\n") == 0);
    CHECK(header.find("comment split_by: tests that split the parent: 0 none") != std::string::npos);
    const std::size_t vertices = testing::number_after(header, "element vertex "),
                      faces = testing::number_after(header, "element face ");
    CHECK(bytes.size() == header.size() + 52 * vertices + 20 * faces);
    CHECK(vertices == distinct_vertices(sample.mesh));

    struct Read {
        double p[3], t[2];
        float n[3];
    };
    std::vector<Read> read(vertices);
    std::size_t at = header.size();
    for (Read& v : read) {
        for (double& x : v.p)
            x = take<double>(bytes, at);
        for (float& x : v.n)
            x = take<float>(bytes, at);
        for (double& x : v.t)
            x = take<double>(bytes, at);
    }
    std::uint32_t next = 0;
    std::size_t read_faces = 0;
    for (const EmittedTriangle& t : sample.mesh.triangles) {
        if (t.culled)
            continue;
        ++read_faces;
        REQUIRE(take<std::uint8_t>(bytes, at) == 3);
        for (const auto& c : t.corners) {
            const auto index = take<std::uint32_t>(bytes, at);
            REQUIRE(index <= next);  // in the order of first use
            next = std::max(next, index + 1);
            const Read& v = read.at(index);
            // 65536 LSB are one world unit, eight model units
            CHECK(v.p[0] == c.displaced.x / 8192.0 + 1.5);
            CHECK(v.p[1] == c.displaced.y / 8192.0 - 2);
            CHECK(v.p[2] == c.displaced.z / 8192.0 + 1000.0625);
            CHECK(v.n[0] == static_cast<float>(c.displaced_normal.x / 16384.0));
            CHECK(v.n[2] == static_cast<float>(c.displaced_normal.z / 16384.0));
            CHECK(v.t[0] == c.texture.u / 4096.0 / 64);
            CHECK(v.t[1] == c.texture.v / 4096.0 / 32);
        }
        CHECK(take<std::uint8_t>(bytes, at) == generation(t));
        CHECK(take<std::uint8_t>(bytes, at) == t.split_by);
        CHECK(take<std::uint8_t>(bytes, at) == t.stopped_by);
        CHECK(take<std::uint32_t>(bytes, at) == t.base);
    }
    CHECK(read_faces == faces);
    CHECK(next == vertices);
    CHECK(at == bytes.size());
}

TEST_CASE("an OBJ file read back holds the mesh, grouped by generation and test") {
    const TestFolder folder;
    const Sample sample;
    write_obj(folder / "mesh.obj", sample.mesh, sample.units);
    const std::string text = read_all(folder / "mesh.obj");

    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warnings, errors;
    std::istringstream in(text);
    REQUIRE(tinyobj::LoadObj(&attributes, &shapes, &materials, &warnings, &errors, &in, nullptr));
    CHECK(errors.empty());
    CHECK(attributes.vertices.size() == 3 * distinct_vertices(sample.mesh));
    CHECK(attributes.normals.size() == attributes.vertices.size());

    using Found = std::tuple<std::string, std::vector<double>>;
    std::multiset<Found> expected, found;
    const char* const names[] = {"base", "normal", "summed_height", "both"};
    for (const EmittedTriangle& t : sample.mesh.triangles) {
        if (t.culled)
            continue;
        std::vector<double> numbers;
        for (const auto& c : t.corners) {
            const glm::dvec3 p = sample.units.position(c.displaced);
            const glm::vec3 n = sample.units.normal(c.displaced_normal);
            const glm::vec2 uv(sample.units.texture(c.texture));
            for (const double x : {p.x, p.y, p.z, double(n.x), double(n.y), double(n.z), double(uv.x), double(uv.y)})
                numbers.push_back(x);
        }
        expected.insert({std::string(names[t.split_by]) + "_g" + std::to_string(generation(t)), numbers});
    }
    // tinyobjloader's numbers are not exact: it checks the structure, strtod the digits
    std::vector<std::array<double, 3>> v, vt, vn;
    std::string group;
    std::size_t groups = 0, materials_used = 0;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string kind, word;
        words >> kind;
        const auto numbers = [&] {
            std::array<double, 3> result{};
            for (std::size_t k = 0; words >> word; ++k)
                result.at(k) = std::strtod(word.c_str(), nullptr);
            return result;
        };
        if (kind == "v")
            v.push_back(numbers());
        else if (kind == "vt")
            vt.push_back(numbers());
        else if (kind == "vn")
            vn.push_back(numbers());
        else if (kind == "g") {
            words >> group;
            ++groups;
        } else if (kind == "usemtl") {
            words >> word;
            CHECK(word == group);
            ++materials_used;
        } else if (kind == "f") {
            std::vector<double> corners;
            while (words >> word) {
                const std::size_t i = std::stoul(word) - 1;
                const std::string index = std::to_string(i + 1);
                REQUIRE(word == index + "/" + index + "/" + index);
                corners.insert(corners.end(), v.at(i).begin(), v.at(i).end());
                for (const double x : vn.at(i))
                    corners.push_back(static_cast<float>(x));
                corners.push_back(static_cast<float>(vt.at(i)[0]));
                corners.push_back(static_cast<float>(vt.at(i)[1]));
            }
            found.insert({group, corners});
        }
    }
    REQUIRE(expected.size() == found.size());
    CHECK(expected == found);
    CHECK(groups == shapes.size());
    CHECK(materials_used == groups);
}

TEST_CASE("writing twice gives the same bytes in any locale") {
    const TestFolder folder;
    const Sample sample;
    write_obj(folder / "a.obj", sample.mesh, sample.units);
    write_ply(folder / "a.ply", sample.mesh, sample.units);
    struct Comma : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
        char do_thousands_sep() const override { return '.'; }
        std::string do_grouping() const override { return "\3"; }
    };
    const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
    write_obj(folder / "b.obj", sample.mesh, sample.units);
    write_ply(folder / "b.ply", sample.mesh, sample.units);
    std::locale::global(before);
    CHECK(read_all(folder / "a.obj") == read_all(folder / "b.obj"));
    CHECK(read_all(folder / "a.ply") == read_all(folder / "b.ply"));
}

TEST_CASE("a mesh with every triangle culled is an empty, valid file") {
    const TestFolder folder;
    Sample sample;
    sample.mesh = changed(sample.mesh, [](EmittedTriangle& t) { t.culled = true; });
    write_ply(folder / "a.ply", sample.mesh, sample.units);
    write_obj(folder / "a.obj", sample.mesh, sample.units);
    CHECK(read_all(folder / "a.ply").find("element vertex 0\n") != std::string::npos);
    CHECK(read_all(folder / "a.obj").find("# 0 vertices, 0 triangles\n") != std::string::npos);
}

TEST_CASE("an atomic file appears complete or not at all") {
    const TestFolder folder;
    const fs::path path = folder / "out.bin";

    SECTION("not before commit, and not without it") {
        {
            AtomicFile file(path);
            file.write(std::string(3'000'000, 'x'));
            CHECK_FALSE(fs::exists(path));
        }
        CHECK(folder.names().size() == 0);
    }
    SECTION("complete after commit") {
        std::string content;
        for (int i = 0; i < 700'000; ++i)
            content += static_cast<char>(i * 31 >> 3);
        AtomicFile file(path);
        for (std::size_t at = 0; at < content.size(); at += 4099)
            file.write(std::string_view(content).substr(at, 4099));
        file.commit();
        CHECK(folder.names().size() == 1);
        CHECK(read_all(path) == content);
    }
    SECTION("replaces an older file only on commit") {
        write_file(path, "old");
        {
            AtomicFile file(path);
            file.write("new, unfinished");
        }
        CHECK(read_all(path) == "old");
        write_file(path, "new");
        CHECK(read_all(path) == "new");
        CHECK(folder.names().size() == 1);
    }
    SECTION("replaces a link and never its target") {
        write_file(folder / "real", "old");
        for (const char* const target : {"real", "nowhere", "."}) {
            fs::remove(path);
            fs::create_symlink(target, path);
            write_file(path, "new");
            CHECK(fs::is_regular_file(fs::symlink_status(path)));
            CHECK(read_all(path) == "new");
        }
        CHECK(read_all(folder / "real") == "old");
        CHECK(folder.names().size() == 2);
    }
    SECTION("removes the unfinished files of killed processes and nothing else") {
        const pid_t ended = ::fork();
        if (ended == 0)
            ::_exit(0);
        REQUIRE(::waitpid(ended, nullptr, 0) == ended);
        const std::string dead = std::to_string(ended), alive = std::to_string(::getppid());
        const std::vector<std::string> others{".tessera-" + alive + "-0.part", ".tessera-" + dead + "-0.party",
                                              "x.tessera-" + dead + "-0.part", ".tessera-" + dead + "-.part",
                                              ".tessera-" + dead + "-0",       ".tessera--0.part"};
        std::vector<std::string> all = others;
        all.insert(all.end(), {".tessera-" + dead + "-0.part", ".tessera-" + dead + "-12.part"});
        for (const std::string& name : all) {
            fs::create_directory(folder / name);
            std::ofstream(folder / name / "new-mesh.ply") << "unfinished";
        }
        std::ofstream(folder / (".tessera-" + dead + "-1.part")) << "no folder";
        write_file(path, "new");
        for (const std::string& name : others)
            CHECK(fs::exists(folder / name / "new-mesh.ply"));
        CHECK(folder.names().size() == others.size() + 2);  // the file that is no folder, and the new file
    }
    SECTION("two files of one name at once do not interfere") {
        AtomicFile one(path), two(path);
        one.write("one");
        two.write("two");
        one.commit();
        CHECK(read_all(path) == "one");
        two.commit();
        CHECK(read_all(path) == "two");
        CHECK(folder.names().size() == 1);
    }
}

TEST_CASE("a full disk leaves no file and is reported") {
    const TestFolder folder;
    Sample sample;
    const std::vector<EmittedTriangle> once = list_of(sample.mesh);
    for (int i = 0; i < 50; ++i)
        for (const EmittedTriangle& triangle : once)
            sample.mesh.triangles.push_back(triangle);
    write_file(folder / "old.ply", "old");
    const auto require_failure = [&](const fs::path& path, auto&& write) {
        const FileSizeLimit limit(10000);
        try {
            write();
            FAIL("written beyond the limit");
        } catch (const ResourceError& error) {
            const std::string message = error.what();
            INFO(message);
            CHECK(message.find(path.string()) == 0);
            CHECK(message.find("File too large") != std::string::npos);
        }
    };
    const fs::path obj = folder / "mesh.obj", ply = folder / "mesh.ply", old = folder / "old.ply";
    require_failure(obj, [&] { write_obj(obj, sample.mesh, sample.units); });
    require_failure(ply, [&] { write_ply(ply, sample.mesh, sample.units); });
    require_failure(old, [&] { write_ply(old, sample.mesh, sample.units); });
    CHECK(folder.names().size() == 1);
    CHECK(read_all(old) == "old");
    write_ply(ply, sample.mesh, sample.units);
    CHECK(fs::exists(ply));
}

TEST_CASE("a path that cannot be written is bad input") {
    const TestFolder folder;
    write_file(folder / "file", "here");
    const auto message_of = [](const fs::path& path) {
        return testing::input_error_of([&] { write_file(path, "x"); });
    };
    const auto require_message = [&](const fs::path& path, const std::string& reason) {
        CHECK(message_of(path) == path.string() + ": cannot write: " + reason);
    };
    require_message(folder / "none" / "mesh.ply", "No such file or directory");
    require_message(folder / "file" / "mesh.ply", "Not a directory");
    require_message(folder.path(), "it is a folder, not a file");
    require_message("/dev/full", "it is a device, not a file");
    CHECK(message_of(folder / std::string(300, 'n')).find("File name too long") != std::string::npos);
    if (::geteuid() != 0) {  // root may write anywhere
        fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
        require_message(folder / "mesh.ply", "Permission denied");
        fs::permissions(folder.path(), fs::perms::owner_all);
    }
    CHECK(folder.names().size() == 1);
}

}  // namespace tessera
