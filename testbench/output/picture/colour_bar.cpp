#include "testbench/output/picture/colour_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "testbench/output/picture/draw_text.h"
#include "testbench/output/picture/legend.h"
#include "testbench/output/picture/palette.h"

namespace tessera {
namespace {

// Pixels at scale 1.
constexpr char title[] = "error";
constexpr double title_gap = 18;
constexpr double bar_length = 340;
constexpr double unit_gap = 30;  // half of the last number stands in it
constexpr double number_letter = 0.8 * legend_letter;
constexpr double tick = 4;
constexpr double number_gap = 2;
constexpr char model_units[] = "model units";
constexpr char texels[] = "texels";
constexpr char room_for_beyond[] = ", at most 0.0123";

double bar_left() {
    return text_width(legend_letter, title) + title_gap;
}

void fill(Image& image, double left, double top, double right, double bottom, const Colour& colour) {
    const auto inside = [](double at, int size) {
        return std::clamp(static_cast<int>(std::lround(at)), 0, size);
    };
    for (int row = inside(top, image.height); row < inside(bottom, image.height); ++row)
        for (int column = inside(left, image.width); column < inside(right, image.width); ++column)
            image.set(column, row, colour);
}

/// One row of round numbers; `largest` is what the bar's end stands for.
class Numbers {
  public:
    Numbers(Image& image, double left, double scale) : image_(image), left_(left), scale_(scale) {}

    /// `beyond`: the largest there is, if it is beyond the bar.
    void draw(double largest, double beyond, const char* unit, double base_line, double tick_top) const {
        const double step = round_step(largest);
        const double letter = number_letter * scale_;
        for (int i = 0; i == 0 || (step > 0 && i * step <= largest * (1 + 1e-9)); ++i) {
            const double at =
                left_ + (largest > 0 ? std::min(1.0, i * step / largest) * bar_length * scale_ : 0);
            const std::string number = fmt::format("{:.4g}", i * step);
            fill(image_, at - scale_ / 2, tick_top, at + scale_ / 2, tick_top + tick * scale_, legend_ink);
            draw_text(image_, at - text_width(letter, number) / 2, base_line, letter, number, legend_ink);
        }
        draw_text(image_, left_ + (bar_length + unit_gap) * scale_, base_line, letter,
                  beyond > largest ? fmt::format("{}, at most {:.3g}", unit, beyond) : unit, legend_ink);
    }

  private:
    Image& image_;
    double left_;
    double scale_;
};

}  // namespace

double round_step(double largest) {
    if (!(largest > 0) || !std::isfinite(largest))
        return 0;
    const double power = std::pow(10.0, std::floor(std::log10(largest / 5)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power * 5 >= largest * (1 - 1e-9))
            return factor * power;
    return 10 * power;
}

void draw_colour_bar(Image& image, double x, double y, const ErrorScale& errors, double scale) {
    const double left = x + bar_left() * scale;
    const double letter = legend_letter * scale;
    draw_text(image, x, y, letter, title, legend_ink);
    const double length = bar_length * scale;
    const int columns = static_cast<int>(std::lround(length));
    for (int i = 0; i < columns; ++i)
        fill(image, left + i, y - letter, left + i + 1, y,
             error_colour(columns > 1 ? i / (columns - 1.0) : 1));
    const Numbers numbers(image, left, scale);
    const double reach = (tick + number_gap) * scale;
    numbers.draw(errors.largest, errors.beyond, model_units, y + reach + number_letter * scale, y);
    if (errors.texel > 0)
        numbers.draw(errors.largest / errors.texel, errors.beyond / errors.texel, texels, y - letter - reach,
                     y - letter - tick * scale);
}

double colour_bar_width(const ErrorScale& errors, double scale) {
    const std::string longest =
        model_units + std::string(errors.beyond > errors.largest ? room_for_beyond : "");
    return scale * (bar_left() + bar_length + unit_gap + text_width(number_letter, longest));
}

}  // namespace tessera
