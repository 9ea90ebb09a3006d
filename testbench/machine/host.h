#pragma once
#include <tlm_utils/simple_initiator_socket.h>
#include <cstdint>
#include <systemc>

#include "modules/sockets/stream_output.h"
#include "modules/timing/cycle_scheduler.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// The host CPU (paper figure 7): fills the three tables through the memories' debug transport before simulation
/// starts, then sends the base triangles, one after another, to Get Triangle.
/// Of several machines each has a host of its own, which sends every so many-th base triangle.
/// Get Triangle blocks it while the Triangle Queue is at its watermark. In timed mode it offers the next triangle in
/// the cycle in which the last was accepted: the host's bus is not modelled.
class Host : public sc_core::sc_module, public CycleProcess {
  public:
    StreamOutput<datapath::Triangle> to_get_triangle{"to_get_triangle"};
    tlm_utils::simple_initiator_socket<Host> displacement_map{"displacement_map"};
    tlm_utils::simple_initiator_socket<Host> normal_map{"normal_map"};
    tlm_utils::simple_initiator_socket<Host> summed_height_table{"summed_height_table"};

    /// `setup` must outlive the host. machine: number of its machine, from 0.
    Host(const sc_core::sc_module_name& name, const MachineSetup& setup, CycleScheduler& clock,
         std::size_t machine = 0);

    /// Sends the base triangles again when the simulation continues: another frame of the same job.
    void send_again();

    bool idle() const { return sent_ == total() && to_get_triangle.free(); }
    std::uint64_t sent() const { return sent_; }
    std::uint64_t total() const {
        return (setup_.base_triangles.size() + setup_.machines - 1 - machine_) / setup_.machines;
    }

  private:
    void start_of_simulation() override;
    void send_triangles();
    void step() override;
    void fill_displacement_map();
    void fill_normal_map();
    void fill_summed_height_table();

    const datapath::Triangle& next() const { return setup_.base_triangles[machine_ + sent_ * setup_.machines]; }

    const MachineSetup& setup_;
    std::size_t machine_;
    CycleScheduler& clock_;
    datapath::Triangle offered_;
    sc_core::sc_event again_{"again"};
    std::uint64_t sent_ = 0;
};

}  // namespace tessera
