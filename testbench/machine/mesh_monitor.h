#pragma once
#include <functional>
#include <systemc>
#include <tlm>
#include <utility>

#include "modules/datapath/cull.h"
#include "testbench/machine/decisions.h"
#include "testbench/machine/emitted_mesh.h"

namespace tessera {

/// Records every finished triangle of all machines' Pass or Tessellate, culled ones too. Stops the simulation at `limit`
/// triangles, or once there will be more: each edge that is cut adds one, so that a recursion without end stops before
/// the queue fills the memory.
class MeshMonitor : public sc_core::sc_object,
                    public tlm::tlm_analysis_if<datapath::Triangle>,
                    public tlm::tlm_analysis_if<datapath::TrianglePass> {
  public:
    MeshMonitor(const char* name, bool back_face_culling, std::uint64_t limit)
        : sc_object(name), back_face_culling_(back_face_culling), limit_(limit) {}

    void write(const datapath::Triangle& triangle) override { record(triangle, nullptr); }

    /// decisions: of the triangle's machine, for its tags; null: the machine's own tags are complete.
    void record(const datapath::Triangle& triangle, Decisions* decisions) {
        if (mesh.triangles.size() == limit_) {
            stop();
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

    /// For every decided pass.
    void write(const datapath::TrianglePass& pass) override {
        for (unsigned split = pass.split; split != 0; split &= split - 1)
            ++cut_;
        if (cut_ >= limit_)
            stop();
    }

    /// `progress` is called occasionally with the number of triangles so far.
    void on_progress(std::function<void(std::size_t)> progress) { progress_ = std::move(progress); }

    bool limit_reached() const { return limit_reached_; }
    std::uint64_t limit() const { return limit_; }

    EmittedMesh mesh;

  private:
    void stop() {
        if (!limit_reached_)
            sc_core::sc_stop();
        limit_reached_ = true;
    }

    static constexpr std::size_t progress_step = 16384;

    std::function<void(std::size_t)> progress_;
    bool back_face_culling_;
    const std::uint64_t limit_;
    std::uint64_t cut_ = 0;  // edges
    bool limit_reached_ = false;
};

}  // namespace tessera
