#include "testbench/check/conformance/mismatch_text.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>

#include "modules/datapath/height_tests.h"

namespace tessera {
namespace {

std::string text(const datapath::Position& p) {
    return fmt::format("({} {} {})", p.x, p.y, p.z);
}
std::string text(const datapath::Direction& d) {
    return fmt::format("({} {} {})", d.x, d.y, d.z);
}
std::string text(const datapath::TexCoord& t) {
    return fmt::format("({} {})", t.u, t.v);
}
std::string text(const datapath::ScreenPosition& s) {
    return fmt::format("({} {}) w {} {}", s.x, s.y, s.w, s.in_front ? "in front" : "not in front");
}
std::string text(const glm::dvec3& v, int fraction) {
    const glm::dvec3 lsb = v * std::ldexp(1.0, fraction);
    return fmt::format("({:.4f} {:.4f} {:.4f})", lsb.x, lsb.y, lsb.z);
}
std::string text(const glm::dvec2& v, int fraction) {
    const glm::dvec2 lsb = v * std::ldexp(1.0, fraction);
    return fmt::format("({:.4f} {:.4f})", lsb.x, lsb.y);
}

std::string tests_text(std::uint8_t tests) {
    std::string result;
    const auto add = [&](datapath::TestBits bit, const char* name) {
        result += fmt::format("{}{} {}", result.empty() ? "" : ", ", name, (tests & bit) != 0 ? 1 : 0);
    };
    add(datapath::normal_bit, "NT");
    add(datapath::summed_height_bit, "SHT");
    add(datapath::view_bit, "VT");
    add(datapath::tex_coord_bit, "TCT");
    add(datapath::generation_bit, "GT");
    if ((tests & datapath::highlight_bit) != 0)
        result += ", HT 1";
    return result;
}

std::string vertex_text(const datapath::Vertex& v) {
    return fmt::format("P {}, N {}, T {}, handedness {}, t {}, generation {}, P' {}, N' {}, P's {}", text(v.position),
                       text(v.normal), text(v.tangent), v.handedness, text(v.texture), v.generation, text(v.displaced),
                       text(v.displaced_normal), text(v.screen));
}

std::string golden_vertex_text(const golden::Vertex& v, const datapath::Formats& formats) {
    return fmt::format("P {}, N {}, T {}, t {}, P' {}, N' {}, P's {} w {:.4f} {}",
                       text(v.position, formats.position.fraction), text(v.normal, formats.normal.fraction),
                       text(v.tangent, formats.normal.fraction), text(v.texture, formats.texture.fraction),
                       text(v.displaced_position, formats.position.fraction),
                       text(v.displaced_normal, formats.normal.fraction), text(v.screen, formats.screen.fraction),
                       std::ldexp(v.w, formats.view_distance.fraction), v.in_front ? "in front" : "not in front");
}

std::string edge_text(const datapath::Registers& registers, const datapath::TrianglePass& pass, int k,
                      const golden::EdgeEvaluation& golden) {
    const datapath::Formats& formats = registers.formats;
    const datapath::NewVertex& made = pass.new_vertex[static_cast<std::size_t>(k)];
    const datapath::EdgeTests& tested = pass.edges[static_cast<std::size_t>(k)];
    std::string result =
        fmt::format("  i: {}\n  j: {}\n", vertex_text(pass.edge_begin(k)), vertex_text(pass.edge_end(k)));
    result += fmt::format(
        "  hardware: P_ij {}, (N_i+N_j)/2 {}, t_ij {} and {}, N_ij {}, T_ij {}, P'_ij {}, N'_ij {}, P's_ij "
        "{}; {}; "
        "split {}\n",
        text(made.position), text(made.mean_normal), text(made.texture), text(tested.texture), text(tested.normal),
        text(tested.tangent), text(made.displaced), text(tested.displaced_normal), text(made.screen),
        tests_text(tested.tests), pass.split >> k & 1);
    result += fmt::format("  golden:   {}; NT {}, SHT {}, VT {}, TCT {}, GT {}; split {}\n",
                          golden_vertex_text(golden.inserted.vertex, formats), int{golden.normal_test},
                          int{golden.summed_height_test}, int{golden.view_test}, int{golden.tex_coord_test},
                          int{golden.generation_test}, int{golden.split});
    result += fmt::format(
        "  golden's lengths before normalising: N_ij {:.9g}, T_ij {:.9g}, N'_ij {:.9g}; largest normal "
        "difference "
        "{:.6f} LSB; rectangles {} x {}; height test: {} against {}; view length {:.6f} LSB\n",
        golden.inserted.mean_normal_length, golden.inserted.mean_tangent_length, golden.inserted.bump_length,
        std::ldexp(golden.normal_difference, formats.normal.fraction), golden.rectangle_width, golden.rectangle_height,
        golden.height, golden.height_limit, std::ldexp(golden.view_length, formats.screen.fraction));
    if (registers.tests.highlight_test)
        result += fmt::format("  golden's HT {}; N'.H {:.9g} (larger end), {:.9g} (midpoint)\n",
                              int{golden.highlight_test}, golden.end_cosine, golden.midpoint_cosine);
    return result;
}

std::string registers_text(const datapath::Registers& registers) {
    const datapath::Formats& f = registers.formats;
    const datapath::TestParameters& t = registers.tests;
    const datapath::TransformParameters& m = registers.transform;
    const std::string highlight =
        t.highlight_test
            ? fmt::format("H ({} {} {}), highlight cosine {}, highlight normal threshold {}; ", t.half_vector[0],
                          t.half_vector[1], t.half_vector[2], t.highlight_cosine, t.highlight_normal_threshold)
            : "";
    const auto row = [](const std::array<std::int64_t, 4>& r) {
        return fmt::format("({} {} {} {})", r[0], r[1], r[2], r[3]);
    };
    std::string thresholds;
    const auto declared = datapath::functions_of(f.height_test).thresholds(f);
    for (std::size_t k = 0; k < declared.size(); ++k)
        if (declared[k].bits > 0)
            thresholds += fmt::format("{} {} ({}), ", declared[k].name, t.height_thresholds[k], declared[k].meaning);
    const auto mode = [](datapath::AddressMode a) { return a == datapath::AddressMode::repeat ? "repeat" : "clamp"; };
    return fmt::format(
        "  registers: scale {}, bias {}; normal threshold {}, {}view threshold {}, "
        "generation limit {}; {}row_x {}, row_y {}, row_w {}, exponent {}, near plane {}; triangulation {}\n"
        "  map: {} x {}, {} in u, {} in v\n"
        "  formats (bits.fraction): position {}.{}, normal {}.{}, texture {}.{}, displacement {}, summed "
        "height {}, "
        "screen {}.{}\n",
        registers.displacement.scale, registers.displacement.bias, t.normal_threshold, thresholds, t.view_threshold,
        t.generation_limit, highlight, row(m.row_x), row(m.row_y), row(m.row_w), m.exponent, m.near_plane,
        static_cast<int>(registers.triangulation), registers.map.width, registers.map.height,
        mode(registers.map.address_u), mode(registers.map.address_v), f.position.bits, f.position.fraction,
        f.normal.bits, f.normal.fraction, f.texture.bits, f.texture.fraction, f.displacement.bits, f.summed_height.bits,
        f.screen.bits, f.screen.fraction);
}

}  // namespace

std::string mismatch_text(const std::string& what, const datapath::Registers& registers,
                          const golden::Parameters& parameters, const datapath::TrianglePass& pass, int edge,
                          int vertex, const golden::EdgeEvaluation* evaluation, const golden::Vertex* completed) {
    std::string result = what + "\n";
    if (edge >= 0 && evaluation != nullptr) {
        result += fmt::format("base triangle {}, edge {}\n", pass.triangle.base, edge);
        result += edge_text(registers, pass, edge, *evaluation);
    } else if (vertex >= 0 && completed != nullptr) {
        result += fmt::format("base triangle {}, its vertex {}\n", pass.triangle.base, vertex);
        result += fmt::format("  hardware: {}\n  golden:   {}\n",
                              vertex_text(pass.triangle.vertices[static_cast<std::size_t>(vertex)]),
                              golden_vertex_text(*completed, registers.formats));
    } else {
        result += fmt::format("base triangle {}, split edges {:03b} (edge 0 last)\n", pass.triangle.base, pass.split);
        for (std::size_t k = 0; k < 3; ++k)
            result += fmt::format("  P' of vertex {}: {}; of the midpoint of edge {}: {}\n", k,
                                  text(pass.triangle.vertices[k].displaced), k, text(pass.new_vertex[k].displaced));
    }
    result += registers_text(registers);
    result += fmt::format("  golden's scale per code {:.17g}, bias {:.17g}\n", parameters.scale, parameters.bias);
    return result;
}

}  // namespace tessera
