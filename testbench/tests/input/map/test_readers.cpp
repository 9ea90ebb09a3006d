// PGM and PNG reading, and the decisions of read_height_map() itself. The other files of this folder test EXR, hostile
// files and built-in maps.
#include <png.h>

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/input/map/read_height_map.h"
#include "testbench/tests/input/map/map_test_files.h"

using namespace tessera;
using namespace tessera::map_test;
using namespace std::string_literals;
using Catch::Contains;

namespace {

HeightMap read_text_as(const TestFolder& folder, const std::string& name, const std::string& bytes) {
    write_all(folder / name, bytes);
    return read_height_map(folder / name);
}

float eighth_bit(int sample) {
    return static_cast<float>(sample / 255.0);
}

}  // namespace

TEST_CASE("a PGM map has its top row at the largest y, and sample / maxval") {
    const TestFolder folder;
    for (const std::string& bytes :
         {"P2\n# top row first\n3 2\n# maxval\n100\n0 25 50\n75 100#c\n1\n"s, "P5 3 2 100\n\0\31\62\113\144\1"s,
          "P5 3 2 100#c\n\0\31\62\113\144\1"s, "P5 #c\r3 2 100\r\0\31\62\113\144\1"s,
          "P5\r\n3 2\r\n100\r\n\0\31\62\113\144\1"s, "P2\r\n3 2\r\n100\r\n0 25 50\r\n75 100 1\r\n"s}) {
        const HeightMap map = read_text_as(folder, "a.pgm", bytes);
        REQUIRE(map.width == 3);
        REQUIRE(map.height == 2);
        CHECK(map.values == std::vector<float>{0.75F, 1.F, 0.01F, 0.F, 0.25F, 0.5F});
        CHECK(map.at(2, 1) == 0.5F);
        CHECK(map.range_low == 0);
        CHECK(map.range_high == 1);
        CHECK(map.repairs.empty());
    }
}

TEST_CASE("a 16-bit P5 is big-endian, and its first sample may look like white space or a comment") {
    const TestFolder folder;
    const HeightMap map = read_text_as(folder, "a.pgm", "P5 2 1 65535\n\x01\x00\x0a\x23"s);
    CHECK(map.at(0, 0) == static_cast<float>(256 / 65535.0));
    CHECK(map.at(1, 0) == static_cast<float>(0x0a23 / 65535.0));
    CHECK(read_text_as(folder, "b.pgm", "P5 1 1 255\r\n"s).at(0, 0) == eighth_bit(10));
    CHECK(read_text_as(folder, "c.pgm", "P5 2 1 255\n#\n"s).at(0, 0) == eighth_bit('#'));
    // CR LF is one separator only if the file's size says so.
    CHECK(read_text_as(folder, "d.pgm", "P5 1 1 255\r\nA"s).at(0, 0) == eighth_bit('A'));
    CHECK(read_text_as(folder, "e.pgm", "P5 1 1 255\r\nAB"s).at(0, 0) == eighth_bit('\n'));
}

TEST_CASE("an unusual PGM file is read with a remark") {
    const TestFolder folder;
    CHECK_THAT(read_text_as(folder, "a.pgm", "P2 1 1 9 1"s).repairs.at(0), Contains("right after its last digit"));
    CHECK_THAT(read_text_as(folder, "a.pgm", "P2 1 1 9 1\n2 3\n"s).repairs.at(0), Contains("4 bytes after"));
    CHECK_THAT(read_text_as(folder, "a.pgm", "P5 1 1 9\n\1more"s).repairs.at(0), Contains("4 bytes after"));
    const std::string comments = "P5\n" + std::string(4096, '#') + "\n1 1 9\n\1";
    CHECK_THAT(read_text_as(folder, "a.pgm", comments).repairs.at(0), Contains("nearly all of them comments"));
    CHECK_THAT(read_text_as(folder, "a.png", "P5 1 1 9\n\1"s).repairs.at(0), Contains("named .png but is a PGM"));
}

