#include "testbench/output/picture/overview.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "testbench/common/grouped_digits.h"
#include "testbench/output/picture/draw_text.h"
#include "testbench/output/picture/key_light.h"
#include "testbench/output/picture/legend.h"
#include "testbench/output/picture/picture_view.h"
#include "testbench/output/picture/render.h"

namespace tessera {
namespace {

// Pixels at scale 1, which is that of a picture 1600 wide.
constexpr double usual_width = 1600;
constexpr double caption_height = 64;  // below the pictures
constexpr double margin = 24;

/// Never more than half of the height is for the captions.
double scale_of(const PictureOptions& options) {
    const double scale = options.width / usual_width;
    return options.height > 0 ? std::min(scale, options.height / (2 * caption_height)) : scale;
}

std::string caption(const RenderMesh& mesh) {
    const std::string made = grouped_digits(mesh.triangles.size()) + " triangles";
    return mesh.base_triangles == 0 ? made : made + " from " + grouped_digits(mesh.base_triangles);
}

}  // namespace

int overview_height(const RenderMesh& mesh, const View& camera, const PictureOptions& options) {
    const double wide = options.whole_viewport ? static_cast<double>(camera.width) / camera.height
                                               : proportions(camera, mesh);
    const int panel_width = options.width / 2;
    return static_cast<int>(std::clamp(panel_width / wide + caption_height * scale_of(options),
                                       0.3 * options.width, 0.6 * options.width));
}

Picture render_overview(const RenderMesh& mesh, const View& camera, const PictureOptions& options) {
    const double scale = scale_of(options);
    const int panel_width = options.width / 2;
    const int height = options.height > 0 ? options.height : overview_height(mesh, camera, options);
    const int panel_height = std::max(1, height - static_cast<int>(std::lround(caption_height * scale)));
    const View all = options.whole_viewport ? resized(camera, panel_width, panel_height)
                                            : framed(camera, mesh, panel_width, panel_height);
    const View panel = zoomed(all, options.zoom.across, options.zoom.down, options.zoom.factor);
    Style shaded = style_of(PictureView::shaded);
    shaded.key_light = choose_key_light(mesh, camera);
    Style triangles = style_of(PictureView::generation);
    triangles.line_width = line_width(options, panel_width);
    const std::vector<Picture> pictures = render_pictures(mesh, panel, {shaded, triangles}, options.linear);

    Picture result = plain_picture(options.width, height, shaded.background, options.linear);
    paste(pictures[0], 0, 0, result);
    paste(pictures[1], panel_width, 0, result);
    const double base_line = height - (margin + legend_descent) * scale;
    const std::string text = options.caption.empty() ? caption(mesh) : options.caption;
    const double letter = std::min(legend_letter * scale, panel_width * 0.95 / text_width(1, text));
    draw_text(result.image, (panel_width - text_width(letter, text)) / 2, base_line, letter, text,
              legend_ink);
    draw_legend(result.image, panel_width + (panel_width - legend_width(mesh, triangles, scale)) / 2,
                base_line, mesh, triangles, scale);
    take_over_annotations(result);
    return result;
}

}  // namespace tessera
