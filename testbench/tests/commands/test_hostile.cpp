#include <algorithm>
#include <catch2/catch.hpp>

#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/run_folder.h"
#include "testbench/tests/support/shared_data.h"

using namespace tessera;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().filename().string().rfind("LICENSE", 0) != 0)
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

/// Runs the program on one file. It must exit with code 0, or print one message that names the file and leave no files.
void try_file(const fs::path& file, const std::string& table, const std::vector<std::string>& settings) {
    const TestFolder here;
    const Arguments arguments =
        Arguments{"run"} + set(settings) + set({table + ".source=file", table + ".file=" + file.string()});
    const unsigned cpu_seconds = sanitized ? 200 : 20;
    const ProgramEnd end = run_tessera(arguments, here.path(), {cpu_seconds, 300});

    INFO(file);
    INFO(end.text());
    CHECK(end.signal == 0);
    CHECK_FALSE(end.timed_out);
    if (!sanitized)
        CHECK(end.peak_mib < 256);
    const std::string name = file.filename().string();
    if (end.exit_code == 0) {
        CHECK(end.err.empty());
        require_consistent(RunFolder(here.path() / "out"));
        const auto remarks = RunFolder(here.path() / "out").conformance["remarks"];
        for (const auto& remark : remarks)
            CHECK_THAT(end.out, Contains("note: " + remark.get<std::string>() + "\n"));
        // The last two are valid: a mesh that lies 17,000 units from the origin, integers that a float holds.
        const bool sound = name.rfind("ok_", 0) == 0 || name == "tinyobj_issue-295-trianguation-failure.obj" ||
                           name == "pixel_type_uint.exr";
        const bool borderline = !sound && name.rfind("ambig_", 0) != 0;
        if (borderline && file.parent_path().parent_path().filename() == "hostile")
            CHECK_FALSE(remarks.empty());
    } else {
        CHECK(name.rfind("ok_", 0) != 0);
        CHECK((end.exit_code == 2 || end.exit_code == 4));
        CHECK(end.out.empty());
        CHECK(lines_of(end.err).size() == 1);
        CHECK(end.err.rfind("tessera: ", 0) == 0);
        // The default camera may be unable to see a mesh that is valid in itself.
        CHECK_THAT(end.err, Contains(name) || (Contains("camera.eye is ") && Contains("mesh")));
        CHECK(here.names().empty());
    }
}

void try_maps(const char* kind) {
    const fs::path folder = shared_data(std::string("hostile/") + kind);
    if (folder.empty())
        return;
    for (const fs::path& file : files_in(folder))
        try_file(file, "map", {"output.folder=out", "tests.generation_limit=2", "output.picture=false"});
}

}  // namespace

TEST_CASE("hostile EXR files are read or refused in one message") {
    try_maps("exr_crafted");
}
TEST_CASE("hostile PGM files are read or refused in one message") {
    try_maps("pgm");
}
TEST_CASE("hostile PNG files are read or refused in one message") {
    try_maps("png");
}

TEST_CASE("hostile OBJ files are read or refused in one message") {
    const fs::path folder = shared_data("hostile/obj");
    if (folder.empty())
        return;
    for (const fs::path& file : files_in(folder))
        try_file(
            file, "mesh",
            {"output.folder=out", "map.width=16", "map.height=16", "tests.generation_limit=1", "output.picture=false"});
}

TEST_CASE("valid maps of every kind run") {
    const fs::path data = shared_data();
    if (data.empty())
        return;
    for (const char* const folder : {"maps", "exr"}) {
        for (const fs::path& file : files_in(data / folder)) {
            const std::string extension = file.extension().string();
            if (extension == ".pgm" || extension == ".png" || extension == ".exr")
                try_file(file, "map", {"output.folder=out", "tests.generation_limit=2", "output.picture=false"});
        }
    }
}

TEST_CASE("repairs to mesh and map are reported and recorded") {
    const TestFolder here;
    write_all(here.path() / "flat.obj",
              "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
              "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 1/1 2/2 2/2\n");
    write_all(here.path() / "map.png", "P2 2 2 7\n0 1 2 3\n");
    const ProgramEnd end = succeed(Arguments{"run"} + set({"mesh.source=file", "mesh.file=flat.obj", "map.source=file",
                                                           "map.file=map.png", "output.folder=out"}),
                                   here.path());
    CHECK_THAT(end.out, Contains("note: mesh: "));
    CHECK_THAT(end.out, Contains("note: map: "));
    const RunFolder run(here.path() / "out");
    CHECK(run.conformance["remarks"].size() == 2);
    for (const auto& remark : run.conformance["remarks"])
        CHECK_THAT(run.files().at("report.txt"), Contains("  " + remark.get<std::string>() + "\n"));
}
