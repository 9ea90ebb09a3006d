#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/render/picture_options.h"
#include "testbench/render/picture_view.h"

namespace tessera {

/// The arguments of `tessera render`.
struct RenderRequest {
    std::filesystem::path run;                              ///< the run's folder
    std::vector<PictureView> views{PictureView::overview};  ///< each view at most once
    PictureOptions picture;
    std::optional<std::array<double, 3>> eye, target, up;  ///< override the run's camera; model units
    std::optional<double> field_of_view;                   ///< vertical, degrees
    std::filesystem::path output;                          ///< FILE.png or a folder; empty: the run's own
};

/// Reads a run's folder and writes one picture per view: VIEW.png in a folder, or the one file requested.
/// Prints their names and sizes. The overview from the run's own camera is the run's picture.png, byte for byte.
///
/// Throws InputError: no run in the folder, an invalid camera, an output that cannot be written, several views for one
/// file, a picture larger than picture_options.h allows; ResourceError: out of memory or disk space.
ExitCode render_command(const RenderRequest& request, const std::filesystem::path& data_folder);

/// The names of the files that render writes into a run's folder by default.
std::vector<std::string> picture_names();

}  // namespace tessera
