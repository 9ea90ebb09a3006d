// Files that are malformed, truncated or damaged: each is either read or refused with InputError, and none makes the
// process grow by more than 256 MiB.
#include <png.h>
#include <sys/resource.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <set>
#include <string>

#include "testbench/common/child_process.h"
#include "testbench/common/random.h"
#include "testbench/prove/fuzz/fuzz_target.h"
#include "testbench/tests/input/map/map_test_files.h"
#include "testbench/tests/support/sanitized.h"
#include "testbench/tests/support/shared_data.h"

using namespace tessera;
using namespace tessera::map_test;
using namespace std::string_literals;

namespace {

constexpr long allowed_growth = 256L << 20;

long address_space() {
    long pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * sysconf(_SC_PAGESIZE);
}

long resident_peak() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss * 1024;
}

// Reads the file in a process whose address space may grow by allowed_growth. True if it exits normally, neither it nor
// a library reaches the limit, and its resident memory grows less. (AddressSanitizer reserves terabytes of address
// space: with it there is no limit.)
bool reads_in_little_memory(const std::filesystem::path& path) {
    const ChildEnd end = run_in_child([&]() -> std::string {
        if (!sanitized) {
            const auto limit = static_cast<rlim_t>(address_space() + allowed_growth);
            const rlimit limits{limit, limit};
            setrlimit(RLIMIT_AS, &limits);
        }
        const long before = resident_peak();
        const Outcome outcome = outcome_of(path);
        const bool short_of_memory = outcome.message.find("memory") != std::string::npos;
        const bool grew = resident_peak() - before > allowed_growth;
        return outcome.kind == Outcome::Kind::wrong_exception || short_of_memory || grew ? "no" : "yes";
    });
    return end.told == "yes" && end.failure.empty();
}

// Requires a refusal in one line that names the file.
void check_refusal(const Outcome& outcome, const std::filesystem::path& path) {
    INFO(outcome.message);
    CHECK(outcome.kind == Outcome::Kind::refused);
    CHECK(outcome.message.rfind(path.string() + ": ", 0) == 0);
    CHECK(outcome.message.find('\n') == std::string::npos);
    CHECK(outcome.message.back() == '.');
}

constexpr int damaged_files = 200;

struct Damage {
    int refused = 0, remarked = 0;
};

// Truncates half of the files and changes one to three bytes of the others; returns how many were refused, and how many
// gave a map with a remark. Each must be refused in one line or give a whole map, and a truncated one only with a remark.
Damage read_damaged(const TestFolder& folder, const std::string& good) {
    Random random(1);
    const auto place = [&] {
        return static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(good.size()) - 1));
    };
    Damage damage;
    for (int k = 0; k < damaged_files; ++k) {
        std::string bad = good;
        const bool cut = k % 2 == 0;
        if (cut)
            bad.resize(place());
        else
            for (std::int64_t changes = random.integer(1, 3); changes > 0; --changes)
                bad[place()] ^= static_cast<char>(random.integer(1, 255));
        write_all(folder / "damaged", bad);
        const Outcome outcome = outcome_of(folder / "damaged");
        INFO("damaged file " << k << " of " << bad.size() << " bytes: " << outcome.message);
        CHECK_FALSE((cut && outcome.kind == Outcome::Kind::loaded));
        CHECK_NOTHROW(fuzz::check_map(bad));
        damage.remarked += outcome.kind == Outcome::Kind::loaded_with_remark;
        if (outcome.kind == Outcome::Kind::refused) {
            ++damage.refused;
            check_refusal(outcome, folder / "damaged");
        }
    }
    return damage;
}

}  // namespace

TEST_CASE("hostile maps are refused, except those that can be repaired") {
    const auto [kind, least] = GENERATE(table<std::string, int>({{"exr_crafted", 37}, {"png", 21}, {"pgm", 22}}));
    const auto folder = shared_data("hostile/" + kind);
    if (folder.empty())
        return;
    const std::set<std::string> mended{"ambig_p2_no_final_newline.pgm", "comment_bomb.pgm", "denormal_pixels.exr",
                                       "missing_displayWindow.exr", "nan_inf_pixels.exr"};
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        ++count;
        const std::string name = entry.path().filename().string();
        const Outcome outcome = outcome_of(entry.path());
        INFO(name << ": " << outcome.message);
        CHECK(reads_in_little_memory(entry.path()));
        if (mended.count(name) != 0)
            CHECK(outcome.kind == Outcome::Kind::loaded_with_remark);
        else if (name.rfind("ok_", 0) == 0 || name == "pixel_type_uint.exr")
            CHECK((outcome.kind == Outcome::Kind::loaded || outcome.kind == Outcome::Kind::loaded_with_remark));
        else
            check_refusal(outcome, entry.path());
    }
    CHECK(count >= least);
}

TEST_CASE("EXR files cut off or with changed bytes are read or refused") {
    const TestFolder folder;
    const auto tiled = GENERATE(false, true);
    const auto compression = GENERATE(0, 1, 3, 4, 5, 6, 8);
    ExrImage image{11, 9, std::vector<float>(99)};
    for (std::size_t i = 0; i < image.values.size(); ++i)
        image.values[i] = static_cast<float>((i * 7) % 13);
    image.pixels = compression % 2 == 0 ? Pixels::half : Pixels::float_;
    image.tiled = tiled;
    image.compression = compression;
    write_exr(folder / "good.exr", image);
    CHECK(outcome_of(folder / "good.exr").kind != Outcome::Kind::refused);
    CHECK(read_damaged(folder, read_all(folder / "good.exr")).refused > damaged_files / 2);
}

