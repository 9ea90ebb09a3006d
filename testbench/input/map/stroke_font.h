#pragma once
#include <string_view>
#include <vector>

namespace tessera {

/// A line from (x0, y0) to (x1, y1) in font units; y upwards.
struct Stroke {
    int x0, y0, x1, y1;
};

/// Capitals are 4 units wide and 6 high, origin at the lower left; a glyph's cell is glyph_advance wide.
inline constexpr int glyph_width = 4;
inline constexpr int glyph_height = 6;
inline constexpr int glyph_advance = 6;

/// The characters of stroke_glyph(), except lower-case letters, which it shows as capitals.
std::string_view stroke_font_characters();

/// The character's strokes; none for a space. Throws InputError for a character that is not in the font.
std::vector<Stroke> stroke_glyph(char character);

}  // namespace tessera
