#pragma once
#include <functional>
#include <systemc>
#include <tlm>
#include <utility>

#include "modules/datapath/cull.h"
#include "testbench/machine/decisions.h"
#include "testbench/machine/emitted_mesh.h"

namespace tessera {

/// Records every finished triangle of all machines' Pass or Tessellate. Stops the simulation at `limit` triangles.
class MeshMonitor : public sc_core::sc_object, public tlm::tlm_analysis_if<datapath::Triangle> {
  public:
    MeshMonitor(const char* name, bool back_face_culling, std::uint64_t limit)
        : sc_object(name), back_face_culling_(back_face_culling), limit_(limit) {}

    void write(const datapath::Triangle& triangle) override { record(triangle, nullptr); }

    /// decisions: of the triangle's machine, for its tags; null: the machine's own tags are complete.
    void record(const datapath::Triangle& triangle, const Decisions* decisions) {
        if (mesh.triangles.size() == limit_) {
            if (!limit_reached_)
                sc_core::sc_stop();
            limit_reached_ = true;
            return;
        }
        const auto& v = triangle.vertices;
        if (mesh.triangles.size() % progress_step == 0 && progress_)
            progress_(mesh.triangles.size());
        EmittedTriangle emitted = EmittedTriangle::from(
            triangle, back_face_culling_ && datapath::faces_away(v[0].screen, v[1].screen, v[2].screen));
        if (decisions != nullptr)
            decisions->complete_tags(triangle, emitted);
        mesh.triangles.push_back(emitted);
    }

    /// `progress` is called occasionally with the number of triangles so far.
    void on_progress(std::function<void(std::size_t)> progress) { progress_ = std::move(progress); }

    bool limit_reached() const { return limit_reached_; }

    EmittedMesh mesh;

  private:
    static constexpr std::size_t progress_step = 16384;

    std::function<void(std::size_t)> progress_;
    bool back_face_culling_;
    std::uint64_t limit_;
    bool limit_reached_ = false;
};

}  // namespace tessera
