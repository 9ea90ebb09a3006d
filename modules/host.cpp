#include "modules/host.h"

#include <utility>

namespace tessera {

Host::Host(const sc_core::sc_module_name& name, Machine& machine, const std::vector<datapath::Triangle>& triangles,
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
    if (machine.transport() == Transport::blocking)
        SC_THREAD(send_triangles);
}

Host::~Host() = default;

void Host::bind() {
    to_get_triangle.bind(machine_.get_triangle.from_host);
    displacement_map.bind(machine_.displacement_map.host);
    normal_map.bind(machine_.normal_map.host);
    summed_height_table.bind(machine_.height_table.host);
}

const TableMemory& Host::table_at(std::uint64_t address) const {
    const auto within = [&](const datapath::TableLayout& table) { return address - table.base < table.bytes(); };
    if (within(machine_.registers().normal_map))
        return machine_.normal_map;
    if (within(machine_.registers().height_table))
        return machine_.height_table;
    return machine_.displacement_map;
}

void Host::start_of_simulation() {
    fill_tables_([this](std::uint64_t address, const unsigned char* bytes, std::size_t count) {
        machine_.write_table(table_at(address), address, bytes, count);
    });
    begin_frame();
    if (machine_.transport() == Transport::non_blocking)
        machine_.clock.wake(*this);
}

/// All hosts have filled their tables: another machine's may have gone to the same place.
void Host::check_tables() {
    if (std::exchange(tables_checked_, true) || !machine_.reads_tables_elsewhere())
        return;
    fill_tables_([this](std::uint64_t address, const unsigned char* bytes, std::size_t count) {
        machine_.holds_table(table_at(address), address, bytes, count);
    });
}

void Host::begin_frame() {
    machine_.begin_frame();
    if (total() == 0)
        machine_.end_frame();
}

void Host::sent_one() {
    if (++sent_ == total())
        machine_.end_frame();
}

void Host::send_again() {
    if (sent_ == total())
        begin_frame();
    sent_ = 0;
    if (machine_.transport() == Transport::non_blocking)
        machine_.clock.wake(*this);
    else
        again_.notify(sc_core::SC_ZERO_TIME);
}

void Host::step() {
    check_tables();
    while (sent_ < total() && to_get_triangle.free()) {
        offered_ = next();
        sent_one();
        to_get_triangle.send(offered_);
    }
}

void Host::send_triangles() {
    for (;;) {
        while (sent_ < total()) {
            check_tables();
            sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
            datapath::Triangle triangle = next();
            to_get_triangle->b_transport(triangle, delay);
            sent_one();
            wait(delay);
        }
        wait(again_);
    }
}

}  // namespace tessera
