#include "testbench/commands/render_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "testbench/commands/option_values.h"

namespace tessera {

namespace {

constexpr double thinnest_line = 0.1, widest_line = 50;
constexpr double largest_error_scale = 1e9;
constexpr double least_zoom = 0.1, most_zoom = 10000;

std::string view_names() {
    std::string names;
    for (const PictureView view : picture_views)
        names += (names.empty() ? "" : ", ") + std::string(name_of(view));
    return names;
}

PictureView view_of(const std::string& name) {
    for (const PictureView view : picture_views)
        if (name_of(view) == name)
            return view;
    throw InputError(fmt::format("--view {}: no such view; the views are {}", name, view_names()));
}

void apply_size(const std::string& text, PictureOptions& picture) {
    const std::size_t by = text.find('x');
    picture.width = parse_number(text.substr(0, by));
    picture.height = by == std::string::npos ? 0 : parse_number(text.substr(by + 1));
    const auto allowed = [](int side) { return side >= least_picture_side && side <= most_picture_side; };
    if (!allowed(picture.width) || !(by == std::string::npos || allowed(picture.height)))
        throw InputError(
            fmt::format("--size {}: expected WIDTHxHEIGHT in pixels, or WIDTH alone, each from {} to {}, as in "
                        "--size 1600x1200",
                        text, least_picture_side, most_picture_side));
}

void apply_zoom(const std::vector<double>& zoom, PictureOptions& picture) {
    const auto inside = [](double x) { return x >= 0 && x <= 1; };
    if (!inside(zoom[0]) || !inside(zoom[1]))
        throw InputError(fmt::format("--zoom {} {} {}: the centre must be from 0 (left, top) to 1 (right, bottom)",
                                     zoom[0], zoom[1], zoom[2]));
    if (!(zoom[2] >= least_zoom && zoom[2] <= most_zoom))
        throw InputError(fmt::format("--zoom {} {} {}: the enlargement must be from {} to {}", zoom[0], zoom[1],
                                     zoom[2], least_zoom, most_zoom));
    picture.zoom = {zoom[0], zoom[1], zoom[2]};
}

std::optional<std::array<double, 3>> point(const std::vector<double>& numbers) {
    if (numbers.empty())
        return std::nullopt;
    return std::array<double, 3>{numbers[0], numbers[1], numbers[2]};
}

}  // namespace

void RenderOptions::add_to(CLI::App& render) {
    render.add_option("RUN", run_, "folder of a run, with its job.toml and mesh.ply")->required();
    render
        .add_option("--view", views_, fmt::format("what to show: {}; may be repeated; default: overview", view_names()))
        ->take_all()
        ->delimiter(',')
        ->allow_extra_args(false);
    output_given_ = render.add_option("--output", output_, "FILE.png, or a folder for VIEW.png; default: RUN");
    const std::string picture = "Picture";
    size_given_ = render.add_option("--size", size_, "WIDTHxHEIGHT in pixels, or WIDTH; default: 1600")->group(picture);
    render.add_option("--zoom", zoom_, "U V FACTOR: close-up around U, V (0..1 from the left and the top)")
        ->expected(3)
        ->group(picture);
    line_width_given_ =
        render.add_option("--line-width", line_width_, "width of the triangles' edges, in pixels")->group(picture);
    error_scale_given_ =
        render
            .add_option(
                "--error-scale", error_scale_,
                "error shown in the darkest colour of the view `error`, model units; default: the error exceeded "
                "on 1 % of the area")
            ->group(picture);
    const std::string camera = "Camera; default: the run's";
    render
        .add_flag("--whole-viewport", whole_viewport_,
                  "show the camera's whole viewport, not only the part with the mesh")
        ->group(camera);
    render.add_option("--eye", eye_, "X Y Z, model units")->expected(3)->group(camera);
    render.add_option("--target", target_, "X Y Z, model units")->expected(3)->group(camera);
    render.add_option("--up", up_, "X Y Z, of any length")->expected(3)->group(camera);
    field_of_view_given_ = render.add_option("--field-of-view", field_of_view_, "vertical, degrees")->group(camera);
}

RenderRequest RenderOptions::request() const {
    RenderRequest request;
    if (run_.empty())
        throw InputError("RUN is empty: name the folder of a run, as `tessera run` prints it");
    request.run = run_;
    if (!views_.empty())
        request.views.clear();
    for (const std::string& name : views_) {
        const PictureView view = view_of(name);
        if (std::find(request.views.begin(), request.views.end(), view) == request.views.end())
            request.views.push_back(view);
    }
    if (output_given_->count() > 0 && output_.empty())
        throw InputError("--output is empty: name a file or a folder, or leave it out");
    request.output = output_;
    PictureOptions& picture = request.picture;
    if (size_given_->count() > 0)
        apply_size(size_, picture);
    if (!zoom_.empty())
        apply_zoom(zoom_, picture);
    if (line_width_given_->count() > 0) {
        if (!(line_width_ >= thinnest_line && line_width_ <= widest_line))
            throw InputError(
                fmt::format("--line-width {}: must be from {} to {} pixels", line_width_, thinnest_line, widest_line));
        if (std::none_of(request.views.begin(), request.views.end(),
                         [](PictureView view) { return style_of(view).wireframe; }))
            throw InputError(
                fmt::format("--line-width {}: the views asked for draw no lines; add --view wireframe, or leave it out",
                            line_width_));
        picture.line_width = line_width_;
    }
    if (error_scale_given_->count() > 0) {
        if (!(error_scale_ > 0 && error_scale_ <= largest_error_scale))
            throw InputError(fmt::format("--error-scale {}: must be above 0, and at most {} model units", error_scale_,
                                         largest_error_scale));
        if (std::find(request.views.begin(), request.views.end(), PictureView::error) == request.views.end())
            throw InputError(fmt::format(
                "--error-scale {}: applies to the view `error` only; add --view error, or leave it out", error_scale_));
        picture.errors.largest = error_scale_;
    }
    picture.whole_viewport = whole_viewport_;
    request.eye = point(eye_);
    request.target = point(target_);
    request.up = point(up_);
    if (field_of_view_given_->count() > 0)
        request.field_of_view = field_of_view_;
    return request;
}

}  // namespace tessera
