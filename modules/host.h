#pragma once
#include <tlm_utils/simple_initiator_socket.h>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <systemc>
#include <vector>

#include "modules/machine.h"

namespace tessera {

/// Writes bytes to an address of the machine's memory.
using TableWriter = std::function<void(std::uint64_t address, const unsigned char* bytes, std::size_t count)>;

/// The host CPU (paper figure 7): fills the three tables before simulation starts (Machine::write_table), then sends
/// base triangles, one after another, to Get Triangle. A table that is not filled, and a register or base triangle that
/// breaks a precondition (datapath/preconditions.h), is an SC_ERROR before the frame begins.
/// With n machines each has its own host, which sends every n-th base triangle.
/// Get Triangle blocks it while the Triangle Queue is at its watermark. In timed mode it offers the next triangle in
/// the cycle in which the last was accepted: the host's bus is not modelled.
class Host : public sc_core::sc_module, public CycleProcess {
  public:
    /// Calls the given writer with all bytes of the tables, at the addresses of the registers' layouts.
    using FillTables = std::function<void(const TableWriter&)>;

    StreamOutput<datapath::Triangle> to_get_triangle{"to_get_triangle"};
    /// The machine's own table memories, to look at.
    tlm_utils::simple_initiator_socket<Host> displacement_map{"displacement_map"};
    tlm_utils::simple_initiator_socket<Host> normal_map{"normal_map"};
    tlm_utils::simple_initiator_socket<Host> summed_height_table{"summed_height_table"};

    /// Sends triangles[first], triangles[first + step], ... `machine` and `triangles` must outlive the host. It is
    /// bound to the machine by bind().
    Host(const sc_core::sc_module_name& name, Machine& machine, const std::vector<datapath::Triangle>& triangles,
         FillTables fill_tables, std::size_t first = 0, std::size_t step = 1);
    ~Host() override;

    void bind();

    /// Sends the triangles again when the simulation continues: another frame, with the tables as they are. Call while
    /// the machine is idle, after changes of the registers. Other tables: Machine::write_table() and tables_changed().
    void send_again();

    bool idle() const { return sent_ == total() && to_get_triangle.free(); }
    std::uint64_t sent() const { return sent_; }
    std::uint64_t total() const { return (triangles_.size() + step_ - 1 - first_) / step_; }

  private:
    const datapath::Triangle& next() const { return triangles_[first_ + sent_ * step_]; }
    void start_of_simulation() override;
    void send_triangles();
    void step() override;
    struct Table {
        const TableMemory& memory;
        const datapath::TableLayout& layout;
    };
    std::array<Table, 3> tables() const;
    std::size_t table_at(std::uint64_t address) const;
    void refuse(const std::string& why) const;
    void begin_frame();
    void sent_one();
    void check_inputs() const;
    void check_tables();

    Machine& machine_;
    const std::vector<datapath::Triangle>& triangles_;
    FillTables fill_tables_;
    std::size_t first_, step_;
    datapath::Triangle offered_;
    sc_core::sc_event again_{"again"};
    std::uint64_t sent_ = 0;
    bool tables_checked_ = false;
};

}  // namespace tessera
