#include "testbench/render/overview.h"

#include <algorithm>
#include <string>

#include "testbench/render/draw_text.h"
#include "testbench/render/key_light.h"
#include "testbench/render/legend.h"
#include "testbench/render/render.h"

namespace tessera {
namespace {

constexpr int caption_height = 64;  // below the pictures
constexpr int margin = 24;

/// 13144 -> "13,144"
std::string grouped(std::uint64_t number) {
    std::string digits = std::to_string(number);
    for (int at = static_cast<int>(digits.size()) - 3; at > 0; at -= 3)
        digits.insert(static_cast<std::size_t>(at), ",");
    return digits;
}

std::string caption(const RenderMesh& mesh) {
    const std::string made = grouped(mesh.triangles.size()) + " triangles";
    return mesh.base_triangles == 0 ? made : made + " from " + grouped(mesh.base_triangles);
}

void paste(const Image& from, int left, int top, Image& to) {
    for (int y = 0; y < from.height; ++y)
        std::copy_n(&from.bytes[from.offset(0, y)], 3 * static_cast<std::size_t>(from.width),
                    &to.bytes[to.offset(left, top + y)]);
}

}  // namespace

Image render_overview(const RenderMesh& mesh, const View& view, const OverviewOptions& options) {
    const int panel_width = options.width / 2;
    const double wide =
        options.whole_viewport ? static_cast<double>(view.width) / view.height : proportions(view, mesh);
    const int height = options.height > 0
                           ? options.height
                           : static_cast<int>(std::clamp(panel_width / wide + caption_height,
                                                         0.3 * options.width, 0.6 * options.width));
    const int panel_height = height - caption_height;
    const View panel = options.whole_viewport ? resized(view, panel_width, panel_height)
                                              : framed(view, mesh, panel_width, panel_height);
    Style shaded;
    shaded.key_light = choose_key_light(mesh, view);
    Style triangles;
    triangles.colour_by = options.colour_by;
    triangles.wireframe = true;
    const std::vector<Image> pictures = render_styles(mesh, panel, {shaded, triangles});

    Image result(options.width, height, shaded.background);
    paste(pictures[0], 0, 0, result);
    paste(pictures[1], panel_width, 0, result);
    const double base_line = height - margin - legend_descent;
    const std::string text = caption(mesh);
    draw_text(result, (panel_width - text_width(legend_letter, text)) / 2, base_line, legend_letter, text,
              legend_ink);
    draw_legend(result, panel_width + (panel_width - legend_width(mesh, options.colour_by)) / 2, base_line,
                mesh, options.colour_by);
    return result;
}

}  // namespace tessera
