#include "testbench/input/map/stroke_font.h"

#include <fmt/format.h>

#include <string>

#include "testbench/common/error.h"
#include "testbench/input/map/map_file.h"

namespace tessera {
namespace {

// Polylines as points "xy", separated by blanks; "/" lifts the pen.
struct Glyph {
    char character;
    std::string_view path;
};

constexpr Glyph glyphs[] = {
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

std::vector<Stroke> strokes_of(std::string_view path) {
    std::vector<Stroke> strokes;
    bool pen_down = false;
    int x = 0;
    int y = 0;
    for (std::size_t i = 0; i < path.size();) {
        if (path[i] == ' ') {
            ++i;
        } else if (path[i] == '/') {
            pen_down = false;
            ++i;
        } else {
            const int next_x = path[i] - '0';
            const int next_y = path[i + 1] - '0';
            if (pen_down) {
                strokes.push_back({x, y, next_x, next_y});
            }
            x = next_x;
            y = next_y;
            pen_down = true;
            i += 2;
        }
    }
    return strokes;
}

}  // namespace

std::string_view stroke_font_characters() {
    static const std::string characters = [] {
        std::string all;
        for (const Glyph& glyph : glyphs) {
            all += glyph.character;
        }
        return all;
    }();
    return characters;
}

std::vector<Stroke> stroke_glyph(char character) {
    const char wanted = upper_case(character);
    for (const Glyph& glyph : glyphs) {
        if (glyph.character == wanted) {
            return strokes_of(glyph.path);
        }
    }
    throw InputError(
        fmt::format("map.text: the built-in font has no character \"{}\" (code {}); it has \"{}\", and shows "
                    "lower-case letters as capitals.",
                    printable_ascii(std::string_view(&character, 1)), static_cast<unsigned char>(character),
                    stroke_font_characters()));
}

}  // namespace tessera
