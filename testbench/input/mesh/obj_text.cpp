#include "testbench/input/mesh/obj_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

#include "testbench/common/error.h"
#include "testbench/input/mesh/mesh_limits.h"
#include "testbench/input/mesh/mesh_text.h"

namespace tessera {
namespace {

constexpr std::string_view blanks = " \t";

/// Removes the first word of `text` and returns it; empty if there is none.
std::string_view next_word(std::string_view& text) {
    const std::size_t start = std::min(text.find_first_not_of(blanks), text.size());
    const std::size_t end = std::min(text.find_first_of(blanks, start), text.size());
    const std::string_view word = text.substr(start, end - start);
    text.remove_prefix(end);
    return word;
}

/// Statements of an OBJ file that are irrelevant to polygons.
bool is_skipped(std::string_view keyword) {
    constexpr std::array<std::string_view, 20> skipped{
        "g",    "o",     "mg",    "usemtl",   "mtllib",   "usemap", "maplib",     "l",         "p",     "vp",
        "curv", "curv2", "bevel", "c_interp", "d_interp", "lod",    "shadow_obj", "trace_obj", "ctech", "stech"};
    return std::find(skipped.begin(), skipped.end(), keyword) != skipped.end();
}

class Reader {
  public:
    Reader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    ObjText read() {
        check_kind();
        while (at_ < text_.size()) {
            next_statement();
            read_statement();
        }
        check_indices();
        if (unknown_ > 0) {
            out_.repairs.push_back(
                fmt::format("{} line(s) begin with an unknown keyword and were skipped, the first is "
                            "line {}: {}.",
                            unknown_, unknown_line_, unknown_keyword_));
        }
        if (out_.normals.empty() && used_smoothing_.size() > 1)
            out_.repairs.emplace_back(
                "Smoothing groups (`s`) are not used: the normals are smooth everywhere. Export the mesh with normals.");
        return std::move(out_);
    }

  private:
    struct List {
        std::string_view keyword;
        int fewest, most;       ///< limits on the numbers in a statement
        std::size_t count = 0;  ///< statements so far
    };

    [[noreturn]] void fail(std::size_t line, const std::string& what) const {
        throw InputError(fmt::format("{}:{}: {}; correct the line or export the file again", name_, line, what));
    }
    [[noreturn]] void fail(const std::string& what) const { fail(line_, what); }

    void limit(std::size_t count, std::size_t largest, const char* of_what) const {
        if (count > largest) {
            throw ResourceError(
                fmt::format("{}:{}: more than {} {}, the limit: simplify the mesh, the tessellator refines it", name_,
                            line_, largest, of_what));
        }
    }

    void check_kind() {
        constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
        if (text_.substr(0, 3) == byte_order_mark)
            text_.remove_prefix(3);
        if (const std::string_view kind = foreign_mesh_kind(text_); !kind.empty()) {
            throw InputError(
                fmt::format("{}: this is {}, but mesh.file must be OBJ: open it in Blender, MeshLab or the "
                            "like, export it as OBJ with texture coordinates, and name that file",
                            name_, kind));
        }
        if (text_.find('\0') != std::string_view::npos) {
            throw InputError(
                fmt::format("{}: a zero byte: the file is UTF-16, not text, or damaged: save it as UTF-8 or "
                            "export it again",
                            name_));
        }
    }

    /// Reads a line with its continuation lines (after a `\` at the end), without comments.
    void next_statement() {
        statement_.clear();
        line_ = next_line_;
        for (bool continued = true; continued;) {
            if (at_ >= text_.size())
                fail("the file ends in a line continuation");
            const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
            std::string_view line = text_.substr(at_, end - at_);
            line = line.substr(0, line.find('#'));
            at_ = end + (text_.substr(end, 2) == "\r\n" ? 2 : 1);
            ++next_line_;
            const std::size_t last = line.find_last_not_of(blanks);
            continued = last != std::string_view::npos && line[last] == '\\';
            (statement_ += line.substr(0, continued ? last : line.size())) += ' ';
        }
    }

    void read_statement() {
        std::string_view rest = statement_;
        const std::string_view keyword = next_word(rest);
        if (keyword == "v") {
            out_.positions.push_back(numbers(lists_[0], rest));
        } else if (keyword == "vt") {
            out_.textures.emplace_back(numbers(lists_[1], rest));
        } else if (keyword == "vn") {
            out_.normals.push_back(numbers(lists_[2], rest));
        } else if (keyword == "f" || keyword == "fo") {
            face(rest);
        } else if (keyword == "s") {
            smoothing_ = next_word(rest);
            smoothing_ = smoothing_ == "0" ? "off" : smoothing_;
        } else if (!keyword.empty() && !is_skipped(keyword) && unknown_++ == 0) {
            unknown_keyword_ = quoted(keyword);
            unknown_line_ = line_;
        }
    }

