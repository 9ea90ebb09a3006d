#include <ImfChannelList.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfPartType.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/input/map/read_height_map.h"
#include "testbench/tests/input/map/map_test_files.h"
#include "testbench/tests/support/shared_data.h"

using namespace tessera;
using namespace tessera::map_test;
using namespace std::string_literals;
using Catch::Contains;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

// 19 x 21, so that the last tiles of 8 and blocks of 16 lines are partial; values are exact in half precision.
ExrImage steps() {
    ExrImage image{19, 21, std::vector<float>(std::size_t{19} * 21)};
    std::iota(image.values.begin(), image.values.end(), 3.F);
    return image;
}

/// `count` zeros, at most 128, as RLE (1) or ZIP compression (2, 3) stores them.
std::string compressed_zeros(int compression, std::size_t count) {
    if (compression == 1)
        return {static_cast<char>(count - 1), '\0'};
    const std::vector<Bytef> zeros(count);
    std::string result(compressBound(count), '\0');
    uLongf size = result.size();
    compress(reinterpret_cast<Bytef*>(result.data()), &size, zeros.data(), count);
    result.resize(size);
    return result;
}

/// The position of the first chunk of an EXR file, where the offset table ends and its first entry points.
std::size_t first_chunk(const std::string& file, std::size_t chunks) {
    for (std::size_t at = 8; at + 8 <= file.size(); ++at) {
        std::uint64_t offset = 0;
        for (std::size_t k = 0; k < 8; ++k)
            offset |= std::uint64_t{static_cast<unsigned char>(file[at + k])} << (8 * k);
        if (offset == at + 8 * chunks)
            return offset;
    }
    FAIL("no offset table");
    return 0;
}

}  // namespace

TEST_CASE("an EXR map keeps its values for any pixel type, compression, tiling and origin") {
    const TestFolder folder;
    const auto pixels = GENERATE(Pixels::uint, Pixels::half, Pixels::float_);
    const auto compression = GENERATE(0, 1, 2, 3, 4, 5);
    const auto tiled = GENERATE(false, true);
    const auto origin = GENERATE(0, 30, -7);
    ExrImage image = steps();
    image.pixels = pixels;
    image.compression = compression;
    image.tiled = tiled;
    image.left = origin;
    image.top = 2 * origin;
    write_exr(folder / "a.exr", image);
    const HeightMap map = read_height_map(folder / "a.exr");
    REQUIRE(map.width == 19);
    REQUIRE(map.height == 21);
    CHECK(map.at(0, 20) == 3);
    CHECK(map.at(18, 20) == 21);
    CHECK(map.at(0, 0) == 3 + 20 * 19);
    CHECK(map.at(18, 0) == 2 + 21 * 19);
    CHECK(std::accumulate(map.values.begin(), map.values.end(), 0.0) == 399 * (3 + 401) / 2.0);
    CHECK(map.range_low == 3);
    CHECK(map.range_high == 401);
    CHECK(map.repairs.empty());
}

TEST_CASE("unsigned integers of an EXR map that a float does not hold are counted") {
    const TestFolder folder;
    ExrImage image = steps();
    image.pixels = Pixels::uint;
    image.compression = 0;
    image.values[5] = 16777216;
    image.values[6] = 16777218;
    write_exr(folder / "a.exr", image);
    CHECK(read_height_map(folder / "a.exr").repairs.empty());
    // Each integer is stored once in a file without compression; the writer has floats only.
    std::string file = read_all(folder / "a.exr");
    const std::size_t at = file.find(std::string("\2\0\0\1", 4));
    REQUIRE(at != std::string::npos);
    file[at] = 3;
    write_all(folder / "a.exr", file);
    const HeightMap map = read_height_map(folder / "a.exr");
    REQUIRE(map.repairs.size() == 1);
    CHECK(map.repairs.front() ==
          "1 texel of channel Y holds unsigned integers beyond 16777216 that were rounded to 24 bits.");
    CHECK(std::count(map.values.begin(), map.values.end(), 16777220.F) == 1);
}

