#include "testbench/output/picture/draw_text.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

#include "testbench/input/map/stroke_font.h"

namespace tessera {
namespace {

constexpr double pen_width = 0.13;  // of the letters' height

double distance_to(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
    const glm::dvec2 ab = b - a;
    const double squared = glm::dot(ab, ab);
    const double t = squared > 0 ? std::clamp(glm::dot(p - a, ab) / squared, 0.0, 1.0) : 0;
    return glm::length(p - a - t * ab);
}

void blend(Image& image, int x, int y, const Colour& colour, double coverage) {
    Colour result = image.at(x, y);
    for (std::size_t k = 0; k < 3; ++k)
        result[k] = static_cast<std::uint8_t>(std::lround(result[k] + (colour[k] - result[k]) * coverage));
    image.set(x, y, result);
}

void draw_glyph(Image& image, double x, double y, double size, char character, const Colour& colour) {
    const double unit = size / glyph_height;
    const double half_pen = std::max(pen_width * size, 1.1) / 2;
    const std::vector<Stroke> strokes = stroke_glyph(character);
    const int left = std::max(0, static_cast<int>(x - 2));
    const int right = std::min(image.width - 1, static_cast<int>(x + glyph_width * unit + 2));
    const int top = std::max(0, static_cast<int>(y - size - 2));
    const int bottom = std::min(image.height - 1, static_cast<int>(y + 2));
    for (int row = top; row <= bottom; ++row)
        for (int column = left; column <= right; ++column) {
            const glm::dvec2 p(column + 0.5, row + 0.5);
            double distance = std::numeric_limits<double>::infinity();
            for (const Stroke& s : strokes)
                distance = std::min(distance, distance_to({x + s.x0 * unit, y - s.y0 * unit},
                                                          {x + s.x1 * unit, y - s.y1 * unit}, p));
            const double coverage = std::clamp(half_pen + 0.5 - distance, 0.0, 1.0);
            if (coverage > 0)
                blend(image, column, row, colour, coverage);
        }
}

bool in_font(char c) {
    const char capital = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    return stroke_font_characters().find(capital) != std::string_view::npos;
}

}  // namespace

void draw_text(Image& image, double x, double y, double size, std::string_view text, const Colour& colour) {
    for (const char character : text) {
        if (in_font(character))
            draw_glyph(image, x, y, size, character, colour);
        x += size / glyph_height * glyph_advance;
    }
}

double text_width(double size, std::string_view text) {
    return text.empty()
               ? 0
               : size / glyph_height * (static_cast<double>(text.size() - 1) * glyph_advance + glyph_width);
}

}  // namespace tessera
