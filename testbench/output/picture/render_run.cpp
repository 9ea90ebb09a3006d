#include "testbench/output/picture/render_run.h"

#include <string>

#include "testbench/common/atomic_file.h"
#include "testbench/output/picture/png_writer.h"
#include "testbench/output/picture/view_picture.h"

namespace tessera {

void write_picture(const std::filesystem::path& path, const EmittedMesh& mesh, const MachineSetup& setup,
                   const Job& job) {
    const std::vector<Picture> pictures =
        render_views(make_render_mesh(mesh, setup), make_view(job.camera), {PictureView::overview}, {});
    const std::vector<std::uint8_t> file = encode_png(pictures.front().image);
    write_file(path, std::string(file.begin(), file.end()));
}

}  // namespace tessera
