#pragma once
#include <string_view>
#include <vector>

namespace tessera {

/// A line of text in the built-in stroke font. Font units: capitals are 4 wide and 6 high, one every 6; the first one's
/// lower left corner is (0, 0), y grows upwards. Lower-case letters are shown as capitals.
class StrokeText {
  public:
    static constexpr int glyph_width = 4, glyph_height = 6, glyph_advance = 6;

    /// Throws InputError for a character that is not in stroke_font_characters().
    explicit StrokeText(std::string_view text);

    /// Whether nothing is visible: no text, or only spaces.
    bool blank() const;

    double width() const;

    /// From a point to the nearest stroke of the letter in its cell; infinite if there is none.
    double squared_distance(double x, double y) const;

  private:
    struct Stroke {
        int x0, y0, x1, y1;
    };
    using Glyph = std::vector<Stroke>;

    static Glyph glyph_of(char character);

    std::vector<Glyph> glyphs_;
};

/// The font's characters, without lower-case letters.
std::string_view stroke_font_characters();

}  // namespace tessera
