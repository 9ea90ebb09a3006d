#pragma once
#include <string_view>
#include <vector>

namespace tessera {

/// A line from (x0, y0) to (x1, y1) in font units; y grows upwards.
struct Stroke {
    int x0, y0, x1, y1;
};

/// Capitals are 4 units wide and 6 high, origin at the lower left; a glyph's cell is glyph_advance wide.
inline constexpr int glyph_width = 4;
inline constexpr int glyph_height = 6;
inline constexpr int glyph_advance = 6;

/// What stroke_glyph() knows, besides lower-case letters, which are shown as capitals.
std::string_view stroke_font_characters();

/// The character's strokes; none for a space. Throws InputError for a character the font does not have.
std::vector<Stroke> stroke_glyph(char character);

}  // namespace tessera