TEST_CASE("the finest level of a mip map is read") {
    const TestFolder folder;
    ExrImage image = steps();
    image.tiled = true;
    image.mip_map = true;
    write_exr(folder / "a.exr", image);
    const HeightMap map = read_height_map(folder / "a.exr");
    CHECK(map.width == 19);
    CHECK(map.at(18, 0) == 401);
}

TEST_CASE("an EXR channel is chosen by name, else Y, else R, else the only one") {
    const TestFolder folder;
    ExrImage image{1, 1, {0}};
    const auto first_value = [&](std::vector<std::string> channels, const std::string& wanted) {
        image.channels = std::move(channels);
        write_exr(folder / "a.exr", image);
        return read_height_map(folder / "a.exr", wanted).at(0, 0);
    };
    CHECK(first_value({"A", "R", "Y"}, "") == 2);
    CHECK(first_value({"A", "R", "Z"}, "") == 1);
    CHECK(first_value({"depth.Z"}, "") == 0);
    CHECK(first_value({"A", "R", "Y"}, "A") == 0);
    CHECK_THROWS_WITH(first_value({"A", "B"}, ""), Contains("more than one: A, B. Set map.channel"));
    CHECK_THROWS_WITH(first_value({"A", "B"}, "Y"), Contains("no channel \"Y\"; it has: A, B"));
}

TEST_CASE("values that are not finite are repaired and counted, a map without finite values is refused") {
    const TestFolder folder;
    for (const auto pixels : {Pixels::half, Pixels::float_}) {
        write_exr(folder / "a.exr", {3, 2, {not_a_number, infinity, -infinity, 2, 5, not_a_number}, pixels});
        const HeightMap map = read_height_map(folder / "a.exr");
        CHECK(map.values == std::vector<float>{2, 5, 2, 2, 5, 2});
        CHECK(map.range_low == 2);
        CHECK(map.range_high == 5);
        REQUIRE(map.repairs.size() == 3);
        CHECK_THAT(map.repairs[0], Contains("2 NaN texels set to the lowest finite value, 2"));
        CHECK_THAT(map.repairs[1], Contains("1 +infinity texel set to the highest finite value, 5"));
        CHECK_THAT(map.repairs[2], Contains("1 -infinity texel set to the lowest finite value, 2"));

        write_exr(folder / "b.exr", {2, 1, {not_a_number, infinity}, pixels});
        CHECK_THROWS_WITH(read_height_map(folder / "b.exr"), Contains("all 2 texels") && Contains("finite heights"));
    }
}

TEST_CASE("a constant EXR map has an empty range, subnormal numbers are kept and reported") {
    const TestFolder folder;
    write_exr(folder / "a.exr", {2, 2, {7, 7, 7, 7}});
    const HeightMap constant = read_height_map(folder / "a.exr");
    CHECK(constant.range_low == 7);
    CHECK(constant.range_high == 7);
    write_exr(folder / "b.exr", {2, 1, {0x1p-24F, 1}, Pixels::half});
    const HeightMap small = read_height_map(folder / "b.exr");
    CHECK(small.at(0, 0) == 0x1p-24F);
    CHECK_THAT(small.repairs.at(0), Contains("1 texel holds subnormal"));
}

TEST_CASE("sides over the limit are refused from the header") {
    const TestFolder folder;
    write_exr(folder / "limit.exr", {4096, 1, std::vector<float>(4096)});
    CHECK(read_height_map(folder / "limit.exr").width == 4096);
    write_exr(folder / "wide.exr", {4097, 1, std::vector<float>(4097)});
    CHECK_THROWS_WITH(read_height_map(folder / "wide.exr"), Contains("4097 x 1 texels; each side must be 1 to 4096"));
    write_exr(folder / "high.exr", {1, 4097, std::vector<float>(4097)});
    CHECK_THROWS_WITH(read_height_map(folder / "high.exr"), Contains("1 x 4097 texels"));
}