TEST_CASE("a wrong PGM file is refused with the fault and the value") {
    const TestFolder folder;
    const auto [bytes, message] = GENERATE(table<std::string, std::string>({
        {"P5 0 3 255\n", "the width at byte 3 of the PGM file is \"0\"; it must be a number from 1 to 4096"},
        {"P5 5000 3 255\n", "is \"5000\"; it must be a number from 1 to 4096"},
        {"P5 4294967297 1 255\n", "is \"4294967297\""},
        {"P5 3 5000 255\n", "the height at byte 5"},
        {"P5 4096 4096 255\nabc", "holds 3 of the 16777216 bytes"},
        {"P5 2 1 65535\n123", "holds 3 of the 4 bytes"},
        {"P2 4096 4096 255\n1 2", "ends before a sample"},
        {"P5 2 2 0\n\1\1\1\1", "the maximum value at byte 7 of the PGM file is \"0\""},
        {"P5 2 2 65536\n12345678", "is \"65536\"; it must be a number from 1 to 65535"},
        {"P5 2 1 100\n\1\145", "the sample before byte 13 of the PGM file is 101, more than its maximum value 100"},
        {"P2 2 1 100 1 101\n", "a sample at byte 13 of the PGM file is \"101\"; it must be a number from 0 to 100"},
        {"P2 2 1 100 1 -1\n", "is \"-1\""},
        {"P2 2 1 100 1 +1\n", "is \"+1\""},
        {"P2 2 1 100 1 1.5\n", "is \"1.5\""},
        {"P2 2 1 100 1   ", "ends before a sample"},
        {"P2 a 1 100 1 1\n", "the width at byte 3 of the PGM file is \"a\""},
        {"P5 2 1", "ends before the maximum value"},
        {"P5 2 1 255", "holds 0 of the 2 bytes"},
        {"P5", "ends before the width"},
        {"P53 2 1 255\n123", "not followed by white space"},
        {"P6 1 1 255\n123", "only greymaps P2 and P5"},
        {"", "is empty"},
        {"version https://git-lfs.github.com/spec/v1\n", "git lfs pull"},
        {"<!DOCTYPE html>", "web page"},
        {"\x1b[2J binary", "\"?[2J binary\", are not those of"},
    }));
    write_all(folder / "bad.pgm", bytes);
    CHECK_THROWS_WITH(read_height_map(folder / "bad.pgm"), Contains(message) && Contains("bad.pgm: "));
    CHECK_THROWS_AS(read_height_map(folder / "bad.pgm"), InputError);
}

TEST_CASE("a path that is not a file, or a file without channels to choose from, is refused") {
    const TestFolder folder;
    CHECK_THROWS_WITH(read_height_map(folder / "none.exr"), Contains("no such map file"));
    CHECK_THROWS_WITH(read_height_map(folder / "."), Contains("not a regular file"));
    CHECK_THROWS_WITH(read_height_map("/dev/zero"), Contains("not a regular file"));
    write_all(folder / "a.pgm", "P2 1 1 9 1\n");
    CHECK_THROWS_WITH(read_height_map(folder / "a.pgm", "Y"), Contains("Leave map.channel empty"));
}

TEST_CASE("grey PNG maps of every depth are sample / maximum, top row at the largest y") {
    const TestFolder folder;
    for (const bool interlaced : {false, true}) {
        write_png(folder / "8.png", {2, 2, 8, PNG_COLOR_TYPE_GRAY, {0, 51, 102, 255}, {}, interlaced});
        HeightMap map = read_height_map(folder / "8.png");
        CHECK(map.values == std::vector<float>{0.4F, 1.F, 0.F, 0.2F});
        CHECK(map.range_low == 0);
        CHECK(map.range_high == 1);
        CHECK(map.repairs.empty());

        write_png(folder / "16.png", {2, 1, 16, PNG_COLOR_TYPE_GRAY, {0x12, 0x34, 0xff, 0xff}, {}, interlaced});
        CHECK(read_height_map(folder / "16.png").values ==
              std::vector<float>{static_cast<float>(0x1234 / 65535.0), 1.F});

        write_png(folder / "4.png", {2, 1, 4, PNG_COLOR_TYPE_GRAY, {0x3f}, {}, interlaced});
        CHECK(read_height_map(folder / "4.png").values == std::vector<float>{0.2F, 1.F});
        write_png(folder / "2.png", {4, 1, 2, PNG_COLOR_TYPE_GRAY, {0x1b}, {}, interlaced});
        CHECK(read_height_map(folder / "2.png").values ==
              std::vector<float>{0.F, static_cast<float>(1 / 3.0), static_cast<float>(2 / 3.0), 1.F});
        write_png(folder / "1.png", {4, 1, 1, PNG_COLOR_TYPE_GRAY, {0x50}, {}, interlaced});
        CHECK(read_height_map(folder / "1.png").values == std::vector<float>{0, 1, 0, 1});
    }
}