    /// The first three numbers of a statement; all are checked.
    glm::dvec3 numbers(List& list, std::string_view rest) const {
        glm::dvec3 first(0);
        int count = 0;
        for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
            const double value = to_number(word).value_or(HUGE_VAL);
            if (!(std::abs(value) <= largest_coordinate)) {
                fail(fmt::format("{} in `{}` is not a number up to {:g}, with a decimal point and surrounded by blanks",
                                 quoted(word), list.keyword, largest_coordinate));
            }
            if (count < 3)
                first[count] = value;
            ++count;
        }
        if (count < list.fewest || count > list.most)
            fail(fmt::format("`{}` with {} number(s): expected {} to {}", list.keyword, count, list.fewest, list.most));
        limit(++list.count, largest_obj_records, "lines of vertices");
        return first;
    }

    void face(std::string_view rest) {
        ObjText::Face face{out_.corners.size(), 0, line_};
        if (!smoothing_.empty() && used_smoothing_.size() < 2)
            used_smoothing_.insert(smoothing_);
        for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
            limit(++face.count, largest_face_corners, "corners of a face");
            const std::optional<ObjText::Corner> corner = this->corner(word);
            if (!corner) {
                fail(
                    fmt::format("face corner {}: expected v, v/vt, v//vn or v/vt/vn, whole numbers from 1, or "
                                "from -1 backwards to the first defined",
                                quoted(word)));
            }
            out_.corners.push_back(*corner);
        }
        if (face.count < 3)
            fail(fmt::format("a face with {} corner(s): expected three or more", face.count));
        triangles_ += face.count - 2;
        limit(triangles_, largest_base_triangles, "base triangles");
        out_.faces.push_back(face);
    }

    /// Nothing if the word is not a corner. Indices beyond the current vertices are accepted, as these may follow.
    std::optional<ObjText::Corner> corner(std::string_view word) const {
        std::array<std::uint32_t, 3> indices{ObjText::none, ObjText::none, ObjText::none};
        for (std::size_t k = 0; k < lists_.size(); ++k) {
            const std::size_t end = std::min(word.find('/'), word.size());
            const auto have = static_cast<std::int64_t>(lists_[k].count);
            std::int64_t index = 0;
            const auto [stop, error] = std::from_chars(word.data(), word.data() + end, index);
            if (error == std::errc() && stop == word.data() + end && index != 0 && index >= -have &&
                index <= static_cast<std::int64_t>(largest_obj_records))
                indices[k] = static_cast<std::uint32_t>(index > 0 ? index - 1 : have + index);
            else if (k != 1 || end > 0 || word.size() < 2)  // only the second of three may be omitted
                return std::nullopt;
            if (end == word.size())
                return ObjText::Corner{indices[0], indices[1], indices[2]};
            word.remove_prefix(end + 1);
        }
        return std::nullopt;
    }

    void check_indices() const {
        if (out_.faces.empty()) {
            throw InputError(
                fmt::format("{}: no face (`f` line) in {} line(s){}: is it a Wavefront OBJ file with polygons?", name_,
                            next_line_ - 1,
                            unknown_ > 0 ? fmt::format(", but {} with other keywords (the first is {} in line {})",
                                                       unknown_, unknown_keyword_, unknown_line_)
                                         : ""));
        }
        for (const ObjText::Face& face : out_.faces) {
            for (std::size_t i = face.first; i < face.first + face.count; ++i) {
                const ObjText::Corner& corner = out_.corners[i];
                const std::array<std::uint32_t, 3> indices{corner.position, corner.texture, corner.normal};
                for (std::size_t k = 0; k < lists_.size(); ++k) {
                    if (indices[k] != ObjText::none && indices[k] >= lists_[k].count) {
                        fail(face.line, fmt::format("a face names `{}` number {}, but the file has {}",
                                                    lists_[k].keyword, indices[k] + 1, lists_[k].count));
                    }
                }
            }
        }
    }

    std::string_view text_;
    const std::string& name_;
    std::size_t at_ = 0, line_ = 1, next_line_ = 1;
    std::string statement_;  // all its lines joined
    std::array<List, 3> lists_{{{"v", 3, 7}, {"vt", 1, 3}, {"vn", 3, 3}}};
    std::size_t triangles_ = 0;
    std::size_t unknown_ = 0, unknown_line_ = 0;
    std::string unknown_keyword_;
    std::string smoothing_;                 // the group of the next faces; empty before the first
    std::set<std::string> used_smoothing_;  // up to two
    ObjText out_;
};

}  // namespace

ObjText read_obj_text(std::string_view text, const std::string& name) {
    return Reader(text, name).read();
}

}  // namespace tessera
