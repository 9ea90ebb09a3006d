#include "testbench/meshes/obj_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "testbench/common/error.h"
#include "testbench/meshes/mesh_limits.h"
#include "testbench/meshes/mesh_text.h"

namespace tessera {
namespace {

class Reader {
  public:
    Reader(std::string_view text, std::string const& name) : text_(text), name_(name) {}

    ObjText read() {
        check_encoding();
        while (next_statement()) {
            statement();
        }
        finish();
        return std::move(out_);
    }

  private:
    [[noreturn]] void fail(std::size_t line, std::string const& what) const {
        throw InputError(fmt::format("{}:{}: {}", name_, line, what));
    }
    [[noreturn]] void fail(std::string const& what) const { fail(line_, what); }
    [[noreturn]] void too_much(std::string const& what) const {
        throw ResourceError(fmt::format("{}:{}: {}", name_, line_, what));
    }

    void check_encoding() {
        using namespace std::string_view_literals;
        if (text_.substr(0, 2) == "\xff\xfe"sv || text_.substr(0, 2) == "\xfe\xff"sv) {
            fail(1, "the file is UTF-16 text: save it as UTF-8 or ASCII");
        }
        if (text_.substr(0, 3) == "\xef\xbb\xbf"sv) {
            text_.remove_prefix(3);
        }
        if (const std::string_view kind = foreign_mesh_kind(text_); !kind.empty()) {
            throw InputError(
                fmt::format("{}: this is {}, and mesh.file takes OBJ: open it in Blender, MeshLab or the "
                            "like, export it as OBJ "
                            "with texture coordinates, and name that file",
                            name_, kind));
        }
        const std::size_t zero = text_.find('\0');
        if (zero != std::string_view::npos) {
            const auto lines =
                std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(zero), '\n');
            fail(static_cast<std::size_t>(lines) + 1,
                 "a zero byte: the file is not text, so no OBJ, or it is damaged; export it again");
        }
    }

    /// The next physical line, without its end. A lone CR ends one too (old Macintosh files).
    std::string_view next_line() {
        const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
        const std::string_view line = text_.substr(at_, end - at_);
        at_ = std::min(end + (text_.substr(end, 2) == "\r\n" ? 2 : 1), text_.size());
        ++next_line_number_;
        return line;
    }

    static bool continues(std::string_view line) {
        const std::size_t last = line.find_last_not_of(" \t");
        return last != std::string_view::npos && line[last] == '\\';
    }

    /// Puts the next statement's words into tokens_. False at the end of the file.
    bool next_statement() {
        while (at_ < text_.size()) {
            line_ = next_line_number_;
            std::string_view line = next_line();
            const std::size_t start = line.find_first_not_of(" \t");
            if (start == std::string_view::npos || line[start] == '#') {
                continue;  // a comment does not continue: Windows paths in comments end in a backslash
            }
            if (continues(line)) {
                joined_.clear();
                while (continues(line)) {
                    joined_.append(line.substr(0, line.find_last_of('\\'))).push_back(' ');
                    if (at_ >= text_.size()) {
                        fail("the file ends in a line continuation: it is cut off; export it again");
                    }
                    line = next_line();
                }
                joined_.append(line);
                line = joined_;
            }
            split(line);
            if (!tokens_.empty()) {
                return true;
            }
        }
        return false;
    }

    void split(std::string_view line) {
        tokens_.clear();
        std::size_t start = line.find_first_not_of(" \t");
        while (start != std::string_view::npos && line[start] != '#') {
            const std::size_t end = std::min(line.find_first_of(" \t", start), line.size());
            tokens_.push_back(line.substr(start, end - start));
            start = line.find_first_not_of(" \t", end);
        }
    }

    void statement() {
        const std::string_view keyword = tokens_.front();
        if (keyword == "v") {
            numbers({3, 4, 6, 7}, "x y z, x y z w, or either with a colour r g b");
            limit_records(out_.positions.size(), "v");
            out_.positions.push_back({values_[0], values_[1], values_[2]});
        } else if (keyword == "vt") {
            numbers({1, 2, 3}, "u, u v, or u v w");
            limit_records(out_.textures.size(), "vt");
            out_.textures.push_back({values_[0], tokens_.size() > 2 ? values_[1] : 0});
        } else if (keyword == "vn") {
            numbers({3}, "x y z");
            limit_records(out_.normals.size(), "vn");
            out_.normals.push_back({values_[0], values_[1], values_[2]});
        } else if (keyword == "f" || keyword == "fo") {
            face();
        } else if (keyword == "surf") {
            count(free_form_, free_form_line_);
        } else if (!is_skipped(keyword)) {
            if (unknown_ == 0) {
                unknown_keyword_ = quoted(keyword);
            }
            count(unknown_, unknown_line_);
        }
    }

