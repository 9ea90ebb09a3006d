#include "testbench/render/picture_view.h"

#include <iterator>

namespace tessera {
namespace {

constexpr double softer = 0.6;  // light and shadow, if colours represent values

}  // namespace

std::string_view name_of(PictureView view) {
    constexpr std::string_view names[] = {"overview", "shaded", "wireframe", "generation", "test", "stopped", "error"};
    static_assert(std::size(names) == std::size(picture_views));
    return names[static_cast<std::size_t>(view)];
}

Style style_of(PictureView view) {
    Style style;
    style.wireframe = view != PictureView::shaded && view != PictureView::error;
    if (view == PictureView::generation) {
        style.colour_by = ColourBy::generation;
    } else if (view == PictureView::test) {
        style.colour_by = ColourBy::deciding_test;
    } else if (view == PictureView::stopped) {
        style.colour_by = ColourBy::stopped_by;
    } else if (view == PictureView::error) {
        style.colour_by = ColourBy::error;
        style.relief = softer;
    }
    return style;
}

}  // namespace tessera
