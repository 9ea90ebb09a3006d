#include "testbench/render/view_picture.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "testbench/render/key_light.h"
#include "testbench/render/legend.h"
#include "testbench/render/render.h"

namespace tessera {
namespace {

constexpr double usual_line = 1.1;  // for a surface of usual_width

/// Line width in pixels: the option's, or one suited to a surface `width` pixels wide.
double line_width(const PictureOptions& options, int width) {
    // Grows more slowly than the picture, since a larger one should show finer triangles, too.
    return options.line_width > 0 ? options.line_width : usual_line * std::sqrt(std::max(1.0, width / usual_width));
}

/// A picture's surfaces, side by side, and the legend of the last one below them.
struct Layout {
    std::vector<Style> panels;
    Legend legend;
    int panel_width = 0, panel_height = 0, legend_height = 0;

    int height() const { return panel_height + legend_height; }
};

Layout lay_out(const RenderMesh& mesh, const View& camera, PictureView view, const PictureOptions& options) {
    Layout layout;
    if (view == PictureView::overview)
        layout.panels = {style_of(PictureView::shaded), style_of(PictureView::generation)};
    else
        layout.panels = {style_of(view)};
    layout.panel_width = std::max(1, options.width / static_cast<int>(layout.panels.size()));
    for (Style& style : layout.panels) {
        style.errors = options.errors;
        style.line_width = line_width(options, layout.panel_width);
    }
    layout.legend = make_legend(mesh, layout.panels.back());
    layout.legend_height = legend_height(layout.legend, layout.panel_width, options.width,
                                         options.height > 0 ? options.height / 2 : most_picture_side);
    if (options.height > 0) {
        layout.panel_height = options.height - layout.legend_height;
        return layout;
    }
    const double wide =
        options.whole_viewport ? static_cast<double>(camera.width) / camera.height : proportions(camera, mesh);
    layout.panel_height =
        static_cast<int>(std::clamp(layout.panel_width / wide, 0.3 * options.width, 1.1 * layout.panel_width));
    return layout;
}

View panel_view(const View& camera, const RenderMesh& mesh, const PictureOptions& options, int width, int height) {
    const View all = options.whole_viewport ? resized(camera, width, height) : framed(camera, mesh, width, height);
    return zoomed(all, options.zoom.across, options.zoom.down, options.zoom.factor);
}

/// Copies `from` into `to` with its upper left corner at (left, top), clipped to `to`.
void paste(const Image& from, int left, int top, Image& to) {
    const int columns = std::min(from.width, to.width - left), rows = std::min(from.height, to.height - top);
    for (int y = 0; columns > 0 && y < rows; ++y)
        std::copy_n(&from.bytes[from.offset(0, y)], 3 * static_cast<std::size_t>(columns),
                    &to.bytes[to.offset(left, top + y)]);
}

/// The picture without its surfaces.
Picture start_picture(const Layout& layout, const PictureOptions& options) {
    const Colour background = layout.panels.front().background;
    Picture picture{Image(options.width, layout.height(), background)};
    if (layout.legend_height > 0)
        paste(draw_legend(layout.legend, options.width, layout.legend_height, background), 0, layout.panel_height,
              picture.image);
    return picture;
}

}  // namespace

int picture_height(const RenderMesh& mesh, const View& camera, PictureView view, const PictureOptions& options) {
    return lay_out(mesh, camera, view, options).height();
}

std::vector<Picture> render_views(const RenderMesh& mesh, const View& camera, const std::vector<PictureView>& views,
                                  const PictureOptions& options) {
    struct Panel {
        std::size_t picture;
        int left;
    };
    struct Group {
        std::vector<Panel> panels;
        std::vector<Style> styles;
    };
    std::vector<Layout> layouts;
    std::map<std::pair<int, int>, Group> groups;  // by the panels' width and height
    const glm::dvec3 key_light = choose_key_light(mesh, camera);
    for (const PictureView view : views) {
        const Layout layout = lay_out(mesh, camera, view, options);
        Group& group = groups[{layout.panel_width, layout.panel_height}];
        int left = 0;
        for (const Style& style : layout.panels) {
            group.panels.push_back({layouts.size(), left});
            group.styles.push_back(style);
            group.styles.back().key_light = key_light;
            left += layout.panel_width;
        }
        layouts.push_back(layout);
    }
    std::vector<Picture> result(views.size());
    for (const auto& [size, group] : groups) {
        const View view = panel_view(camera, mesh, options, size.first, size.second);
        std::vector<Picture> surfaces = render_pictures(mesh, view, group.styles);
        for (std::size_t i = 0; i < surfaces.size(); ++i) {
            Picture& picture = result[group.panels[i].picture];
            if (picture.image.bytes.empty())
                picture = start_picture(layouts[group.panels[i].picture], options);
            paste(surfaces[i].image, group.panels[i].left, 0, picture.image);
            picture.mesh_in_sight = picture.mesh_in_sight || surfaces[i].mesh_in_sight;
            surfaces[i] = {};  // releases its memory
        }
    }
    return result;
}

}  // namespace tessera