    void count(std::size_t& counter, std::size_t& first_line) const {
        if (counter++ == 0) {
            first_line = line_;
        }
    }

    static bool is_skipped(std::string_view keyword) {
        constexpr std::array<std::string_view, 41> skipped{
            "vp",     "deg",        "bmat",      "step",     "cstype",   "p",   "l",      "curv",   "curv2",
            "parm",   "trim",       "hole",      "scrv",     "sp",       "end", "con",    "g",      "s",
            "mg",     "o",          "bevel",     "c_interp", "d_interp", "lod", "usemtl", "mtllib", "usemap",
            "maplib", "shadow_obj", "trace_obj", "ctech",    "stech",    "bsp", "bzp",    "cdc",    "cdp",
            "res",    "call",       "csh",       "vw",       "t"};
        return std::find(skipped.begin(), skipped.end(), keyword) != skipped.end();
    }

    void limit_records(std::size_t have, char const* keyword) const {
        if (have >= largest_obj_records) {
            too_much(fmt::format("more than {} `{}` lines, the limit of one file: split or simplify the mesh",
                                 largest_obj_records, keyword));
        }
    }

    /// Checks the statement's numbers and leaves the first three in values_.
    void numbers(std::initializer_list<std::size_t> counts, char const* form) {
        const std::size_t count = tokens_.size() - 1;
        if (std::find(counts.begin(), counts.end(), count) == counts.end()) {
            fail(fmt::format("`{}` with {} number(s): it takes {}; correct the line or export the file again",
                             tokens_.front(), count, form));
        }
        for (std::size_t i = 0; i < count; ++i) {
            const std::string_view token = tokens_[i + 1];
            const std::optional<double> value = to_number(token);
            if (!value) {
                const bool comma = token.find(',') != std::string_view::npos;
                fail(fmt::format("{} in `{}` is not a number: {}", quoted(token), tokens_.front(),
                                 comma ? "write decimals with a point, numbers apart with blanks"
                                       : "correct the line or export the file again"));
            }
            if (!(std::abs(*value) <= largest_coordinate)) {  // also catches nan
                fail(fmt::format(
                    "{} in `{}` is not a finite number of single precision (at most {:g}): correct the "
                    "line or export the file again",
                    quoted(token), tokens_.front(), largest_coordinate));
            }
            if (i < values_.size()) {
                values_[i] = *value;
            }
        }
    }

    void face() {
        const std::size_t count = tokens_.size() - 1;
        if (count < 3) {
            fail(fmt::format(
                "a face with {} corner(s): it needs three or more; delete the line or export the file again",
                count));
        }
        if (count > largest_face_corners) {
            too_much(fmt::format(
                "a face with {} corners, the limit is {}: triangulate the mesh in the program that made "
                "it",
                count, largest_face_corners));
        }
        triangles_ += count - 2;
        if (triangles_ > largest_base_triangles) {
            too_much(fmt::format(
                "more than {} base triangles, the limit: simplify the mesh, the tessellator refines it",
                largest_base_triangles));
        }
        out_.faces.push_back({out_.corners.size(), static_cast<std::uint32_t>(count), line_});
        for (std::size_t i = 1; i <= count; ++i) {
            const ObjText::Corner corner = this->corner(tokens_[i]);
            if (i > 1) {
                ObjText::Corner const& before = out_.corners.back();
                if ((before.texture == ObjText::none) != (corner.texture == ObjText::none) ||
                    (before.normal == ObjText::none) != (corner.normal == ObjText::none)) {
                    fail(fmt::format(
                        "face corners {} and {} are of different forms: all corners of a face must be v, "
                        "v/vt, v//vn or v/vt/vn alike",
                        quoted(tokens_[i - 1]), quoted(tokens_[i])));
                }
            }
            out_.corners.push_back(corner);
        }
    }

