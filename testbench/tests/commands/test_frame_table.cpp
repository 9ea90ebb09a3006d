#include "testbench/commands/frame_table.h"

#include <catch2/catch.hpp>
#include <string>

#include "testbench/tests/support/test_folder.h"

using namespace tessera;

namespace {

/// Two frames with distinct figures.
std::vector<FrameRow> two_rows() {
    FrameRow first;
    first.name = "frame_000";
    first.scale = 0.125;
    first.sent = {1, 20, 300, 4000, 50'000};
    first.triangles = 61;
    first.edges_tested = 72;
    first.edges_split = 83;
    first.tessellated_bytes = 100'000;
    FrameRow second = first;
    second.name = "frame_001";
    second.scale = 0.25;
    second.sent = {1, 0, 300, 0, 8};
    second.triangles = 1234;
    second.cycles = 56'789;
    second.tessellated_bytes = 8'630;
    return {first, second};
}

}  // namespace

TEST_CASE("frames.csv: each figure is in its column") {
    CHECK(frames_csv(two_rows()) ==
          "frame,displacement_scale,triangles,edges_tested,edges_split,cycles,base_mesh_bytes,"
          "displacement_map_bytes,normal_map_bytes,summed_height_table_bytes,register_bytes,sent_bytes,"
          "tessellated_mesh_bytes\n"
          "frame_000,0.125,61,72,83,,1,20,300,4000,50000,54321,100000\n"
          "frame_001,0.25,1234,72,83,56789,1,0,300,0,8,309,8630\n");
}

TEST_CASE("frames.txt: each figure is below its heading") {
    CHECK(frames_heading() + frames_line(two_rows()[0]) + frames_line(two_rows()[1]) ==
          "  frame      scale, model units    triangles   edges tested         cycles    sent, bytes "
          "tessellated mesh, bytes\n"
          "  frame_000               0.125           61             72              -         54,321 "
          "                100,000\n"
          "  frame_001                0.25        1,234             72         56,789            309 "
          "                  8,630\n");
}

// 54321 + 309 + 308 bytes sent; the tessellated meshes have 100000 + 8630.
TEST_CASE("frames.txt: the bytes sent are listed by kind and beside the tessellated meshes") {
    std::vector<FrameRow> rows = two_rows();
    rows.push_back(rows[1]);
    rows[2].name = "frame_002";
    rows[2].sent.registers = 7;
    rows[2].tessellated_bytes = 0;
    CHECK(frames_traffic(rows) ==
          "  sent for the first frame  54,321 bytes: base mesh 1, displacement map 20, normal map 300, height "
          "test's table 4,000, registers 50,000\n"
          "  sent for a later frame    309 bytes: base mesh 1, normal map 300, registers 8 (the largest, "
          "frame_001)\n"
          "  for all frames            54,938 bytes; the tessellated meshes, indexed, would be 108,630: the "
          "host sends 0.51 times that size\n");
}

TEST_CASE("frames.txt: of the later frames the one for which most is sent is named, the first never") {
    std::vector<FrameRow> rows(5, two_rows()[0]);
    for (std::size_t k = 0; k < rows.size(); ++k)
        rows[k].name = "frame_00" + std::to_string(k);
    for (std::size_t most = 1; most < rows.size(); ++most) {
        for (std::size_t k = 1; k < rows.size(); ++k)
            rows[k].sent = {0, 0, 0, 0, k == most ? 8U : 7U - k};
        INFO(most);
        CHECK_THAT(frames_traffic(rows),
                   Catch::Contains("  sent for a later frame    8 bytes: base mesh 0, registers 8 "
                                   "(the largest, " +
                                   rows[most].name + ")\n"));
    }
}

TEST_CASE("frames: the counts of a frame are read from its own figures") {
    const TestFolder here;
    const auto figure = [](const char* name, const std::string& value) {
        return '"' + std::string(name) + "\": {\"value\": " + value + '}';
    };
    const auto write = [&](const char* mode) {
        write_all(here.path() / "statistics.json",
                  "{\"run\": {" + figure("mode", mode) + ", " + figure("triangles_finished", "1") + ", " +
                      figure("edges_tested", "2") + ", " + figure("edges_split", "3") + "}, \"timing\": {" +
                      figure("cycles", "4") + "}, \"host\": {" + figure("tessellated_mesh_bytes", "5") + "}}");
    };
    write("\"timed\"");
    FrameRow row;
    read_counts(here.path(), row);
    CHECK(row.triangles == 1);
    CHECK(row.edges_tested == 2);
    CHECK(row.edges_split == 3);
    CHECK(row.cycles == 4);
    CHECK(row.tessellated_bytes == 5);
    write("\"functional\"");
    FrameRow untimed;
    read_counts(here.path(), untimed);
    CHECK_FALSE(untimed.cycles.has_value());
}
