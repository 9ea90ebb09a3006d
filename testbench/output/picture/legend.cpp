#include "testbench/output/picture/legend.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "testbench/output/picture/colour_bar.h"
#include "testbench/output/picture/draw_text.h"
#include "testbench/output/picture/palette.h"

namespace tessera {
namespace {

struct Entry {
    Colour colour;
    std::string name;
};

struct Legend {
    std::string title;
    std::vector<Entry> entries;
};

constexpr double box_width = 22;
constexpr double gap = 6;         // between box and name
constexpr double entry_gap = 14;  // between entries
constexpr double title_gap = 18;

Legend make_legend(const RenderMesh& mesh, ColourBy colour_by) {
    Legend legend;
    if (colour_by == ColourBy::generation) {
        unsigned last = 0;
        for (const RenderMesh::Triangle& triangle : mesh.triangles)
            last = std::max<unsigned>(last, triangle.generation);
        legend.title = "generation";
        for (unsigned g = 0; g <= last; ++g)
            legend.entries.push_back({generation_colour(g), std::to_string(g)});
    } else if (colour_by == ColourBy::deciding_test) {
        legend.title = "split by";
        legend.entries = {{deciding_test_colour(DecidingTest::normal), "normal"},
                          {deciding_test_colour(DecidingTest::summed_height), "summed height"},
                          {deciding_test_colour(DecidingTest::both), "both"},
                          {deciding_test_colour(DecidingTest::base), "none: base"}};
        const bool highlight = std::any_of(mesh.triangles.begin(), mesh.triangles.end(),
                                           [](const RenderMesh::Triangle& triangle) {
                                               return triangle.deciding_test == DecidingTest::highlight;
                                           });
        if (highlight)  // only in a picture that has it: others stay as they are
            legend.entries.insert(legend.entries.end() - 1,
                                  {deciding_test_colour(DecidingTest::highlight), "highlight"});
    } else if (colour_by == ColourBy::stopped_by) {
        legend.title = "kept whole by";
        legend.entries = {{stop_colour(Stop::none), "no test"},
                          {stop_colour(Stop::view), "view"},
                          {stop_colour(Stop::tex_coord), "tex coord"},
                          {stop_colour(Stop::generation), "generation"},
                          {stop_colour(Stop::several), "several"}};
    }
    return legend;
}

/// Calls place(entry, x) with each entry's left border; returns the right border of the last. Pixels of scale 1.
template <typename Place>
double lay_out(const Legend& legend, ColourBy colour_by, const Place& place) {
    double x = text_width(legend_letter, legend.title) + title_gap;
    double right = x;
    for (const Entry& entry : legend.entries) {
        place(entry, x);
        if (colour_by == ColourBy::generation) {
            right = x + box_width;  // numbers stand below their boxes, which touch
            x = right;
        } else {
            right = x + box_width + gap + text_width(legend_letter, entry.name);
            x = right + entry_gap;
        }
    }
    return right;
}

void draw_box(Image& image, double x, double y, const Colour& colour, double scale) {
    const int left = std::max(0, static_cast<int>(std::lround(x)));
    const int right = std::min(image.width, static_cast<int>(std::lround(x + box_width * scale)));
    const int bottom = std::min(image.height, static_cast<int>(std::lround(y)));
    const int top = std::max(0, bottom - static_cast<int>(legend_letter * scale));
    for (int row = top; row < bottom; ++row)
        for (int column = left; column < right; ++column)
            image.set(column, row, colour);
}

}  // namespace

void draw_legend(Image& image, double x, double y, const RenderMesh& mesh, const Style& style, double scale) {
    if (style.colour_by == ColourBy::error) {
        draw_colour_bar(image, x, y, style.errors, scale);
        return;
    }
    const Legend legend = make_legend(mesh, style.colour_by);
    if (legend.entries.empty())
        return;
    const bool numbers_below = style.colour_by == ColourBy::generation;
    const double letter = legend_letter * scale;
    const double number = letter * 0.8;
    draw_text(image, x, y, letter, legend.title, legend_ink);
    lay_out(legend, style.colour_by, [&](const Entry& entry, double from_left) {
        const double left = x + from_left * scale;
        draw_box(image, left, y, entry.colour, scale);
        if (numbers_below)
            draw_text(image, left + (box_width * scale - text_width(number, entry.name)) / 2,
                      y + gap * scale + number, number, entry.name, legend_ink);
        else
            draw_text(image, left + (box_width + gap) * scale, y, letter, entry.name, legend_ink);
    });
}

double legend_width(const RenderMesh& mesh, const Style& style, double scale) {
    if (style.colour_by == ColourBy::error)
        return colour_bar_width(style.errors, scale);
    const Legend legend = make_legend(mesh, style.colour_by);
    return legend.entries.empty() ? 0 : scale * lay_out(legend, style.colour_by, [](const Entry&, double) {});
}

}  // namespace tessera
