#include "testbench/run_folder/ply_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>

#include "testbench/common/error.h"

namespace tessera {
namespace {

constexpr std::uint64_t vertex_bytes = 52, face_bytes = 20;
constexpr double largest_number = 1e40;  // base meshes reach 3.4e38 (mesh_limits.h), displaced ones slightly more
constexpr std::size_t longest_line = 256, most_lines = 64;
constexpr std::uint64_t most_elements = std::numeric_limits<std::int32_t>::max();  // indices are signed

class PlyFile {
  public:
    explicit PlyFile(const std::filesystem::path& path) : path_(path) {
        std::error_code failed;
        const std::filesystem::file_status status = std::filesystem::status(path, failed);
        if (status.type() == std::filesystem::file_type::not_found)
            refuse("no such file");
        if (status.type() != std::filesystem::file_type::regular)
            refuse("this is not a file that can be read as a mesh");
        size_ = std::filesystem::file_size(path, failed);
        file_.open(path, std::ios::binary);
        if (failed || !file_)
            refuse("the file cannot be read, check its permissions");
    }

    [[noreturn]] void refuse(const std::string& why) const {
        throw InputError(fmt::format("{}: {}; run the job again (`tessera run`) to get a mesh.ply that can be read",
                                     path_.string(), why));
    }

    /// A header line without its line end.
    std::string line() {
        if (++lines_ > most_lines)
            refuse(fmt::format("the header has more than {} lines", most_lines));
        std::string text;
        for (;;) {
            const int next = file_.get();
            if (next == std::char_traits<char>::eof())
                refuse(fmt::format("the file ends in line {} of its header, after {} bytes", lines_, size_));
            ++taken_;
            if (next == '\n')
                return text;
            if (text.size() == longest_line)
                refuse(fmt::format("line {} of the header is longer than {} characters", lines_, longest_line));
            text += static_cast<char>(next);
        }
    }

    void expect(const std::string& text, std::string_view wanted) const {
        if (text != wanted)
            refuse(
                fmt::format("line {} of the header is \"{}\", tessera writes \"{}\"", lines_, printable(text), wanted));
    }

    std::uint64_t expect_count(const std::string& text, std::string_view words) const {
        const std::string digits = text.substr(0, words.size()) == words ? text.substr(words.size()) : "";
        if (digits.empty() || digits.size() > 10 || digits.find_first_not_of("0123456789") != std::string::npos)
            refuse(fmt::format("line {} of the header is \"{}\", tessera writes \"{}\" and a number", lines_,
                               printable(text), words));
        const std::uint64_t count = std::stoull(digits);
        if (count > most_elements)
            refuse(fmt::format("line {} of the header, \"{}\": the limit is {}", lines_, text, most_elements));
        return count;
    }

    void expect_body(std::uint64_t bytes) const {
        if (size_ - taken_ != bytes)
            refuse(fmt::format("the file has {} bytes after its header, which announces {}", size_ - taken_, bytes));
    }

    /// Reads the next record; take() returns its numbers.
    void read(std::size_t bytes) {
        if (!file_.read(record_, static_cast<std::streamsize>(bytes)))
            refuse("the file cannot be read to its end");
        place_ = 0;
    }

    template <class Number>
    Number take() {
        std::uint64_t bits = 0;
        for (std::size_t k = 0; k < sizeof(Number); ++k)
            bits |= std::uint64_t{static_cast<unsigned char>(record_[place_++])} << (8 * k);
        Number number;
        if constexpr (sizeof(Number) == 8) {
            std::memcpy(&number, &bits, sizeof number);
        } else if constexpr (sizeof(Number) == 4) {
            const auto word = static_cast<std::uint32_t>(bits);
            std::memcpy(&number, &word, sizeof number);
        } else {
            number = static_cast<Number>(bits);
        }
        return number;
    }

    template <class Number>
    Number take_finite(const char* what, std::size_t vertex) {
        const Number number = take<Number>();
        if (!std::isfinite(number) || std::abs(static_cast<double>(number)) > largest_number)
            refuse(fmt::format("vertex {}: its {} is not a finite number of reasonable size", vertex, what));
        return number;
    }

  private:
    static std::string printable(const std::string& text) {
        std::string result;
        for (const char c : text.substr(0, 60))
            result += c >= ' ' && c <= '~' ? c : '?';
        return result;
    }

    std::filesystem::path path_;
    std::ifstream file_;
    std::uint64_t size_ = 0, taken_ = 0;
    std::size_t lines_ = 0;
    char record_[64] = {};
    std::size_t place_ = 0;
};

struct Counts {
    std::uint64_t vertices, faces;
};

Counts read_header(PlyFile& file) {
    file.expect(file.line(), "ply");
    file.expect(file.line(), "format binary_little_endian 1.0");
    std::string line = file.line();
    while (line.rfind("comment", 0) == 0)
        line = file.line();
    Counts counts{};
    counts.vertices = file.expect_count(line, "element vertex ");
    for (const char* const property :
         {"double x", "double y", "double z", "float nx", "float ny", "float nz", "double s", "double t"})
        file.expect(file.line(), fmt::format("property {}", property));
    counts.faces = file.expect_count(file.line(), "element face ");
    for (const char* const property :
         {"list uchar int vertex_indices", "uchar generation", "uchar split_by", "uchar stopped_by", "int base"})
        file.expect(file.line(), fmt::format("property {}", property));
    file.expect(file.line(), "end_header");
    return counts;
}

}  // namespace

RecordedMesh read_ply(const std::filesystem::path& path) {
    PlyFile file(path);
    const Counts counts = read_header(file);
    file.expect_body(counts.vertices * vertex_bytes + counts.faces * face_bytes);

    RecordedMesh mesh;
    mesh.positions.resize(counts.vertices);
    mesh.normals.resize(counts.vertices);
    mesh.textures.resize(counts.vertices);
    mesh.triangles.resize(counts.faces);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        file.read(vertex_bytes);
        for (int k = 0; k < 3; ++k)
            mesh.positions[v][k] = file.take_finite<double>("position", v);
        for (int k = 0; k < 3; ++k)
            mesh.normals[v][k] = file.take_finite<float>("normal", v);
        for (int k = 0; k < 2; ++k)
            mesh.textures[v][k] = file.take_finite<double>("texture coordinate", v);
    }
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
        RecordedMesh::Triangle& t = mesh.triangles[f];
        file.read(face_bytes);
        if (const auto corners = file.take<std::uint8_t>(); corners != 3)
            file.refuse(fmt::format("face {} has {} corners, not 3", f, corners));
        for (std::uint32_t& vertex : t.vertices) {
            vertex = file.take<std::uint32_t>();
            if (vertex >= counts.vertices)
                file.refuse(fmt::format("face {} names vertex {} of {}", f, vertex, counts.vertices));
        }
        t.generation = file.take<std::uint8_t>();
        t.split_by = file.take<std::uint8_t>();
        t.stopped_by = file.take<std::uint8_t>();
        t.base = file.take<std::uint32_t>();
        if ((t.split_by & ~(3 | 32)) != 0)
            file.refuse(fmt::format("face {}: split_by is {}, neither 0 to 3 nor that plus 32", f, t.split_by));
        if ((t.stopped_by & ~(4 | 8 | 16)) != 0)
            file.refuse(fmt::format("face {}: stopped_by is {}, not a sum of 4, 8 and 16", f, t.stopped_by));
        if (t.base > most_elements)
            file.refuse(fmt::format("face {}: its base triangle is negative", f));
    }
    return mesh;
}

}  // namespace tessera
