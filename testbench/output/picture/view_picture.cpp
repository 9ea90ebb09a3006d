#include "testbench/output/picture/view_picture.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "testbench/output/picture/draw_text.h"
#include "testbench/output/picture/key_light.h"
#include "testbench/output/picture/legend.h"
#include "testbench/output/picture/render.h"

namespace tessera {
namespace {

// Pixels at scale 1, which is that of a picture 1000 wide.
constexpr double usual_width = 1000;
constexpr double least_scale = 0.85;  // letters smaller than this cannot be read; used where they fit
constexpr double strip_top = 10;
constexpr double row_gap = 18;
constexpr double strip_bottom = 18;
constexpr double side_margin = 16;
constexpr double caption_letter = 12;
constexpr double legend_height = legend_descent + legend_letter + legend_descent;  // numbers above and below

constexpr double most_of_the_height = 0.5;  // for the strip

/// What stands below the surface, and how large.
struct Strip {
    double scale = 1;  // of the legend and everything but the caption
    double caption_scale = 1;
    int height = 0;
    bool legend = false;
};

double fitting(double scale, double width_at_1, int width) {
    return std::min(scale, width / (width_at_1 + 2 * side_margin));
}

Strip lay_out(const RenderMesh& mesh, const Style& style, const PictureOptions& options) {
    Strip strip;
    strip.legend = style.colour_by != ColourBy::none;
    const bool caption = !options.caption.empty();
    if (!strip.legend && !caption)
        return strip;
    const double usual = std::max(least_scale, options.width / usual_width);
    strip.scale = strip.legend ? fitting(usual, legend_width(mesh, style), options.width) : usual;
    strip.caption_scale = fitting(usual, text_width(caption_letter, options.caption), options.width);
    const auto height = [&] {
        return (strip.legend ? (legend_height + strip_top) * strip.scale : row_gap * strip.scale) +
               (caption ? (row_gap + caption_letter) * strip.caption_scale : 0) + strip_bottom * strip.scale;
    };
    const double most = options.height * most_of_the_height;
    if (options.height > 0 && height() > most) {
        const double shrink = most / height();
        strip.scale *= shrink;
        strip.caption_scale *= shrink;
    }
    strip.height = static_cast<int>(std::ceil(height()));
    return strip;
}

int surface_height(const RenderMesh& mesh, const View& camera, const Strip& strip,
                   const PictureOptions& options) {
    if (options.height > 0)
        return std::max(1, options.height - strip.height);
    const double wide = options.whole_viewport ? static_cast<double>(camera.width) / camera.height
                                               : proportions(camera, mesh);
    return static_cast<int>(std::clamp(options.width / wide, 0.3 * options.width, 1.1 * options.width));
}

View surface_view(const View& camera, const RenderMesh& mesh, const PictureOptions& options, int height) {
    const View all = options.whole_viewport ? resized(camera, options.width, height)
                                            : framed(camera, mesh, options.width, height);
    return zoomed(all, options.zoom.across, options.zoom.down, options.zoom.factor);
}

void annotate(const RenderMesh& mesh, const Style& style, const Strip& strip, int surface,
              const PictureOptions& options, Image& image) {
    double y = surface;
    if (strip.legend) {
        y += (strip_top + legend_descent + legend_letter) * strip.scale;
        draw_legend(image, (options.width - legend_width(mesh, style, strip.scale)) / 2, y, mesh, style,
                    strip.scale);
        y += legend_descent * strip.scale;
    }
    if (options.caption.empty())
        return;
    y += (row_gap + caption_letter) * strip.caption_scale;
    const double letter = caption_letter * strip.caption_scale;
    draw_text(image, (options.width - text_width(letter, options.caption)) / 2, y, letter, options.caption,
              legend_ink);
}

}  // namespace

int picture_height(const RenderMesh& mesh, const View& camera, PictureView view,
                   const PictureOptions& options) {
    const Strip strip = lay_out(mesh, style_of(view), options);
    return surface_height(mesh, camera, strip, options) + strip.height;
}

std::vector<Picture> render_views(const RenderMesh& mesh, const View& camera,
                                  const std::vector<PictureView>& views, const PictureOptions& options) {
    std::vector<Style> styles;
    std::vector<Strip> strips;
    std::map<int, std::vector<std::size_t>> together;  // by the surface's height
    for (const PictureView view : views) {
        Style style = style_of(view);
        style.key_light = choose_key_light(mesh, camera);
        style.errors = options.errors;
        style.line_width = line_width(options, options.width);
        strips.push_back(lay_out(mesh, style, options));
        together[surface_height(mesh, camera, strips.back(), options)].push_back(styles.size());
        styles.push_back(style);
    }
    std::vector<Picture> result(views.size());
    for (const auto& [height, members] : together) {
        std::vector<Style> chosen;
        for (const std::size_t i : members)
            chosen.push_back(styles[i]);
        const View view = surface_view(camera, mesh, options, height);
        std::vector<Picture> surfaces = render_pictures(mesh, view, chosen, options.linear);
        for (std::size_t m = 0; m < members.size(); ++m) {
            const std::size_t i = members[m];
            if (strips[i].height == 0) {
                result[i] = std::move(surfaces[m]);
                continue;
            }
            result[i] =
                plain_picture(options.width, height + strips[i].height, styles[i].background, options.linear);
            paste(surfaces[m], 0, 0, result[i]);
            surfaces[m] = {};
            annotate(mesh, styles[i], strips[i], height, options, result[i].image);
            take_over_annotations(result[i]);
        }
    }
    return result;
}

}  // namespace tessera