    ObjText::Corner corner(std::string_view token) const {
        std::array<std::string_view, 3> parts;
        std::size_t count = 0, start = 0;
        for (;;) {
            const std::size_t end = std::min(token.find('/', start), token.size());
            if (count == parts.size()) {
                fail_corner(token, "has more than three parts");
            }
            parts[count++] = token.substr(start, end - start);
            if (end == token.size()) {
                break;
            }
            start = end + 1;
        }
        if (parts[count - 1].empty()) {
            fail_corner(token, count == 1 ? "is empty" : "ends in a slash");
        }
        ObjText::Corner corner;
        corner.position = index(token, parts[0], out_.positions.size());
        if (!parts[1].empty()) {
            corner.texture = index(token, parts[1], out_.textures.size());
        }
        if (!parts[2].empty()) {
            corner.normal = index(token, parts[2], out_.normals.size());
        }
        return corner;
    }

    [[noreturn]] void fail_corner(std::string_view token, char const* what) const {
        fail(fmt::format("face corner {} {}: it must be v, v/vt, v//vn or v/vt/vn, whole numbers",
                         quoted(token), what));
    }

    /// From 0. A positive index may name a vertex that is still to come: its range is checked in finish().
    std::uint32_t index(std::string_view token, std::string_view part, std::size_t have) const {
        if (part.size() > 1 && part.front() == '+' && part[1] != '-') {
            part.remove_prefix(1);
        }
        std::int64_t value = 0;
        char const* end = part.data() + part.size();
        const auto [stop, error] = std::from_chars(part.data(), end, value);
        if (stop != end || (error != std::errc() && error != std::errc::result_out_of_range)) {
            fail_corner(token, "holds something else than whole numbers");
        }
        if (error == std::errc() && value == 0) {
            fail(fmt::format("face corner {} names index 0: indices run from 1, or from -1 backwards",
                             quoted(token)));
        }
        if (error != std::errc() || value > static_cast<std::int64_t>(largest_obj_records) ||
            value < -static_cast<std::int64_t>(have)) {
            fail(fmt::format("face corner {} names index {}, out of range: {} are defined up to here",
                             quoted(token), quoted(part), have));
        }
        return static_cast<std::uint32_t>(value > 0 ? value - 1 : static_cast<std::int64_t>(have) + value);
    }

    void check_range(std::size_t line, std::uint32_t index, std::size_t have, char const* keyword) const {
        if (index == ObjText::none || index < have) {
            return;
        }
        if (have == 0 && keyword == std::string_view("vt")) {
            fail(line,
                 fmt::format("a face names texture coordinate {}, but the file has no `vt` line, and the "
                             "displacement map needs texture coordinates: export the mesh with them",
                             index + 1));
        }
        fail(line,
             fmt::format(
                 "a face names `{}` number {}, the file has {}: correct the line or export the file again",
                 keyword, index + 1, have));
    }

    void finish() {
        if (out_.faces.empty()) {
            throw InputError(fmt::format(
                "{}: no face (`f` line) in {} line(s){}: is it a Wavefront OBJ file with polygons?", name_,
                next_line_number_ - 1,
                unknown_ > 0 ? fmt::format(", but {} of other words ({} in line {} first)", unknown_,
                                           unknown_keyword_, unknown_line_)
                             : ""));
        }
        for (ObjText::Face const& face : out_.faces) {
            for (std::size_t i = face.first; i < face.first + face.count; ++i) {
                check_range(face.line, out_.corners[i].position, out_.positions.size(), "v");
                check_range(face.line, out_.corners[i].texture, out_.textures.size(), "vt");
                check_range(face.line, out_.corners[i].normal, out_.normals.size(), "vn");
            }
        }
        if (unknown_ > 0) {
            out_.repairs.push_back(
                fmt::format("{} line(s) begin with a word that is not OBJ and were skipped, the first "
                            "is line {}: {}.",
                            unknown_, unknown_line_, unknown_keyword_));
        }
        if (free_form_ > 0) {
            out_.repairs.push_back(
                fmt::format("{} free-form surface(s) (`surf`, the first in line {}) were skipped: only "
                            "polygons are read.",
                            free_form_, free_form_line_));
        }
    }

    std::string_view text_;
    std::string const& name_;
    std::size_t at_ = 0, line_ = 1, next_line_number_ = 1;
    std::string joined_;                    // a statement of several lines
    std::vector<std::string_view> tokens_;  // the statement's words, the keyword first
    std::array<double, 3> values_{};
    std::size_t triangles_ = 0;
    std::size_t unknown_ = 0, unknown_line_ = 0, free_form_ = 0, free_form_line_ = 0;
    std::string unknown_keyword_;
    ObjText out_;
};

}  // namespace

ObjText read_obj_text(std::string_view text, std::string const& name) {
    return Reader(text, name).read();
}

}  // namespace tessera