TEST_CASE("PNG files cut off or with changed bytes are all noticed") {
    const TestFolder folder;
    const auto interlaced = GENERATE(false, true);
    const auto type = GENERATE(PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_PALETTE);
    PngImage image{5, 4, 8, type, std::vector<std::uint8_t>(20, 1), {}, interlaced};
    if (type == PNG_COLOR_TYPE_PALETTE)
        image.palette = {1, 2, 3, 4, 5, 6};
    write_png(folder / "good.png", image);
    CHECK(outcome_of(folder / "good.png").kind != Outcome::Kind::refused);
    // The checksums detect every damage. libpng 1.6.48 reads a file whose last chunk alone, which is empty, has a wrong one.
    const Damage damage = read_damaged(folder, read_all(folder / "good.png"));
    CHECK(damage.refused + damage.remarked == damaged_files);
    CHECK(damage.refused > damaged_files * 9 / 10);
}

TEST_CASE("PGM files cut off or with changed bytes are read or refused") {
    const TestFolder folder;
    const auto good =
        GENERATE("P5\n# comment\n3 3\n65535\n0123456789abcdefgh"s, "P2\n3 2 # comment\n100\n10 20 30\n40 50 60\n"s);
    CHECK(read_damaged(folder, good).refused > damaged_files / 2);
}

namespace {

void set_word(std::string& bytes, std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i)
        bytes.at(at + i) = static_cast<char>(value >> (8 * i));
}

void set_far_corner(std::string& bytes, std::uint32_t x, std::uint32_t y) {
    const auto type = bytes.find("dataWindow");
    REQUIRE(type != std::string::npos);
    const std::size_t value = type + std::string_view("dataWindow?box2i?size").size();
    set_word(bytes, value + 8, x);
    set_word(bytes, value + 12, y);
}

// Padding, so that an offset table for a large claimed size fits and reading gets as far as possible.
constexpr std::size_t padding_for_tables = 2100000;

}  // namespace

TEST_CASE("EXR headers that claim much cost little memory and time") {
    const TestFolder folder;
    const auto compression = GENERATE(0, 1, 3, 4, 5, 7, 9);
    const auto tiled = GENERATE(false, true);
    ExrImage image{16, 16, std::vector<float>(256)};
    image.compression = compression;
    image.tiled = tiled;
    write_exr(folder / "good.exr", image);
    const std::string good = read_all(folder / "good.exr");
    for (const std::uint32_t side : {4096U, 0x7fffffffU}) {
        for (const std::size_t padding : {std::size_t{0}, padding_for_tables}) {
            std::string bad = good + std::string(padding, '\0');
            set_far_corner(bad, side - 1, side - 1);
            write_all(folder / "bad.exr", bad);
            CHECK(reads_in_little_memory(folder / "bad.exr"));
            CHECK(outcome_of(folder / "bad.exr").kind == Outcome::Kind::refused);
            if (tiled) {
                bad = good + std::string(padding, '\0');
                const std::size_t tiles = good.find("tiledesc") + std::string_view("tiledesc?size").size();
                set_word(bad, tiles, side);
                set_word(bad, tiles + 4, 2048);
                write_all(folder / "bad.exr", bad);
                CHECK(reads_in_little_memory(folder / "bad.exr"));
            }
        }
    }
}

TEST_CASE("an EXR file with more channels than can be decoded in reasonable memory and time is refused") {
    const TestFolder folder;
    const auto with_channels = [](int count, int width) {
        ExrImage image{width, 16, std::vector<float>(static_cast<std::size_t>(16 * width))};
        image.channels = {"Y"};
        while (static_cast<int>(image.channels.size()) < count)
            image.channels.push_back("C" + std::to_string(image.channels.size()));
        return image;
    };
    SECTION("in one chunk: 16 lines of 512 texels, four bytes each") {
        write_exr(folder / "bad.exr", with_channels(1025, 512));
        CHECK_THAT(outcome_of(folder / "bad.exr").message,
                   Catch::Contains("one chunk of the EXR file has 33587200 bytes when decoded"));
    }
    SECTION("in the whole image") {
        write_exr(folder / "good.exr", with_channels(270, 16));
        std::string bad = read_all(folder / "good.exr") + std::string(padding_for_tables, '\0');
        set_far_corner(bad, 999, 999);
        write_all(folder / "bad.exr", bad);
        CHECK_THAT(outcome_of(folder / "bad.exr").message,
                   Catch::Contains("the image of the EXR file has 1080000000 bytes when decoded, in 270 channels"));
    }
    CHECK(outcome_of(folder / "bad.exr").kind == Outcome::Kind::refused);
}

TEST_CASE("an EXR file with larger tiles than a map can have is refused") {
    const TestFolder folder;
    ExrImage image{8, 8, std::vector<float>(64)};
    image.tiled = true;
    write_exr(folder / "a.exr", image);
    std::string bytes = read_all(folder / "a.exr");
    const std::size_t tiles = bytes.find("tiledesc") + std::string_view("tiledesc?size").size();
    set_word(bytes, tiles, 4096);
    write_all(folder / "a.exr", bytes);
    CHECK(outcome_of(folder / "a.exr").kind == Outcome::Kind::loaded);
    set_word(bytes, tiles, 4097);
    write_all(folder / "a.exr", bytes);
    CHECK_THAT(outcome_of(folder / "a.exr").message, Catch::Contains("exceeds max size (4097 vs max 4096)"));
}
