#include "testbench/input/map/stroke_font.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "testbench/common/error.h"
#include "testbench/input/map/map_file.h"

namespace tessera {
namespace {

// Polylines as points "xy", separated by blanks; "/" lifts the pen.
struct Drawing {
    char character;
    std::string_view path;
};

constexpr Drawing drawings[] = {
    {'A', "00 04 26 44 40 / 02 42"},
    {'B', "00 06 36 45 44 33 03 / 33 42 41 30 00"},
    {'C', "45 36 16 05 01 10 30 41"},
    {'D', "00 06 26 44 42 20 00"},
    {'E', "46 06 00 40 / 03 33"},
    {'F', "46 06 00 / 03 33"},
    {'G', "45 36 16 05 01 10 30 41 43 23"},
    {'H', "00 06 / 40 46 / 03 43"},
    {'I', "10 30 / 20 26 / 16 36"},
    {'J', "46 41 30 10 01 02"},
    {'K', "00 06 / 46 03 40"},
    {'L', "06 00 40"},
    {'M', "00 06 23 46 40"},
    {'N', "00 06 40 46"},
    {'O', "10 30 41 45 36 16 05 01 10"},
    {'P', "00 06 36 45 44 33 03"},
    {'Q', "10 30 41 45 36 16 05 01 10 / 22 40"},
    {'R', "00 06 36 45 44 33 03 / 23 40"},
    {'S', "45 36 16 05 04 13 33 42 41 30 10 01"},
    {'T', "06 46 / 26 20"},
    {'U', "06 01 10 30 41 46"},
    {'V', "06 20 46"},
    {'W', "06 10 23 30 46"},
    {'X', "00 46 / 06 40"},
    {'Y', "06 23 46 / 23 20"},
    {'Z', "06 46 00 40"},
    {'0', "10 30 41 45 36 16 05 01 10 / 12 34"},
    {'1', "14 26 20 / 10 30"},
    {'2', "05 16 36 45 44 00 40"},
    {'3', "05 16 36 45 44 33 13 / 33 42 41 30 10 01"},
    {'4', "30 36 02 42"},
    {'5', "46 06 03 33 42 41 30 10 01"},
    {'6', "45 36 16 05 01 10 30 41 42 33 03"},
    {'7', "06 46 10"},
    {'8', "13 04 05 16 36 45 44 33 13 02 01 10 30 41 42 33"},
    {'9', "01 10 30 41 45 36 16 05 04 13 43"},
    {' ', ""},
    {'.', "20 20"},
    {',', "10 21"},
    {':', "21 21 / 24 24"},
    {'!', "20 20 / 22 26"},
    {'?', "05 16 36 45 44 23 22 / 20 20"},
    {'-', "13 33"},
    {'+', "03 43 / 21 25"},
    {'/', "00 46"},
    {'(', "36 24 22 30"},
    {')', "16 24 22 10"},
    {'\'', "24 26"},
};

char upper_case(char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

constexpr int gap = StrokeText::glyph_advance - StrokeText::glyph_width;  // between two letters

}  // namespace

std::string_view stroke_font_characters() {
    static const std::string characters = [] {
        std::string all;
        for (const Drawing& drawing : drawings)
            all += drawing.character;
        return all;
    }();
    return characters;
}

StrokeText::StrokeText(std::string_view text) {
    for (const char character : text)
        glyphs_.push_back(glyph_of(character));
}

bool StrokeText::blank() const {
    return std::all_of(glyphs_.begin(), glyphs_.end(), [](const Glyph& glyph) { return glyph.empty(); });
}

double StrokeText::width() const {
    return glyphs_.empty() ? 0 : static_cast<double>(glyphs_.size()) * glyph_advance - gap;
}

double StrokeText::squared_distance(double x, double y) const {
    double nearest = std::numeric_limits<double>::infinity();
    const double cell = std::floor((x + 0.5 * gap) / glyph_advance);
    if (cell < 0 || cell >= static_cast<double>(glyphs_.size()))
        return nearest;
    const double from_left = x - cell * glyph_advance;
    for (const Stroke& stroke : glyphs_[static_cast<std::size_t>(cell)]) {
        const double dx = stroke.x1 - stroke.x0;
        const double dy = stroke.y1 - stroke.y0;
        const double length = dx * dx + dy * dy;
        const double along = (from_left - stroke.x0) * dx + (y - stroke.y0) * dy;
        const double t = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0.0;
        const double ex = from_left - (stroke.x0 + t * dx);
        const double ey = y - (stroke.y0 + t * dy);
        nearest = std::min(nearest, ex * ex + ey * ey);
    }
    return nearest;
}

StrokeText::Glyph StrokeText::glyph_of(char character) {
    const char wanted = upper_case(character);
    const auto* const drawing = std::find_if(std::begin(drawings), std::end(drawings),
                                             [&](const Drawing& each) { return each.character == wanted; });
    if (drawing == std::end(drawings))
        throw InputError(
            fmt::format("map.text: the built-in font has no character \"{}\" (code {}); it has \"{}\", and draws "
                        "lower-case letters as capitals.",
                        printable_ascii(std::string_view(&character, 1)), static_cast<unsigned char>(character),
                        stroke_font_characters()));
    Glyph glyph;
    bool pen_down = false;
    int x = 0;
    int y = 0;
    for (std::size_t i = 0; i < drawing->path.size();) {
        if (drawing->path[i] == ' ' || drawing->path[i] == '/') {
            pen_down = pen_down && drawing->path[i] == ' ';
            ++i;
            continue;
        }
        const int next_x = drawing->path[i] - '0';
        const int next_y = drawing->path[i + 1] - '0';
        if (pen_down)
            glyph.push_back({x, y, next_x, next_y});
        x = next_x;
        y = next_y;
        pen_down = true;
        i += 2;
    }
    return glyph;
}

}  // namespace tessera
