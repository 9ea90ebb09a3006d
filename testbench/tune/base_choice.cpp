#include "testbench/tune/base_choice.h"

#include <fmt/format.h>

#include <algorithm>

#include "testbench/input/mesh/built_in.h"
#include "testbench/job/toml_text.h"

namespace tessera {

std::string BaseChoice::name() const {
    switch (kind) {
        case Kind::job: return "the job's";
        case Kind::plane: return fmt::format("{} x {}", columns, rows);
        case Kind::lattice:
            return fmt::format("lattice of {} texels, {} x {}{}", spacing, columns, rows,
                               ranks       ? ", for ranks"
                               : alternate ? ", alternate diagonals"
                                           : "");
    }
    return {};
}

std::vector<double> lattice_lines(std::int64_t texels, std::int64_t spacing) {
    std::vector<double> lines{0};
    const std::int64_t cells = texels / spacing - 1;  // between the first and the last inner line
    if (cells >= 0) {
        const std::int64_t before = (texels - cells * spacing) / 2;
        for (std::int64_t k = 0; k <= cells; ++k)
            lines.push_back(static_cast<double>(before + k * spacing) + 0.5);
    }
    lines.push_back(static_cast<double>(texels));
    return lines;
}

BaseChoice lattice_choice(std::int64_t spacing, bool alternate, std::int64_t map_width, std::int64_t map_height) {
    BaseChoice choice;
    choice.kind = BaseChoice::Kind::lattice;
    choice.spacing = spacing;
    choice.alternate = alternate;
    choice.columns = static_cast<std::int64_t>(lattice_lines(map_width, spacing).size()) - 1;
    choice.rows = static_cast<std::int64_t>(lattice_lines(map_height, spacing).size()) - 1;
    return choice;
}

std::vector<BaseChoice> rank_lattices(const Job& job, std::int64_t map_width, std::int64_t map_height,
                                      std::uint64_t most_triangles) {
    constexpr std::int64_t largest_spacing = 128;  // at twice this, edges would need more generations than exist
    std::vector<BaseChoice> choices;
    const bool repeats_u = job.map.address_u == Addressing::repeat, repeats_v = job.map.address_v == Addressing::repeat;
    for (std::int64_t spacing = 2; spacing <= largest_spacing; spacing *= 2) {
        if ((repeats_u && map_width % spacing != 0) || (repeats_v && map_height % spacing != 0))
            continue;
        BaseChoice choice;
        choice.kind = BaseChoice::Kind::lattice;
        choice.ranks = true;
        choice.spacing = spacing;
        choice.columns = lattice_quads(map_width, repeats_u, spacing);
        choice.rows = lattice_quads(map_height, repeats_v, spacing);
        if (choice.triangles() <= most_triangles)
            choices.push_back(choice);
    }
    return choices;
}

std::string lattice_obj(const BaseChoice& choice, const Job::Mesh& mesh, std::int64_t map_width,
                        std::int64_t map_height) {
    const std::vector<double> u = lattice_lines(map_width, choice.spacing),
                              v = lattice_lines(map_height, choice.spacing);
    std::string text = fmt::format(
        "# tessera tune: a plane of {} x {} quads whose inner vertices lie at texel centres, {} texels "
        "apart\n",
        choice.columns, choice.rows, choice.spacing);
    std::string textures;
    for (const double y : v)
        for (const double x : u) {
            const double s = x / static_cast<double>(map_width), t = y / static_cast<double>(map_height);
            text +=
                fmt::format("v {} {} 0\n", toml_number(mesh.width * (s - 0.5)), toml_number(mesh.depth * (t - 0.5)));
            textures += fmt::format("vt {} {}\n", toml_number(s), toml_number(t));
        }
    text += textures + "vn 0 0 1\n";
    const std::size_t line = u.size();
    const auto face = [&](std::size_t a, std::size_t b, std::size_t c) {
        text += fmt::format("f {0}/{0}/1 {1}/{1}/1 {2}/{2}/1\n", a + 1, b + 1, c + 1);
    };
    for (std::size_t j = 0; j + 1 < v.size(); ++j)
        for (std::size_t i = 0; i + 1 < line; ++i) {
            const std::size_t a = j * line + i, b = a + 1, c = b + line, d = a + line;
            if (choice.alternate && (i + j) % 2 == 1) {
                face(a, b, d);
                face(b, c, d);
            } else {
                face(a, b, c);
                face(a, c, d);
            }
        }
    return text;
}

std::vector<BaseChoice> usual_bases(const Job::Mesh& mesh, std::int64_t map_width, std::int64_t map_height,
                                    std::uint64_t most_triangles) {
    std::vector<BaseChoice> choices;
    const auto take = [&](const BaseChoice& choice) {
        const bool known = std::any_of(choices.begin(), choices.end(), [&](const BaseChoice& other) {
            return other.kind == choice.kind && other.columns == choice.columns && other.rows == choice.rows &&
                   other.alternate == choice.alternate;
        });
        if (!known && choice.triangles() <= most_triangles)
            choices.push_back(choice);
    };
    const std::int64_t largest = std::max(map_width, map_height);
    for (std::int64_t spacing = 4; spacing <= largest / 2; spacing *= 2) {
        // a power of two, and one and a half times it
        for (const std::int64_t texels : {spacing, spacing * 3 / 2}) {
            BaseChoice plane;
            plane.kind = BaseChoice::Kind::plane;
            const double side = mesh.width / static_cast<double>(map_width) * static_cast<double>(texels);
            const auto cells = [&](double length) {
                const double count = length / side + 0.5;
                return static_cast<std::int64_t>(std::clamp(count, 1.0, 4096.0));
            };
            plane.columns = cells(mesh.width);
            plane.rows = cells(mesh.depth);
            take(plane);
        }
        take(lattice_choice(spacing, false, map_width, map_height));
        take(lattice_choice(spacing, true, map_width, map_height));
    }
    return choices;
}

}  // namespace tessera
