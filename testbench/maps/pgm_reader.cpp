#include "testbench/maps/pgm_reader.h"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/maps/map_file.h"

namespace tessera {
namespace {

constexpr std::size_t long_header = 4096;

bool is_space(std::uint8_t c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\v' || c == '\f' || c == '\r';
}

class PgmParser {
  public:
    explicit PgmParser(const std::filesystem::path& path)
        : name_(path.string()), bytes_(map_file_bytes(path)) {}

    HeightMap parse();

  private:
    [[noreturn]] void refuse(std::string_view why) const {
        throw InputError(fmt::format("{}: {}", name_, why));
    }
    bool at_end() const { return position_ >= bytes_.size(); }
    std::size_t remaining() const { return bytes_.size() - position_; }

    void skip_comment() {
        while (!at_end() && bytes_[position_] != '\n' && bytes_[position_] != '\r') {
            ++position_;
        }
    }

    void skip_space_and_comments() {
        while (!at_end() && (is_space(bytes_[position_]) || bytes_[position_] == '#')) {
            if (bytes_[position_] == '#') {
                skip_comment();
            } else {
                ++position_;
            }
        }
    }

    std::string token_at(std::size_t start) const {
        std::size_t end = start;
        while (end < bytes_.size() && !is_space(bytes_[end])) {
            ++end;
        }
        const std::string_view text(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
        return printable_ascii(text.substr(start, end - start));
    }

    // `what` is called for a message only: a P2 map has millions of numbers.
    template <class What>
    std::int64_t number(What&& what, std::int64_t limit) {
        skip_space_and_comments();
        if (at_end()) {
            refuse(fmt::format("the PGM file ends before {}. It was cut off.", what()));
        }
        const std::size_t start = position_;
        std::int64_t value = 0;
        while (!at_end() && bytes_[position_] >= '0' && bytes_[position_] <= '9') {
            value = value * 10 + (bytes_[position_] - '0');
            ++position_;
            if (value > limit) {
                refuse(fmt::format("{} is {}, more than {}. Save the PGM file anew.", what(), token_at(start),
                                   limit));
            }
        }
        if (position_ == start || (!at_end() && !is_space(bytes_[position_]) && bytes_[position_] != '#')) {
            refuse(fmt::format("{} should be a decimal number, not \"{}\" (byte {} of the PGM file).", what(),
                               token_at(start), start));
        }
        return value;
    }

    void read_text(HeightMap& map, std::int64_t maxval);
    void read_binary(HeightMap& map, std::int64_t maxval);

    std::string name_;
    std::vector<std::uint8_t> bytes_;
    std::size_t position_ = 0;
};

HeightMap PgmParser::parse() {
    constexpr std::int64_t any = 999'999'999;  // the true limits have messages of their own
    const bool binary = bytes_[1] == '5';
    position_ = 2;
    if (!at_end() && !is_space(bytes_[2]) && bytes_[2] != '#') {
        refuse("\"P2\" or \"P5\" is not followed by white space. This is no PGM file, or a damaged one.");
    }
    const std::int64_t width = number([] { return "the width"; }, any);
    const std::int64_t height = number([] { return "the height"; }, any);
    check_map_sides(name_, width, height);
    const std::int64_t maxval = number([] { return "the maximum value"; }, any);
    if (maxval < 1 || maxval > 65535) {
        refuse(fmt::format("the PGM file's maximum value is {}; it must be 1 to 65535.", maxval));
    }
    HeightMap map;
    map.width = static_cast<int>(width);
    map.height = static_cast<int>(height);
    map.source_units = static_cast<double>(maxval);
    if (position_ > long_header) {
        map.repairs.push_back(fmt::format(
            "The PGM header has {} bytes, nearly all of them comments; they were skipped.", position_));
    }
    if (binary) {
        read_binary(map, maxval);
    } else {
        read_text(map, maxval);
    }
    if (!at_end()) {
        map.repairs.push_back(fmt::format(
            "{} bytes after the PGM file's last sample were ignored; only its first image is read.",
            remaining()));
    }
    return map;
}

void PgmParser::read_binary(HeightMap& map, std::int64_t maxval) {
    const auto width = static_cast<std::size_t>(map.width);
    const auto height = static_cast<std::size_t>(map.height);
    const std::size_t sample_size = maxval > 255 ? 2 : 1;
    const std::size_t needed = width * height * sample_size;
    if (at_end()) {
        refuse("the PGM file ends after its header. It was cut off.");
    }
    if (bytes_[position_] == '#') {  // like libnetpbm: a comment's line end is the one white-space character
        skip_comment();
    }
    const bool carriage_return = !at_end() && bytes_[position_] == '\r';
    if (!at_end()) {
        ++position_;
    }
    if (carriage_return && remaining() == needed + 1 && bytes_[position_] == '\n') {
        ++position_;
    }
    if (remaining() < needed) {
        refuse(fmt::format(
            "the PGM file holds {} of the {} sample bytes that {} x {} texels of {} bits need. It was cut "
            "off, or its header is wrong.",
            remaining(), needed, width, height, 8 * sample_size));
    }
    map.values.resize(width * height);
    for (std::size_t row = 0; row < height; ++row) {
        float* const line = map.values.data() + (height - 1 - row) * width;
        for (std::size_t column = 0; column < width; ++column) {
            std::int64_t sample = bytes_[position_++];
            if (sample_size == 2) {
                sample = sample * 256 + bytes_[position_++];
            }
            if (sample > maxval) {
                refuse(fmt::format(
                    "the sample in column {}, row {} (from the top) is {}, more than the PGM file's maximum "
                    "value {}.",
                    column, row, sample, maxval));
            }
            line[column] = static_cast<float>(static_cast<double>(sample) / static_cast<double>(maxval));
        }
    }
}

void PgmParser::read_text(HeightMap& map, std::int64_t maxval) {
    const auto width = static_cast<std::size_t>(map.width);
    const auto height = static_cast<std::size_t>(map.height);
    const std::size_t least = 2 * width * height;  // white space and one digit each
    if (remaining() < least) {
        refuse(fmt::format(
            "the PGM file has {} bytes left for {} x {} samples, which need at least {}. It was cut off, or "
            "its header is wrong.",
            remaining(), width, height, least));
    }
    map.values.resize(width * height);
    for (std::size_t row = 0; row < height; ++row) {
        float* const line = map.values.data() + (height - 1 - row) * width;
        for (std::size_t column = 0; column < width; ++column) {
            const auto what = [&] {
                return fmt::format("the sample in column {}, row {} (from the top)", column, row);
            };
            const std::int64_t sample = number(what, maxval);
            line[column] = static_cast<float>(static_cast<double>(sample) / static_cast<double>(maxval));
        }
    }
    if (at_end()) {
        map.repairs.push_back(
            "The P2 file ends right after its last digit; it was taken as complete, but may have been cut "
            "off.");
    }
    skip_space_and_comments();
}

}  // namespace

HeightMap read_pgm(const std::filesystem::path& path) {
    return PgmParser(path).parse();
}

}  // namespace tessera
