#include "testbench/input/mesh/mesh_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/input/mesh/mesh_limits.h"

namespace tessera {

std::string quoted(std::string_view token) {
    constexpr std::size_t longest = 40;
    std::string text = "'";
    for (char c : token.substr(0, longest)) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte >= 0x7f)
            text += fmt::format("\\x{:02x}", byte);
        else
            text += c;
    }
    return text + (token.size() > longest ? "...'" : "'");
}

std::string_view foreign_mesh_kind(std::string_view content) {
    using namespace std::string_view_literals;
    constexpr std::array<std::array<std::string_view, 2>, 8> kinds{{
        {"ply\n"sv, "a PLY file"sv},
        {"ply\r"sv, "a PLY file"sv},
        {"glTF"sv, "a GLB file (binary glTF)"sv},
        {"Kaydara FBX"sv, "an FBX file"sv},
        {"BLENDER"sv, "a Blender file"sv},
        {"OFF"sv, "an OFF file"sv},
        {"PK\x03\x04"sv, "a ZIP archive (such as 3MF or USDZ)"sv},
        {"<?xml"sv, "an XML file (such as COLLADA or X3D)"sv},
    }};
    for (const auto& [start, kind] : kinds)
        if (content.substr(0, start.size()) == start)
            return kind;
    const std::size_t first = std::min(content.find_first_not_of(" \t\r\n"), content.size());
    if (content.substr(first, 1) == "{" && content.find("\"asset\"") != std::string_view::npos)
        return "a glTF file";
    if (content.substr(first, 6) == "solid " && content.find("facet") != std::string_view::npos)
        return "an STL file";
    // Binary STL: 80 arbitrary bytes, the number of triangles, 50 bytes for each.
    constexpr std::size_t header = 84, triangle = 50;
    if (content.size() >= header) {
        std::uint64_t triangles = 0;
        for (std::size_t k = 0; k < 4; ++k)
            triangles |= std::uint64_t{static_cast<unsigned char>(content[80 + k])} << (8 * k);
        if (triangles > 0 && content.size() == header + triangle * triangles)
            return "an STL file";
    }
    return {};
}

std::optional<double> to_number(std::string_view token) {
    if (!token.empty() && token.front() == '+') {
        token.remove_prefix(1);
        if (!token.empty() && (token.front() == '-' || token.front() == '+'))
            return std::nullopt;
    }
    double value = 0;
    const char* end = token.data() + token.size();
    const auto [stop, error] = std::from_chars(token.data(), end, value);
    if (stop != end || (error != std::errc() && error != std::errc::result_out_of_range))
        return std::nullopt;
    if (error == std::errc::result_out_of_range) {
        // 0 or HUGE_VAL, according to strtod
        return std::abs(std::strtod(std::string(token).c_str(), nullptr));
    }
    return value;
}

void require_size(const glm::dvec3& size, const std::string& name) {
    if (!(std::max({size.x, size.y, size.z}) >= smallest_size))
        throw InputError(fmt::format(
            "{}: the whole mesh is smaller than {:g} model units: multiply each coordinate of its vertices by {:g}",
            name, smallest_size, std::pow(10.0, -std::round(std::log10(std::max({size.x, size.y, size.z}))))));
}

std::string read_mesh_text(const std::string& path, std::string_view kind) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status))
        throw InputError(fmt::format("{}: no such file: mesh.file must name {}", path, kind));
    if (!std::filesystem::is_regular_file(status))
        throw InputError(fmt::format("{}: not a regular file: mesh.file must name {}", path, kind));
    std::ifstream in(path, std::ios::binary);
    if (!in)
        throw InputError(fmt::format("{}: cannot be opened ({}): check its permissions", path, std::strerror(errno)));
    std::string text;
    std::vector<char> piece(std::size_t{1} << 20);
    while (in) {
        in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
        text.append(piece.data(), static_cast<std::size_t>(in.gcount()));
        if (text.size() > largest_mesh_file) {
            throw ResourceError(fmt::format("{}: more than {} bytes, the limit of {}: simplify the mesh", path,
                                            largest_mesh_file, kind));
        }
    }
    if (in.bad())
        throw InputError(fmt::format("{}: reading failed after {} bytes: check the disk", path, text.size()));
    return text;
}

}  // namespace tessera
