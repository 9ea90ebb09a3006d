#include "testbench/tests/support/run_folder.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>

#include "modules/datapath/height_tests.h"
#include "testbench/tests/support/program_runner.h"
#include "testbench/tests/support/text.h"

namespace tessera {

nlohmann::ordered_json read_json(const std::filesystem::path& file) {
    INFO(file);
    return nlohmann::ordered_json::parse(read_all(file));  // throws with the error and its position
}

namespace {

std::vector<std::string> cells_of(const std::string& row) {
    std::vector<std::string> cells(1);
    bool quoted = false;
    for (const char c : row)
        if (c == '"')
            quoted = !quoted;
        else if (c == ',' && !quoted)
            cells.emplace_back();
        else
            cells.back() += c;
    return cells;
}

}  // namespace

RunFolder::RunFolder(std::filesystem::path folder)
    : statistics(read_json(folder / "statistics.json")),
      conformance(read_json(folder / "conformance.json")),
      folder_(std::move(folder)) {}

std::uint64_t RunFolder::count(const std::string& group, const std::string& name) const {
    INFO(group << '.' << name);
    return statistics.at(group).at(name).at("value").get<std::uint64_t>();
}

std::uint64_t RunFolder::invariant(const std::string& name) const {
    INFO(name);
    return conformance.at("invariants").at(name).at("value").get<std::uint64_t>();
}

std::map<int, std::uint64_t> RunFolder::by_generation() const {
    std::map<int, std::uint64_t> result;
    const std::string prefix = "generation_";
    for (const auto& [name, figure] : statistics.at("mesh").items())
        if (name.rfind(prefix, 0) == 0)
            result[std::stoi(name.substr(prefix.size()))] = figure.at("value").get<std::uint64_t>();
    return result;
}

PlyFacts RunFolder::read_ply() const {
    constexpr std::size_t vertex_bytes = 52, face_bytes = 20;
    const std::string ply = read_all(folder_ / "mesh.ply");
    const std::string end = "end_header\n";
    const std::size_t header = ply.find(end);
    REQUIRE(header != std::string::npos);
    PlyFacts facts;
    facts.vertices = testing::number_after(ply, "element vertex ");
    facts.faces = testing::number_after(ply, "element face ");
    const std::size_t faces = header + end.size() + facts.vertices * vertex_bytes;
    REQUIRE(ply.size() == faces + facts.faces * face_bytes);
    for (std::size_t k = 0; k < facts.faces; ++k)
        ++facts.by_generation[static_cast<unsigned char>(ply[faces + k * face_bytes + 13])];
    return facts;
}

std::uint64_t RunFolder::obj_faces() const {
    std::uint64_t faces = 0;
    for (const std::string& line : lines_of(read_all(folder_ / "mesh.obj")))
        faces += line.rfind("f ", 0) == 0 ? 1U : 0U;
    return faces;
}

std::vector<RunFolder::Row> RunFolder::read_csv() const {
    const std::vector<std::string> lines = lines_of(read_all(folder_ / "statistics.csv"));
    REQUIRE_FALSE(lines.empty());
    CHECK(lines[0] == "name,value,unit,description");
    std::vector<Row> rows;
    for (std::size_t k = 1; k < lines.size(); ++k) {
        const std::vector<std::string> cells = cells_of(lines[k]);
        INFO(lines[k]);
        REQUIRE(cells.size() == 4);
        rows.push_back({cells[0], cells[1], cells[2], cells[3]});
    }
    return rows;
}

std::map<std::string, std::string> RunFolder::files() const {
    std::map<std::string, std::string> result;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
        result[entry.path().filename().string()] = read_all(entry.path());
    return result;
}

void require_consistent(const RunFolder& run) {
    const std::map<std::string, std::string> files = run.files();
    std::vector<std::string> names;
    for (const auto& [name, content] : files) {
        INFO(name);
        CHECK_FALSE(content.empty());
        names.push_back(name);
    }
    std::vector<std::string> wanted{"conformance.json", "job.toml",       "mesh.ply",
                                    "report.txt",       "statistics.csv", "statistics.json"};
    const auto job_says = [&](const char* words) { return files.at("job.toml").find(words) != std::string::npos; };
    if (!job_says("picture = false\n")) {
        wanted.push_back("picture.png");
        CHECK(files.at("picture.png").rfind("\x89PNG\r\n\x1a\n", 0) == 0);
    }
    const bool obj = job_says("obj = true\n");
    if (obj)
        wanted.emplace_back("mesh.obj");
    if (job_says("mode = \"timed\"\n"))
        wanted.emplace_back("queue_levels.csv");
    std::sort(wanted.begin(), wanted.end());
    CHECK(names == wanted);

    // Triangles: finished, recorded, lit and written numbers agree.
    const std::uint64_t finished = run.count("run", "triangles_finished");
    const std::uint64_t culled = run.count("pass_or_tessellate", "culled");
    const PlyFacts ply = run.read_ply();
    CHECK(ply.faces == finished - culled);
    if (obj)
        CHECK(run.obj_faces() == finished - culled);
    CHECK(run.count("lighting", "triangles") == finished - culled);
    CHECK(run.count("mesh", "triangles") == finished);
    std::uint64_t sum = 0;
    for (const auto& [generation, triangles] : run.by_generation()) {
        sum += triangles;
        if (culled == 0 && triangles > 0)
            CHECK(ply.by_generation.at(generation) == triangles);
    }
    CHECK(sum == finished);

    // Triangles in and out: a split triangle has two, three or four children.
    const std::uint64_t base = run.count("host", "base_triangles");
    const std::uint64_t made_into_2 = run.count("tessellation", "made_into_2");
    const std::uint64_t made_into_3 = run.count("tessellation", "made_into_3");
    const std::uint64_t made_into_4 = run.count("tessellation", "made_into_4");
    CHECK(finished == base + made_into_2 + 2 * made_into_3 + 3 * made_into_4);
    CHECK(run.count("get_triangle", "host_triangles") == base);
    CHECK(run.count("get_triangle", "queue_triangles") == run.count("triangle_queue", "taken"));

    // Edges: three per pass through the tests; each split edge is split by some test.
    const std::uint64_t edges = run.count("run", "edges_tested");
    const std::uint64_t split = run.count("run", "edges_split");
    CHECK(edges == 3 * run.count("pass_or_tessellate", "passes"));
    CHECK(split == made_into_2 + 2 * made_into_3 + 3 * made_into_4);
    const bool highlight = run.statistics.at("pass_or_tessellate").contains("split_by_highlight");
    CHECK(highlight == job_says("highlight = true\n"));
    CHECK(split == run.count("pass_or_tessellate", "split_by_normal") +
                       run.count("pass_or_tessellate", "split_by_summed_height") +
                       run.count("pass_or_tessellate", "split_by_both") +
                       (highlight ? run.count("pass_or_tessellate", "split_by_highlight") : 0));
    CHECK(run.statistics.at("run").at("edges_per_triangle").at("value").get<double>() ==
          Approx(static_cast<double>(edges) / static_cast<double>(finished)));

    // Memories: bytes follow from entries, and the ratio from the same edges.
    const std::vector<const datapath::HeightTestFunctions*>& tests = datapath::height_tests();
    const auto in_run = [&](const auto* test) { return run.statistics.contains(test->table()); };
    const std::string height_table = (*std::find_if(tests.begin(), tests.end(), in_run))->table();
    for (const std::string& memory : {std::string("displacement_map"), std::string("normal_map"), height_table}) {
        INFO(memory);
        CHECK(run.count(memory, "bytes_read") == run.count(memory, "reads") * run.count(memory, "entry"));
        if (edges > 0)
            CHECK(run.statistics.at(memory).at("reads_per_edge").at("value").get<double>() ==
                  Approx(static_cast<double>(run.count(memory, "reads")) / static_cast<double>(edges)));
    }
    CHECK(run.count("host", "table_bytes") ==
          run.count("displacement_map", "size") + run.count("normal_map", "size") + run.count(height_table, "size"));

    // A unit's cycles add up to the run's exactly, and it is empty at the end.
    const bool timed = run.statistics.contains("timing");
    for (const auto& [group, members] : run.statistics.items()) {
        if (group.rfind("timing.", 0) != 0)
            continue;
        INFO(group);
        CHECK(run.count(group, "items") == run.count(group, "items_out"));
        if (!members.contains("busy"))  // a queue or a wire: test_statistics.cpp
            continue;
        CHECK(run.count(group, "busy") + run.count(group, "starved") + run.count(group, "blocked") +
                  run.count(group, "waiting_for_memory") ==
              run.count("timing", "cycles"));
        std::uint64_t blocked = 0;
        for (const auto& [name, figure] : members.items())
            blocked += name.rfind("blocked_by_", 0) == 0 ? figure.at("value").get<std::uint64_t>() : 0;
        CHECK(blocked == run.count(group, "blocked"));
    }
    CHECK(timed == job_says("mode = \"timed\"\n"));

    // The CSV has the JSON's figures, in its order.
    const std::vector<RunFolder::Row> rows = run.read_csv();
    std::size_t row = 0;
    for (const auto& [group, members] : run.statistics.items()) {
        for (const auto& [name, figure] : members.items()) {
            INFO(group << '.' << name);
            REQUIRE(row < rows.size());
            const RunFolder::Row& r = rows[row++];
            CHECK(r.name == group + "." + name);
            CHECK(r.unit == figure.at("unit"));
            CHECK(r.description == figure.at("description"));
            const auto& value = figure.at("value");
            const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
            if (r.value != text)  // 1.5 and 1.50 are equal
                CHECK(std::stod(r.value) == std::stod(text));
        }
    }
    CHECK(row == rows.size());

    // The report is of the same run.
    if (run.conformance.contains("conformance")) {
        CHECK(run.conformance["conformance"]["edges"] == edges);
        CHECK(run.conformance["conformance"]["mismatches"] == 0);
        CHECK(run.conformance["conformance"]["first_mismatch"] == "");
        CHECK(run.conformance["conformance"]["passes"] == run.count("pass_or_tessellate", "passes"));
    }
    if (run.conformance.contains("invariants")) {
        CHECK(run.invariant("triangles") == finished);
        CHECK(run.invariant("base_triangles") == base);
    }
    if (run.conformance.contains("end_to_end"))
        CHECK(run.conformance["end_to_end"]["hardware_triangles"] == finished);
    CHECK(run.conformance["passed"] == true);
    CHECK(files.at("report.txt").rfind("Checks: passed\n", 0) == 0);
    CHECK((files.at("report.txt").find("\ntiming\n") != std::string::npos) == timed);
}

void require_same_files(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b) {
    CHECK(a.size() == b.size());
    for (const auto& [name, content] : a) {
        INFO(name);
        REQUIRE(b.count(name) == 1);
        CHECK((content == b.at(name)));  // the parentheses keep Catch2 from printing both contents
    }
}

}  // namespace tessera