TEST_CASE("the face in every EXR variant is the same map") {
    const auto folder = shared_data("exr");
    if (folder.empty())
        return;
    const HeightMap reference = read_height_map(folder / "face97x81_float_none_scan.exr");
    const HeightMap half_reference = read_height_map(folder / "face97x81_half_none_scan.exr");
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name.rfind("face97x81_", 0) != 0)
            continue;
        ++count;
        INFO(name);
        const HeightMap map = read_height_map(entry.path());
        REQUIRE(map.width == 97);
        REQUIRE(map.height == 81);
        const bool in_half = name.find("_half_") != std::string::npos;
        const double loss = name.find("half_b44") != std::string::npos      ? 4.6e-3
                            : name.find("float_pxr24") != std::string::npos ? 3e-5
                                                                            : 0;
        const std::vector<float>& expected = in_half ? half_reference.values : reference.values;
        double worst = 0;
        double sum = 0;
        for (std::size_t i = 0; i < map.values.size(); ++i) {
            worst = std::max(worst, static_cast<double>(std::fabs(map.values[i] - expected[i])));
            sum += static_cast<double>(map.values[i]);
        }
        CHECK(worst <= loss * 1.05);  // the README's two digits
        CHECK(sum == Approx(15278.5).epsilon(0).margin(in_half ? 1.0 : 0.1));
    }
    CHECK(count == 22);
}

TEST_CASE("the OpenEXR project's own test images are read") {
    const auto folder = shared_data("exr");
    if (folder.empty())
        return;
    for (const char* const name : {"oexr_AllHalfValues.exr", "oexr_BrightRingsNanInf.exr"}) {
        const HeightMap map = read_height_map(folder / name);
        CHECK_FALSE(map.repairs.empty());
        for (const float value : map.values)
            REQUIRE(std::isfinite(value));
    }
    // The same picture with other windows: display windows of 400 x 300 at (1, 1), 340 x 260 at (30, 20), and 501 x 401
    // at (0, 0) about data at (30, 40); the others' data are at (0, 0).
    const HeightMap t02 = read_height_map(folder / "oexr_t02.exr"), t05 = read_height_map(folder / "oexr_t05.exr"),
                    t08 = read_height_map(folder / "oexr_t08.exr");
    REQUIRE(t02.width == 400);
    REQUIRE(t05.width == 340);
    REQUIRE(t08.width == 501);
    for (const auto& [x, y] : {std::pair{40, 50}, {200, 100}, {369, 279}}) {  // in t02's and t05's data
        const float value = t02.at(x - 1, t02.height - 1 - (y - 1));
        CHECK(t05.at(x - 30, t05.height - 1 - (y - 20)) == value);
        CHECK(t08.at(x + 30, t08.height - 1 - (y + 40)) == value);
    }
}

TEST_CASE("an EXR chunk with less data than its pixels is refused, for any compression") {
    const TestFolder folder;
    const auto [compression, tiled] =
        GENERATE(table<int, bool>({{0, false}, {0, true}, {1, false}, {1, true}, {2, false}, {3, false}, {3, true}}));
    ExrImage image{16, 16, std::vector<float>(256)};
    for (std::size_t k = 0; k < image.values.size(); ++k)
        image.values[k] = static_cast<float>(k / 2);  // compresses well with every method
    image.compression = compression;
    image.tiled = tiled;
    write_exr(folder / "good.exr", image);
    CHECK(read_height_map(folder / "good.exr").at(15, 15) == 7);

    const std::string good = read_all(folder / "good.exr");
    const std::size_t head = tiled ? 20 : 8;
    const std::size_t chunk = first_chunk(good, tiled ? 4 : compression == 3 ? 1 : 16);
    std::string bad = good;
    if (compression == 0) {
        bad[chunk + head - 4] = static_cast<char>(tiled ? 252 : 60);  // one pixel fewer
        bad[chunk + head - 3] = 0;
    } else {
        const std::string shorter = compressed_zeros(compression, tiled ? 128 : compression == 3 ? 512 : 32);
        REQUIRE(shorter.size() <= static_cast<unsigned char>(bad[chunk + head - 4]) + 256u);
        bad[chunk + head - 4] = static_cast<char>(shorter.size());
        bad[chunk + head - 3] = 0;
        bad.replace(chunk + head, std::min(shorter.size(), bad.size() - chunk - head), shorter);
    }
    write_all(folder / "bad.exr", bad);
    CHECK_THROWS_WITH(read_height_map(folder / "bad.exr"),
                      Contains(compression == 0 ? "bytes of pixels of " : "decompress") && Contains("It is damaged"));
}

