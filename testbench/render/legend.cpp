#include "testbench/render/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "testbench/common/grouped_digits.h"
#include "testbench/input/map/stroke_font.h"
#include "testbench/render/palette.h"
#include "testbench/render/picture_options.h"

namespace tessera {
namespace {

// Pixels at scale 1, the scale for a surface of usual_width.
constexpr double least_scale = 0.85;  // smaller letters are hard to read; used if they fit
constexpr double margin = 16;
constexpr double title_size = 10;  // height of its letters
constexpr double title_gap = 9;
constexpr double bar_height = 10;
constexpr double least_box_width = 22;
constexpr double label_gap = 6;
constexpr double label_size = 8;
constexpr double label_spacing = 8;  // between neighbours
constexpr double total_height = margin + title_size + title_gap + bar_height + label_gap + label_size + margin;

constexpr double pen_width = 0.13;  // of the letters' height
constexpr double least_pen = 1.1;   // pixels
constexpr int error_steps = 8;

Legend generation_legend(const RenderMesh& mesh) {
    Legend legend;
    legend.title = grouped_digits(mesh.triangles.size()) + " triangles";
    if (mesh.base_triangles > 0)
        legend.title += " from " + grouped_digits(mesh.base_triangles);
    legend.title += ", by generation";
    unsigned last = 0;
    for (const RenderMesh::Triangle& triangle : mesh.triangles)
        last = std::max<unsigned>(last, triangle.generation);
    for (unsigned g = 0; g <= std::min(last, last_generation); ++g)
        legend.entries.push_back({generation_colour(g), std::to_string(g)});
    if (last > last_generation)
        legend.entries.back().label += "+";
    return legend;
}

Legend test_legend(const RenderMesh& mesh) {
    Legend legend{"split by", {}};
    const auto add = [&](DecidingTest test, const std::string& name) {
        legend.entries.push_back({deciding_test_colour(test), name});
    };
    add(DecidingTest::normal, "normal");
    add(DecidingTest::summed_height, words_of(mesh.height_test));
    add(DecidingTest::both, "both");
    if (std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [](const RenderMesh::Triangle& triangle) {
            return triangle.deciding_test == DecidingTest::highlight;
        }))
        add(DecidingTest::highlight, "highlight");
    add(DecidingTest::base, "none: base");
    return legend;
}

Legend error_legend(const ErrorScale& errors) {
    Legend legend{"error, model units", {}};
    if (errors.beyond > errors.largest)
        legend.title += fmt::format(", largest {:.3g}", errors.beyond);
    if (errors.texel > 0)
        legend.title += fmt::format(" (one texel: {:.3g})", errors.texel);
    for (int i = 0; i <= error_steps; ++i) {
        const double fraction = static_cast<double>(i) / error_steps;
        legend.entries.push_back({error_colour(fraction), fmt::format("{:.3g}", fraction * errors.largest)});
    }
    return legend;
}

double text_width(double size, const std::string& text) {
    return StrokeText(text).width() * size / StrokeText::glyph_height;
}

double box_width(const Legend& legend) {
    double widest = least_box_width;
    for (const Legend::Entry& entry : legend.entries)
        widest = std::max(widest, text_width(label_size, entry.label) + label_spacing);
    return widest;
}

/// The largest scale at which the legend fits in a width.
double widest_scale(const Legend& legend, int width) {
    const double bar = box_width(legend) * static_cast<double>(legend.entries.size());
    return width / (std::max(bar, text_width(title_size, legend.title)) + 2 * margin);
}

/// Calls set(x, y) for the pixels of a rectangle that lie in the image.
template <typename Set>
void for_each_pixel(const Image& image, double left, double top, double right, double bottom, const Set& set) {
    const auto inside = [](double at, int size) {
        return static_cast<int>(std::lround(std::clamp(at, 0.0, static_cast<double>(size))));
    };
    for (int y = inside(top, image.height); y < inside(bottom, image.height); ++y)
        for (int x = inside(left, image.width); x < inside(right, image.width); ++x)
            set(x, y);
}

/// (left, base_line): the lower left corner of the first letter; `size`: the letters' height in pixels.
void draw_text(Image& image, double left, double base_line, double size, const std::string& text) {
    const StrokeText strokes(text);
    const double unit = size / StrokeText::glyph_height;
    const double half_pen = std::max(pen_width * size, least_pen) / 2;
    for_each_pixel(
        image, left - 2, base_line - size - 2, left + strokes.width() * unit + 2, base_line + 2, [&](int x, int y) {
            const double distance =
                unit * std::sqrt(strokes.squared_distance((x + 0.5 - left) / unit, (base_line - y - 0.5) / unit));
            const double coverage = std::clamp(half_pen + 0.5 - distance, 0.0, 1.0);
            Colour colour = image.at(x, y);
            for (std::size_t k = 0; k < 3; ++k)
                colour[k] = static_cast<std::uint8_t>(std::lround(colour[k] + (legend_ink[k] - colour[k]) * coverage));
            image.set(x, y, colour);
        });
}

}  // namespace

Legend make_legend(const RenderMesh& mesh, const Style& style) {
    switch (style.colour_by) {
        case ColourBy::generation: return generation_legend(mesh);
        case ColourBy::deciding_test: return test_legend(mesh);
        case ColourBy::stopped_by:
            return {"kept whole by",
                    {{stop_colour(Stop::none), "no test"},
                     {stop_colour(Stop::view), "view"},
                     {stop_colour(Stop::tex_coord), "tex coord"},
                     {stop_colour(Stop::generation), "generation"},
                     {stop_colour(Stop::several), "several"}}};
        case ColourBy::error: return error_legend(style.errors);
        case ColourBy::none: break;
    }
    return {};
}

int legend_height(const Legend& legend, int panel_width, int width, int most) {
    if (legend.entries.empty())
        return 0;
    const double scale = std::min(std::max(least_scale, panel_width / usual_width), widest_scale(legend, width));
    return std::min(most, static_cast<int>(std::ceil(scale * total_height)));
}

Image draw_legend(const Legend& legend, int width, int height, const Colour& background) {
    Image image(width, height, background);
    const double scale = std::min(height / total_height, widest_scale(legend, width));
    const auto draw_centred = [&](double middle, double base_line, double size, const std::string& text) {
        draw_text(image, middle - text_width(size, text) / 2, base_line, size, text);
    };
    double y = (margin + title_size) * scale;
    draw_centred(width / 2.0, y, title_size * scale, legend.title);
    y += title_gap * scale;
    const double box = box_width(legend) * scale;
    double left = (width - box * static_cast<double>(legend.entries.size())) / 2;
    for (const Legend::Entry& entry : legend.entries) {
        for_each_pixel(image, left, y, left + box, y + bar_height * scale,
                       [&](int column, int row) { image.set(column, row, entry.colour); });
        draw_centred(left + box / 2, y + (bar_height + label_gap + label_size) * scale, label_size * scale,
                     entry.label);
        left += box;
    }
    return image;
}

}  // namespace tessera
