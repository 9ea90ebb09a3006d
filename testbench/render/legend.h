#pragma once
#include <string>
#include <vector>

#include "testbench/render/image.h"
#include "testbench/render/render_mesh.h"
#include "testbench/render/style.h"

namespace tessera {

/// The meaning of a picture's colours: a title and, below it, a bar of labelled colours.
struct Legend {
    struct Entry {
        Colour colour;
        std::string label;
    };
    std::string title;
    std::vector<Entry> entries;  ///< empty: the colours have no meaning
};

/// The legend for this mesh's colours in this style.
Legend make_legend(const RenderMesh& mesh, const Style& style);

/// Height in pixels of the legend's strip below surfaces `panel_width` wide, in a picture `width` wide. It grows with
/// the surface, shrinks until the legend fits in the width, and is at most `most`. 0 without entries.
int legend_height(const Legend& legend, int panel_width, int width, int most);

/// Draws the strip in the built-in stroke font: the same bytes whatever fonts are installed. Letters as large as fit.
Image draw_legend(const Legend& legend, int width, int height, const Colour& background);

inline constexpr Colour legend_ink{84, 86, 90};

}  // namespace tessera