TEST_CASE("an EXR file without data that its pixels do not need is read with a remark") {
    const TestFolder folder;
    ExrImage image = steps();
    image.tiled = GENERATE(false, true);
    write_exr(folder / "good.exr", image);
    const std::string good = read_all(folder / "good.exr");
    const std::size_t chunks = image.tiled ? 9 : 2, table = first_chunk(good, chunks) - 8 * chunks;
    std::string bad = good;
    std::string remark;
    SECTION("offsets") {
        // Either the whole table is missing, or its last entry only.
        const std::size_t missing = GENERATE(true, false) ? chunks : 1;
        bad.replace(table + 8 * (chunks - missing), 8 * missing, std::string(8 * missing, '\0'));
        remark = "offset table is incomplete";
    }
    SECTION("attributes") {
        const auto name = GENERATE("displayWindow"s, "pixelAspectRatio"s, "screenWindowCenter"s, "screenWindowWidth"s);
        bad[bad.find(name)] = 'x';
        remark = "lacks the required attribute " + name;
    }
    write_all(folder / "bad.exr", bad);
    const HeightMap map = read_height_map(folder / "bad.exr");
    CHECK(map.values == read_height_map(folder / "good.exr").values);
    REQUIRE(map.repairs.size() == 1);
    CHECK_THAT(map.repairs[0], Contains(remark));
}

TEST_CASE("an EXR file without data that its pixels need is refused") {
    const TestFolder folder;
    write_exr(folder / "good.exr", steps());
    const std::string good = read_all(folder / "good.exr");
    std::string bad = good, message;
    SECTION("attributes") {
        const auto name = GENERATE("channels"s, "compression"s, "dataWindow"s, "lineOrder"s);
        bad[bad.find(name)] = 'x';
        message = "'" + name + "' attribute not found";
    }
    SECTION("an offset beyond the file") {
        bad[first_chunk(good, 2) - 5] = 1;
        message = "offset table";
    }
    write_all(folder / "bad.exr", bad);
    CHECK_THROWS_WITH(read_height_map(folder / "bad.exr"), Contains(message));
}

TEST_CASE("EXR files of several parts, or of deep data, are refused") {
    const TestFolder folder;
    const std::string path = folder / "bad.exr";
    Imf::Header header(4, 4);
    header.channels().insert("Y", Imf::Channel(Imf::HALF));
    std::string message;
    SECTION("parts") {
        header.setType(Imf::SCANLINEIMAGE);
        header.setName("a");
        Imf::Header other = header;
        other.setName("b");
        const Imf::MultiPartOutputFile file(path.c_str(), std::array{header, other}.data(), 2);
        message = "has several parts";
    }
    SECTION("deep data") {
        header.setType(Imf::DEEPSCANLINE);
        header.compression() = Imf::ZIPS_COMPRESSION;
        const Imf::DeepScanLineOutputFile file(path.c_str(), header);
        message = "holds deep data";
    }
    CHECK_THROWS_WITH(read_height_map(path), Contains(message));
}

TEST_CASE("EXR attributes shorter or longer than their stated size are refused") {
    const TestFolder folder;
    const auto [type, value] = GENERATE(table<std::string, std::string>({
        {"preview", "\xff\xff\0\0\xff\x3f\0\0"s},
        {"stringvector", "\xff\xff\xff\x7fhere"s},
        {"stringvector", "\2\0\0\0abc"s},
        {"chlist", "\0\0\0"s},
        {"chlist", "Y\0\2\0"s},
        {"floatvector", "\0\0\0"s},
        {"v2f", "\0\0\0\0"s},
    }));
    write_exr(folder / "good.exr", steps());
    std::string bad = read_all(folder / "good.exr");
    constexpr std::size_t magic_and_version = 8;
    bad.insert(magic_and_version, "extra\0"s + type + '\0' + static_cast<char>(value.size()) + "\0\0\0"s + value);
    write_all(folder / "bad.exr", bad);
    CHECK_THROWS_WITH(read_height_map(folder / "bad.exr"),
                      Contains("OpenEXR cannot read the file") && Contains("damaged"));
}
