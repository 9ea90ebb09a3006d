// Makes the generated seeds of corpus/: `tessera_fuzz_seeds FOLDER` writes FOLDER/TARGET/seed_*.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "testbench/job/dump_job.h"
#include "testbench/prove/random_edges/datapath_random.h"

namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& bytes) {
    fs::create_directories(path.parent_path());
    std::ofstream file(path, std::ios::binary);
    file << bytes;
    if (!file.flush())
        throw std::runtime_error(path.string() + ": cannot be written");
}

template <class Number>
void append(std::string& bytes, Number number) {  // little endian, as on this platform
    char raw[sizeof number];
    std::memcpy(raw, &number, sizeof number);
    bytes.append(raw, sizeof number);
}

void make_ply(const fs::path& folder) {
    constexpr std::uint32_t vertices = 4;
    const std::array<std::array<std::uint32_t, 3>, 2> faces{{{0, 1, 2}, {0, 2, 3}}};
    std::string ply =
        "ply\nformat binary_little_endian 1.0\ncomment a seed\nelement vertex 4\nproperty double x\n"
        "property double y\nproperty double z\nproperty float nx\nproperty float ny\nproperty float nz\n"
        "property double s\nproperty double t\nelement face 2\nproperty list uchar int vertex_indices\n"
        "property uchar generation\nproperty uchar split_by\nproperty uchar stopped_by\nproperty int base\n"
        "end_header\n";
    for (std::uint32_t k = 0; k < vertices; ++k) {
        const double u = k == 1 || k == 2 ? 1 : 0, v = k >= 2 ? 1 : 0;
        for (const double value : {u, v, 0.25})
            append(ply, value);
        for (const float value : {0.0F, 0.0F, 1.0F})
            append(ply, value);
        append(ply, u);
        append(ply, v);
    }
    for (const auto& face : faces) {
        append(ply, std::uint8_t{3});
        for (const std::uint32_t index : face)
            append(ply, index);
        for (const std::uint8_t tag : {std::uint8_t{1}, std::uint8_t{3}, std::uint8_t{8}})
            append(ply, tag);
        append(ply, std::uint32_t{0});
    }
    write(folder / "seed_square.ply", ply);
}

/// One file per table with all its keys, without comments.
void make_toml(const fs::path& folder) {
    const std::string dump = tessera::dump_job(tessera::Job{});
    std::string table, name = "top";
    for (std::size_t at = 0; at < dump.size();) {
        const std::size_t end = dump.find('\n', at) + 1;
        const std::string line = dump.substr(at, end - at);
        at = end;
        if (line[0] == '#' || line[0] == '\n')
            continue;
        if (line[0] == '[') {
            write(folder / ("seed_" + name + ".toml"), table);
            table.clear();
            name = line.substr(1, line.find(']') - 1);
        }
        table += line;
    }
    write(folder / ("seed_" + name + ".toml"), table);
}

void make_datapath(const fs::path& folder) {
    constexpr int seeds = 12;
    for (int seed = 0; seed < seeds; ++seed) {
        tessera::testing::Random random(static_cast<std::uint64_t>(seed) + 1);
        std::string bytes;
        const std::int64_t size = random.integer(100, 900);
        for (std::int64_t k = 0; k < size; ++k)
            bytes += static_cast<char>(random.bits() & 255);
        write(folder / ("seed_" + std::to_string(seed)), bytes);
    }
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: tessera_fuzz_seeds FOLDER\n");
        return 2;
    }
    try {
        const fs::path folder = arguments[1];
        make_ply(folder / "ply");
        make_toml(folder / "toml");
        make_datapath(folder / "datapath");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "tessera_fuzz_seeds: %s\n", error.what());
        return 1;
    }
    return 0;
}
