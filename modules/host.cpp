#include "modules/host.h"

#include <utility>

namespace tessera {

Host::Host(const sc_core::sc_module_name& name, Pipeline& machine, const std::vector<datapath::Triangle>& triangles,
           FillTables fill_tables, std::size_t first, std::size_t step)
    : sc_module(name),
      machine_(machine),
      triangles_(triangles),
      fill_tables_(std::move(fill_tables)),
      first_(first),
      step_(step) {
    machine.clock.attach(*this);
    to_get_triangle.clocked_by(machine.clock, *this);
    SC_HAS_PROCESS(Host);
    if (machine.transport() == Transport::blocking && !machine.conducted())
        SC_THREAD(send_triangles);
}

void Host::bind() {
    to_get_triangle.bind(machine_.get_triangle.from_host);
    displacement_map.bind(machine_.displacement_map.host);
    normal_map.bind(machine_.normal_map.host);
    summed_height_table.bind(machine_.height_table.host);
}

void Host::start_of_simulation() {
    fill_tables_([this](std::uint64_t address, const unsigned char* bytes, std::size_t count) {
        write_table(address, bytes, count);
    });
    if (machine_.transport() == Transport::non_blocking)
        machine_.clock.wake(*this);
}

void Host::write_table(std::uint64_t address, const unsigned char* bytes, std::size_t count) {
    const auto within = [&](const datapath::TableLayout& table) { return address - table.base < table.bytes(); };
    auto& socket = within(machine_.registers().normal_map)     ? normal_map
                   : within(machine_.registers().height_table) ? summed_height_table
                                                               : displacement_map;
    std::vector<unsigned char> row(bytes, bytes + count);
    tlm::tlm_generic_payload payload;
    payload.set_command(tlm::TLM_WRITE_COMMAND);
    payload.set_address(address);
    payload.set_data_ptr(row.data());
    payload.set_data_length(static_cast<unsigned>(count));
    payload.set_streaming_width(payload.get_data_length());
    if (socket->transport_dbg(payload) != count)
        SC_REPORT_ERROR("tessera/host", "a table memory did not accept a row of its table");
}

void Host::send_again() {
    sent_ = 0;
    if (machine_.transport() == Transport::non_blocking)
        machine_.clock.wake(*this);
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

void Host::send_next(sc_core::sc_time& delay) {
    datapath::Triangle triangle = next();
    to_get_triangle->b_transport(triangle, delay);
    ++sent_;
}

void Host::send_triangles() {
    for (;;) {
        while (sent_ < total()) {
            sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
            send_next(delay);
            wait(delay);
        }
        wait(again_);
    }
}

}  // namespace tessera
