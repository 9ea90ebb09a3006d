#include "testbench/output/picture/render_run.h"

#include <vector>

#include "testbench/output/picture/png_writer.h"
#include "testbench/output/picture/view_picture.h"

namespace tessera {

std::string picture_file(const EmittedMesh& mesh, const MachineSetup& setup, const Job& job) {
    const std::vector<Picture> pictures =
        render_views(make_render_mesh(mesh, setup), make_view(job.camera), {PictureView::overview}, {});
    const std::vector<std::uint8_t> file = encode_png(pictures.front().image);
    return {file.begin(), file.end()};
}

}  // namespace tessera
