#include "testbench/output/report/saturation_figures.h"

#include <fmt/format.h>

#include <algorithm>

#include "testbench/common/grouped_digits.h"

namespace tessera {

namespace {

std::string spoken(const char* name) {
    std::string text = name;
    std::replace(text.begin(), text.end(), '_', ' ');
    return text;
}

}  // namespace

std::vector<SaturationFigure> saturation_figures(const MachineSetup& setup, const datapath::Saturations& saturations) {
    const InputSaturations& input = setup.input_saturations;
    const char* const fault = "the set-up scales to this format, so this is a fault of tessera: report it with the job";
    const auto no_tangent = [](const datapath::Triangle& triangle) {
        return std::any_of(triangle.vertices.begin(), triangle.vertices.end(),
                           [](const datapath::Vertex& v) { return v.tangent == datapath::Direction{}; });
    };
    const bool without_tangents = std::any_of(setup.base_triangles.begin(), setup.base_triangles.end(), no_tangent);
    return {
        {"input_position", input.position, "value", "components of base vertices beyond the position's format", fault},
        {"input_normal", input.normal, "value",
         "components of base vertices' normals and tangents beyond the normal's format", fault},
        {"input_texture", setup.texture_clamped, "vertex",
         "base vertices with u or v outside the map on an axis that clamps, set to its border", nullptr},
        {"input_register", input.registers, "value",
         "displacement scale and bias, directions of view and light beyond their formats",
         // S is twice the range of such a map, one LSB more than its register holds.
         setup.map.bits == 1 ? "set formats.displacement_bits = 2" : fault},
        {"displaced_position", saturations.displaced_position, "value", "P' beyond the position's format", fault},
        {"normal", saturations.normal, "value", "N, T or N' beyond the normal's format", fault},
        {"screen_position", saturations.screen_position, "value", "P's beyond the screen's format",
         "set formats.screen_bits = 31, or move camera.eye back: the View Test measures such edges too short"},
        {"view_distance", saturations.view_distance, "value", "w beyond the position's format: the eye is too far away",
         fault},
        {"screen_normal", saturations.screen_normal, "value", "N's beyond the normal's format", fault},
        {"degenerate_normal", saturations.degenerate_normal, "value", "zero vectors that stayed zero",
         without_tangents
             ? nullptr
             : "the normals or tangents at an edge's ends are opposite. Of normals: if the mesh's file has normals (vn), "
               "remove the normals (vn) from the mesh's file, so that smooth ones are calculated. Of tangents: the "
               "texture is mirrored there, see the note on it",
         without_tangents ? "most are tangents between points of the base mesh that have none, see the notes on it"
                          : nullptr},
        {"generation", saturations.generation, "value",
         "generations of inserted vertices beyond their field: only with the Generation Test off",
         "set tests.generation = true"},
        {"intensity", saturations.intensity, "value",
         "vertices that face the light fully: 256 of 256, lit as 255, the maximum of Lighting's 8 bits", nullptr,
         "no key widens Lighting's 8 bits, and their maximum is full light"},
    };
}

std::string saturations_text(const std::vector<SaturationFigure>& figures) {
    std::string text;
    for (const SaturationFigure& figure : figures)
        if (figure.count > 0)
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", spoken(figure.name), grouped_digits(figure.count));
    return text.empty() ? "none" : text;
}

namespace {

/// Sentences for the quantities that saturated and have `what_then`.
std::vector<std::string> sentences(const std::vector<SaturationFigure>& figures,
                                   const char* SaturationFigure::*what_then) {
    std::vector<std::string> result;
    for (const SaturationFigure& figure : figures)
        if (figure.count > 0 && figure.*what_then != nullptr)
            result.push_back(fmt::format("{}: {} {}{} saturated ({}); {}", spoken(figure.name),
                                         grouped_digits(figure.count), figure.unit, figure.count == 1 ? "" : "s",
                                         figure.description, figure.*what_then));
    return result;
}

}  // namespace

std::vector<std::string> saturation_warnings(const std::vector<SaturationFigure>& figures) {
    return sentences(figures, &SaturationFigure::remedy);
}

std::vector<std::string> saturation_notes(const std::vector<SaturationFigure>& figures) {
    return sentences(figures, &SaturationFigure::meaning);
}

}  // namespace tessera
