#include "testbench/input/map/pgm_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>

#include "testbench/common/error.h"
#include "testbench/input/map/map_file.h"

namespace tessera {
namespace {

bool is_space(char c) {
    return std::string_view(" \t\n\v\f\r").find(c) != std::string_view::npos;
}

struct PgmFile {
    std::string name, bytes;
    const char* next = bytes.data() + 2;  // after the magic number
    const char* end = bytes.data() + bytes.size();

    [[noreturn]] void refuse(std::string_view why) const { throw InputError(fmt::format("{}: {}", name, why)); }

    void skip_comment() {
        next = std::find_if(next, end, [](char c) { return c == '\n' || c == '\r'; });
    }

    void skip_space_and_comments() {
        while (next != end && (is_space(*next) || *next == '#'))
            if (*next == '#')
                skip_comment();
            else
                ++next;
    }

    unsigned number(std::string_view what, unsigned least, unsigned most) {
        skip_space_and_comments();
        if (next == end)
            refuse(fmt::format("the PGM file ends before {}. It was cut off.", what));
        unsigned value = 0;
        const auto [stop, error] = std::from_chars(next, end, value);
        const bool whole = stop == end || is_space(*stop) || *stop == '#';
        if (error != std::errc() || !whole || value < least || value > most)
            refuse(fmt::format("{} at byte {} of the PGM file is \"{}\"; it must be a number from {} to {}.", what,
                               next - bytes.data(),
                               printable_ascii(std::string(next, std::find_if(next, end, is_space))), least, most));
        next = stop;
        return value;
    }

    // Samples begin after one white-space character, after a comment's line end (as in libnetpbm), or after CRLF if the
    // file's size shows that the LF is not a sample.
    void skip_to_samples(std::ptrdiff_t size) {
        if (next != end && *next == '#')
            skip_comment();
        if (next != end)
            next += *next == '\r' && end - next == size + 2 && next[1] == '\n' ? 2 : 1;
        if (end - next < size)
            refuse(
                fmt::format("the PGM file holds {} of the {} bytes that its samples need. It was cut off, or its "
                            "header is wrong.",
                            end - next, size));
    }

    HeightMap read() {
        constexpr std::ptrdiff_t long_header = 4096;
        const bool binary = bytes[1] == '5';
        if (next != end && !is_space(*next) && *next != '#')
            refuse("\"P2\" or \"P5\" is not followed by white space. The file is not a PGM file, or it is damaged.");
        HeightMap map;
        map.width = static_cast<int>(number("the width", 1, largest_map_side));
        map.height = static_cast<int>(number("the height", 1, largest_map_side));
        const unsigned most = number("the maximum value", 1, 65535);
        const int sample_bytes = most > 255 ? 2 : 1;
        map.source_units = most;
        map.values.resize(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height));
        if (next - bytes.data() > long_header)
            map.repairs.push_back(fmt::format(
                "The PGM header has {} bytes, nearly all of them comments; they were skipped.", next - bytes.data()));
        if (binary)
            skip_to_samples(std::ptrdiff_t{map.width} * map.height * sample_bytes);
        for (int y = map.height - 1; y >= 0; --y)
            for (int x = 0; x < map.width; ++x) {
                unsigned sample = binary ? 0 : number("a sample", 0, most);
                for (int k = 0; binary && k < sample_bytes; ++k)
                    sample = sample << 8 | static_cast<unsigned char>(*next++);
                if (sample > most)
                    refuse(
                        fmt::format("the sample before byte {} of the PGM file is {}, more than its maximum value {}.",
                                    next - bytes.data(), sample, most));
                map.at(x, y) = static_cast<float>(static_cast<double>(sample) / static_cast<double>(most));
            }
        if (!binary && next == end)
            map.repairs.emplace_back(
                "The P2 file ends right after its last digit; it was read as complete, but may have been "
                "cut off.");
        if (!binary)
            skip_space_and_comments();
        if (next != end)
            map.repairs.push_back(fmt::format(
                "{} bytes after the PGM file's last sample were ignored; only its first image is read.", end - next));
        return map;
    }
};

}  // namespace

HeightMap read_pgm(const std::filesystem::path& path) {
    return PgmFile{path.string(), map_file_bytes(path)}.read();
}

}  // namespace tessera
