#include "testbench/machine/host.h"

#include <vector>

#include "modules/datapath/map_entry.h"

namespace tessera {

namespace {

using Socket = tlm_utils::simple_initiator_socket<Host>;

/// One row of a table, written little endian, entry by entry, then sent as one debug write.
class TableRow {
  public:
    explicit TableRow(const datapath::TableLayout& layout)
        : layout_(layout), bytes_(std::size_t{layout.columns} * layout.entry_bytes) {}

    void set(std::uint32_t column, std::uint64_t entry) {
        for (std::uint32_t k = 0; k < layout_.entry_bytes; ++k)
            bytes_[std::size_t{column} * layout_.entry_bytes + k] = static_cast<unsigned char>(entry >> (8 * k));
    }

    void write(Socket& socket, std::uint32_t row) {
        tlm::tlm_generic_payload payload;
        payload.set_command(tlm::TLM_WRITE_COMMAND);
        payload.set_address(layout_.address(0, row));
        payload.set_data_ptr(bytes_.data());
        payload.set_data_length(static_cast<unsigned>(bytes_.size()));
        payload.set_streaming_width(payload.get_data_length());
        if (socket->transport_dbg(payload) != bytes_.size())
            SC_REPORT_ERROR("tessera/host", "a table's memory did not take a row of it");
    }

  private:
    const datapath::TableLayout& layout_;
    std::vector<unsigned char> bytes_;
};

}  // namespace

Host::Host(const sc_core::sc_module_name& name, const MachineSetup& setup, CycleScheduler& clock, std::size_t machine)
    : sc_module(name), setup_(setup), machine_(machine), clock_(clock) {
    clock.attach(*this);
    to_get_triangle.clocked_by(clock, *this);
    SC_HAS_PROCESS(Host);
    if (setup.design.transport == Transport::blocking)
        SC_THREAD(send_triangles);
}

void Host::start_of_simulation() {
    fill_displacement_map();
    fill_normal_map();
    fill_summed_height_table();
    if (setup_.design.transport == Transport::non_blocking)
        clock_.wake(*this);
}

void Host::fill_displacement_map() {
    const datapath::TableLayout& layout = setup_.registers.displacement_map;
    TableRow row(layout);
    for (std::uint32_t y = 0; y < layout.rows; ++y) {
        for (std::uint32_t x = 0; x < layout.columns; ++x)
            row.set(x, setup_.map.code(x, y));
        row.write(displacement_map, y);
    }
}

void Host::fill_normal_map() {
    const datapath::TableLayout& layout = setup_.registers.normal_map;
    const datapath::Format& format = setup_.registers.formats.normal;
    TableRow row(layout);
    for (std::uint32_t y = 0; y < layout.rows; ++y) {
        for (std::uint32_t x = 0; x < layout.columns; ++x)
            row.set(x,
                    datapath::pack_normal(
                        map_normal(setup_.map, x, y, setup_.height_per_code, setup_.texel_size, format), format.bits));
        row.write(normal_map, y);
    }
}

void Host::fill_summed_height_table() {
    const datapath::TableLayout& layout = setup_.registers.summed_height_table;
    const auto mask = static_cast<std::uint64_t>(setup_.registers.formats.summed_height.highest);
    TableRow row(layout);
    std::vector<std::uint64_t> below(layout.columns, 0);
    row.write(summed_height_table, 0);
    for (std::uint32_t y = 0; y + 1 < layout.rows; ++y) {
        std::uint64_t along = 0;
        for (std::uint32_t x = 0; x + 1 < layout.columns; ++x) {
            along += setup_.map.code(x, y);
            below[x + 1] = (below[x + 1] + along) & mask;
            row.set(x + 1, below[x + 1]);
        }
        row.write(summed_height_table, y + 1);
    }
}

void Host::send_again() {
    sent_ = 0;
    if (setup_.design.transport == Transport::non_blocking)
        clock_.wake(*this);
    else
        again_.notify(sc_core::SC_ZERO_TIME);
}

void Host::step() {
    while (sent_ < total() && to_get_triangle.free()) {
        offered_ = next();
        ++sent_;
        to_get_triangle.send(offered_);
    }
}

void Host::send_triangles() {
    for (;;) {
        while (sent_ < total()) {
            datapath::Triangle triangle = next();
            sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
            to_get_triangle->b_transport(triangle, delay);
            ++sent_;
            wait(delay);
        }
        wait(again_);
    }
}

}  // namespace tessera