TEST_CASE("a colour PNG map is read as luma, exact for grey, alpha is ignored, both are reported") {
    const TestFolder folder;
    write_png(folder / "grey.png", {1, 1, 8, PNG_COLOR_TYPE_RGB, {77, 77, 77}, {}});
    HeightMap map = read_height_map(folder / "grey.png");
    CHECK(map.at(0, 0) == eighth_bit(77));
    CHECK(map.repairs.empty());

    write_png(folder / "rgba.png", {2, 1, 8, PNG_COLOR_TYPE_RGB_ALPHA, {255, 0, 0, 255, 9, 9, 9, 3}, {}});
    map = read_height_map(folder / "rgba.png");
    CHECK(map.at(0, 0) == 0.2126F);
    CHECK(map.at(1, 0) == eighth_bit(9));
    REQUIRE(map.repairs.size() == 2);
    CHECK_THAT(map.repairs[0], Contains("1 texels") && Contains("0.2126 R"));
    CHECK_THAT(map.repairs[1], Contains("1 texels") && Contains("alpha was ignored"));

    write_png(folder / "rgb.png", {3, 1, 8, PNG_COLOR_TYPE_RGB, {255, 0, 0, 0, 255, 0, 0, 0, 255}, {}});
    CHECK(read_height_map(folder / "rgb.png").values == std::vector<float>{0.2126F, 0.7152F, 0.0722F});

    write_png(folder / "ga16.png", {1, 1, 16, PNG_COLOR_TYPE_GRAY_ALPHA, {0x80, 0, 0xff, 0xff}, {}});
    CHECK(read_height_map(folder / "ga16.png").at(0, 0) == static_cast<float>(0x8000 / 65535.0));

    write_png(folder / "palette.png", {4, 1, 2, PNG_COLOR_TYPE_PALETTE, {0x1b}, {1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4}});
    CHECK(read_height_map(folder / "palette.png").values ==
          std::vector<float>{eighth_bit(1), eighth_bit(2), eighth_bit(3), eighth_bit(4)});
}

TEST_CASE("a PNG map's transparent colour is ignored and reported") {
    const TestFolder folder;
    write_png(folder / "a.png", {2, 1, 8, PNG_COLOR_TYPE_GRAY, {7, 9}, {}});
    std::string bytes = read_all(folder / "a.png");
    bytes.insert(33, "\0\0\0\2tRNS\0\7\xe8\xf7\x58\x9b"s);  // 7 is transparent
    write_all(folder / "transparent.png", bytes);
    const HeightMap map = read_height_map(folder / "transparent.png");
    CHECK(map.values == std::vector<float>{eighth_bit(7), eighth_bit(9)});
    REQUIRE(map.repairs.size() == 1);
    CHECK_THAT(map.repairs[0], Contains("1 texels") && Contains("alpha was ignored"));
}

TEST_CASE("an interlaced PNG equals the plain one") {
    const TestFolder folder;
    std::vector<std::uint8_t> bytes(std::size_t{23} * 19);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<std::uint8_t>(i * 37);
    write_png(folder / "plain.png", {23, 19, 8, PNG_COLOR_TYPE_GRAY, bytes, {}, false});
    write_png(folder / "adam7.png", {23, 19, 8, PNG_COLOR_TYPE_GRAY, bytes, {}, true});
    CHECK(read_height_map(folder / "plain.png").values == read_height_map(folder / "adam7.png").values);
}

TEST_CASE("a damaged PNG map is refused, one with extra bytes is read with a remark") {
    const TestFolder folder;
    write_png(folder / "a.png", {2, 2, 8, PNG_COLOR_TYPE_GRAY, {0, 51, 102, 255}, {}});
    const std::string good = read_all(folder / "a.png");

    write_all(folder / "long.png", good + "tail");
    CHECK_THAT(read_height_map(folder / "long.png").repairs.at(0), Contains("4 bytes after"));

    std::string bad = good;
    bad[good.find("IEND") - 5] ^= 1;
    write_all(folder / "crc.png", bad);
    CHECK_THROWS_WITH(read_height_map(folder / "crc.png"), Contains("libpng cannot read") && Contains("CRC"));

    // An invalid colour profile, with a wrong or a correct checksum, does not affect a height map.
    for (const std::string& checksum : {std::string(4, '\0'), std::string("\0\xcc\xe6\x19", 4)}) {
        bad = good;
        bad.insert(33, std::string("\0\0\0\x08iCCPbad\0\0\x01\x02\x03", 16) + checksum);
        write_all(folder / "profile.png", bad);
        CHECK(read_height_map(folder / "profile.png").values == read_height_map(folder / "a.png").values);
    }

    bad = good;
    bad.insert(33, std::string("\x3f\xff\xff\xfftEXtKey\0text", 16));
    write_all(folder / "chunk.png", bad);
    CHECK_THROWS_WITH(read_height_map(folder / "chunk.png"), Contains("libpng cannot read"));

    bad = good;
    bad[16] = 1;
    write_all(folder / "huge.png", bad);
    CHECK_THROWS_WITH(read_height_map(folder / "huge.png"), Contains("16777218 x 2 texels"));

    bad = good;
    bad[18] = bad[22] = 0x10;
    bad[19] = bad[23] = 0;
    write_all(folder / "liar.png", bad);
    CHECK_THROWS_WITH(read_height_map(folder / "liar.png"), Contains("libpng cannot read"));
}
