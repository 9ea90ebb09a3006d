#include <tiny_obj_loader.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <set>

#include "testbench/common/error.h"
#include "testbench/input/mesh/built_in.h"
#include "testbench/input/mesh/obj_reader.h"
#include "testbench/tests/input/mesh/mesh_checks.h"
#include "testbench/tests/support/shared_data.h"

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

/// The files of a folder of the shared data, sorted by name; none if it is absent.
std::vector<fs::path> files_in(const char* folder) {
    std::vector<fs::path> files;
    const fs::path path = shared_data(folder);
    if (path.empty())
        return files;
    for (const auto& entry : fs::directory_iterator(path))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

bool is_obj(const fs::path& file) {
    return file.extension() == ".obj" || file.filename().string().rfind("tinyobj_", 0) == 0;
}

}  // namespace

TEST_CASE("the shared meshes load") {
    for (const fs::path& file : files_in("meshes")) {
        if (!is_obj(file))
            continue;
        INFO(file);
        const BaseMesh mesh = read_obj(file.string());
        require_complete(mesh);
        CHECK(mesh.dropped_degenerate == 0);
        // the teapot has poles, mirrored patches, and inconsistent normals at its tip
        CHECK(mesh.repairs.empty() == (file.filename() != "teapot_n4.obj"));
    }
}

TEST_CASE("the shared meshes equal those read by tinyobjloader") {
    for (const fs::path& file : files_in("meshes")) {
        if (!is_obj(file))
            continue;
        INFO(file);
        const BaseMesh mesh = read_obj(file.string());
        tinyobj::ObjReader reader;
        REQUIRE(reader.ParseFromFile(file.string()));
        const tinyobj::attrib_t& attrib = reader.GetAttrib();
        std::size_t at = 0, different = 0;
        for (const tinyobj::shape_t& shape : reader.GetShapes()) {
            for (const tinyobj::index_t& index : shape.mesh.indices) {
                REQUIRE(at / 3 < mesh.triangles.size());
                const BaseVertex& vertex = mesh.vertices[mesh.triangles[at / 3][at % 3]];
                ++at;
                const auto v = static_cast<std::size_t>(index.vertex_index) * 3;
                const auto t = static_cast<std::size_t>(index.texcoord_index) * 2;
                const auto n = static_cast<std::size_t>(index.normal_index) * 3;
                const glm::dvec3 position(attrib.vertices[v], attrib.vertices[v + 1], attrib.vertices[v + 2]);
                const glm::dvec2 texture(attrib.texcoords[t], attrib.texcoords[t + 1]);
                const glm::dvec3 normal(attrib.normals[n], attrib.normals[n + 1], attrib.normals[n + 2]);
                different += !(safe_length(vertex.position - position) < 1e-12) ||
                             !(glm::length(vertex.texture - texture) < 1e-12) ||
                             !(safe_length(vertex.normal - unit_or_zero(normal)) < 1e-12);
            }
        }
        CHECK(at == mesh.triangles.size() * 3);
        CHECK(different == 0);
    }
}

TEST_CASE("the teapot is closed except for its own openings, and equals that of the shared data") {
    const BaseMesh mesh = read_obj((source_folder() / "testbench/examples/jobs/teapot.obj").string());
    require_complete(mesh);
    CHECK(mesh.triangles.size() == 992);
    const EdgeCounts edges = count_edges(mesh);
    CHECK(edges.odd == 0);
    // The rims of the body and the lid have 16 edges each, the two ends of spout and handle 8 each.
    CHECK(edges.border == 64);
    const fs::path file = shared_data("meshes/teapot_n4.obj");
    if (file.empty())
        return;
    const BaseMesh expected = read_obj(file.string());
    REQUIRE(mesh.triangles.size() == expected.triangles.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const BaseVertex &a = mesh.vertices[mesh.triangles[i][k]], &b = expected.vertices[expected.triangles[i][k]];
            // The file has six decimals.
            different += !(safe_length(a.position - b.position) < 1e-6) || !(safe_length(a.normal - b.normal) < 2e-6) ||
                         a.texture != b.texture;
        }
    }
    CHECK(different == 0);
}

TEST_CASE("the built-in plane is the shared plane of 18 triangles") {
    const fs::path file = shared_data("meshes/plane_18.obj");
    if (file.empty())
        return;
    const BaseMesh built_in = make_plane(3, 3, 2, 2), read = read_obj(file.string());
    REQUIRE(read.triangles.size() == built_in.triangles.size());
    for (std::size_t i = 0; i < read.triangles.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {  // the file numbers its vertices by first use
            const BaseVertex& a = read.vertices[read.triangles[i][k]];
            const BaseVertex& b = built_in.vertices[built_in.triangles[i][k]];
            CHECK(safe_length(a.position - b.position) < 1e-6);
            CHECK(glm::length(a.texture - b.texture) < 1e-6);
            CHECK(a.normal == b.normal);
            CHECK(safe_length(a.tangent - b.tangent) < 1e-6);
        }
    }
}

TEST_CASE("the shared cylinders close at their seam") {
    const fs::path folder = shared_data("meshes");
    if (folder.empty())
        return;
    for (const char* name : {"cylinder_1800.obj", "cylinder_1800_lps.obj"}) {
        const BaseMesh mesh = read_obj((folder / name).string());
        CHECK(mesh.vertices.size() == 961);
        CHECK(mesh.repairs.empty());
        const EdgeCounts edges = count_edges(mesh);
        CHECK(edges.border == 60);
        CHECK(edges.odd == 0);
        std::size_t open = 0;
        for (const BaseVertex& v : mesh.vertices)
            for (const BaseVertex& w : mesh.vertices)
                open += v.position == w.position && (v.normal != w.normal || v.tangent != w.tangent);
        CHECK(open == 0);
    }
}

TEST_CASE("hostile files load with a repair or end in one clear error") {
    // The ok_ files have no texture coordinates, which must be reported as a repair; one holds a face in four
    // spellings.
    const auto told_of_every_ok = [](const std::string& repair) {
        return repair.find("have no texture coordinates") != std::string::npos;
    };
    for (const fs::path& file : files_in("hostile/obj")) {
        if (!is_obj(file))
            continue;
        const std::string name = file.filename().string();
        INFO(name);
        try {
            const BaseMesh mesh = read_obj(file.string());
            require_complete(mesh);
            // this file broke tinyobjloader's triangulation, but is a good mesh that needs no repair
            CHECK(mesh.repairs.empty() == (name == "tinyobj_issue-295-trianguation-failure.obj"));
            if (name.rfind("ok_", 0) == 0) {
                const auto others = std::count_if(mesh.repairs.begin(), mesh.repairs.end(),
                                                  [&](const std::string& repair) { return !told_of_every_ok(repair); });
                CHECK(others == (name == "ok_all_forms.obj" ? 1 : 0));
            }
            for (const std::string& repair : mesh.repairs)
                CHECK(repair.back() == '.');
        } catch (const InputError& error) {
            CHECK_THAT(error.what(), Contains(name));
            CHECK(name.rfind("ok_", 0) != 0);
        }
    }
}
