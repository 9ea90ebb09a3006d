#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/output/picture/exr_writer.h"
#include "testbench/output/picture/picture_options.h"
#include "testbench/output/picture/picture_view.h"

namespace tessera {

/// What `tessera render` is to do.
struct RenderRequest {
    std::filesystem::path run;                              ///< the run's folder
    std::vector<PictureView> views{PictureView::overview};  ///< each once
    PictureOptions picture;
    std::optional<std::array<double, 3>> eye, target, up;  ///< instead of the run's camera's; model units
    std::optional<double> field_of_view;                   ///< vertical, degrees
    std::filesystem::path output;   ///< FILE.png, FILE.exr or a folder; empty: the run's own
    std::optional<ExrSamples> exr;  ///< EXR files instead of PNG
};

/// Reads a run's folder back and writes one picture a view: VIEW.png or VIEW.exr in a folder, or the one file asked
/// for. Prints what it wrote. The overview by the run's own camera is the run's picture.png, byte for byte.
///
/// Throws InputError: no run there, a camera that cannot be, an output that cannot be written, several views for one
/// file, a picture larger than picture_options.h allows; ResourceError: memory or disk ran out.
ExitCode render_command(const RenderRequest& request, const std::filesystem::path& data_folder);

/// The files that render leaves in a run's folder unless told another place.
std::vector<std::string> picture_names();

}  // namespace tessera
