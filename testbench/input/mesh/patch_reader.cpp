#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "testbench/common/error.h"
#include "testbench/input/mesh/bezier_patches.h"
#include "testbench/input/mesh/mesh_limits.h"
#include "testbench/input/mesh/mesh_text.h"

namespace tessera {
namespace {

constexpr const char* blank_characters = " \t\r";

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(blank_characters);
    return first == std::string_view::npos ? std::string_view()
                                           : text.substr(first, text.find_last_not_of(blank_characters) - first + 1);
}

class PatchReader {
  public:
    PatchReader(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

    BezierPatches read() {
        const std::size_t patches = count("patches", largest_base_triangles);
        for (std::size_t k = 0; k < patches; ++k) {
            read_numbers(16, fmt::format("patch {} of {}", k + 1, patches));
            for (std::size_t i = 0; i < 16; ++i)
                indices_[i] = index(numbers_[i]);
            result_.patches.push_back(indices_);
            lines_.push_back(line_);
        }
        const std::size_t points = count("points", largest_obj_records);
        for (std::size_t k = 0; k < points; ++k) {
            read_numbers(3, fmt::format("point {} of {}", k + 1, points));
            glm::dvec3 point;
            for (int i = 0; i < 3; ++i)
                point[i] = coordinate(numbers_[static_cast<std::size_t>(i)]);
            result_.points.push_back(point);
        }
        if (next_line()) {
            fail(fmt::format("{} after the last of {} points: correct the number of points, or delete the rest",
                             quoted(words_), points));
        }
        check_indices();
        return std::move(result_);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(fmt::format("{}:{}: {}", name_, line_, what));
    }

    /// Splits the next line that is not empty into words_. False at the end of the file.
    bool next_line() {
        while (!rest_.empty()) {
            const std::size_t end = rest_.find('\n');
            words_ = trimmed(rest_.substr(0, end));
            rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
            ++line_;
            if (!words_.empty())
                return true;
        }
        return false;
    }

    /// Reads the next line's numbers into numbers_. `what`: their meaning, for messages.
    void read_numbers(std::size_t wanted, const std::string& what) {
        if (!next_line())
            fail(fmt::format("the file ends before {}: it is cut off, or its count is wrong", what));
        numbers_.clear();
        std::string_view row = words_;
        for (bool more = true; more;) {
            const std::size_t comma = row.find(',');
            numbers_.push_back(trimmed(row.substr(0, comma)));
            more = comma != std::string_view::npos;
            row.remove_prefix(more ? comma + 1 : row.size());
        }
        if (numbers_.size() != wanted) {
            fail(fmt::format("{} is {} with {} number(s): expected {}, separated by commas", what, quoted(words_),
                             numbers_.size(), wanted));
        }
    }

    std::size_t whole_number(std::string_view word, const char* what, std::size_t most) {
        const std::optional<double> number = to_number(word);
        if (!number || !(*number >= 1) || std::floor(*number) != *number)
            fail(fmt::format("{} is not a number of {}: expected a whole number from 1", quoted(word), what));
        if (*number > static_cast<double>(most)) {
            throw ResourceError(fmt::format("{}:{}: {} {}, the limit is {}: use a part of the model", name_, line_,
                                            quoted(word), what, most));
        }
        return static_cast<std::size_t>(*number);
    }

    std::size_t count(const char* what, std::size_t most) {
        read_numbers(1, fmt::format("the number of {}", what));
        return whole_number(numbers_.front(), what, most);
    }

    std::uint32_t index(std::string_view word) {
        const std::optional<double> number = to_number(word);
        if (!number || !(*number >= 1 && *number <= static_cast<double>(largest_obj_records)) ||
            std::floor(*number) != *number)
            fail(fmt::format("{} is not a point number: points are counted from 1", quoted(word)));
        return static_cast<std::uint32_t>(*number) - 1;
    }

    double coordinate(std::string_view word) {
        const std::optional<double> number = to_number(word);
        if (!number || !(std::abs(*number) <= largest_coordinate)) {
            fail(fmt::format("{} is not a coordinate: expected a number of at most {:g}", quoted(word),
                             largest_coordinate));
        }
        return *number;
    }

    /// Indices are checked at the end, since points follow the patches.
    void check_indices() {
        for (std::size_t k = 0; k < result_.patches.size(); ++k) {
            for (const std::uint32_t i : result_.patches[k]) {
                if (i >= result_.points.size()) {
                    line_ = lines_[k];
                    fail(fmt::format("patch {} names point {}, but the file has {}: correct the number", k + 1, i + 1,
                                     result_.points.size()));
                }
            }
        }
    }

    std::string_view rest_;
    const std::string& name_;
    std::size_t line_ = 0;
    std::string_view words_;
    std::vector<std::string_view> numbers_;
    std::array<std::uint32_t, 16> indices_{};
    std::vector<std::size_t> lines_;  // per patch
    BezierPatches result_;
};

}  // namespace

BezierPatches parse_bezier_patches(std::string_view text, const std::string& name) {
    return PatchReader(text, name).read();
}

BezierPatches read_bezier_patches(const std::string& path) {
    return parse_bezier_patches(read_mesh_text(path, "a file of Bezier patches"), path);
}

}  // namespace tessera
