#include "modules/host.h"

#include <string>
#include <utility>

#include "modules/datapath/preconditions.h"

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

/// The tables, and last the one that takes what is at no table's address.
std::array<Host::Table, 3> Host::tables() const {
    const datapath::Registers& r = machine_.registers();
    return {{{machine_.normal_map, r.normal_map},
             {machine_.height_table, r.height_table},
             {machine_.displacement_map, r.displacement_map}}};
}

std::size_t Host::table_at(std::uint64_t address) const {
    const std::array<Table, 3> all = tables();
    std::size_t k = 0;
    while (k + 1 < all.size() && address - all[k].layout.base >= all[k].layout.bytes())
        ++k;
    return k;
}

void Host::refuse(const std::string& why) const {
    SC_REPORT_ERROR("tessera/host", (std::string(name()) + ": " + why).c_str());
}

void Host::start_of_simulation() {
    check_inputs();
    const std::array<Table, 3> all = tables();
    std::array<std::uint64_t, 3> written{};
    fill_tables_([&](std::uint64_t address, const unsigned char* bytes, std::size_t count) {
        const std::size_t k = table_at(address);
        written[k] += count;
        machine_.write_table(all[k].memory, address, bytes, count);
    });
    for (std::size_t k = 0; k < all.size() && total() > 0; ++k)
        if (written[k] < all[k].layout.bytes())
            refuse("FillTables wrote " + std::to_string(written[k]) + " of the " +
                   std::to_string(all[k].layout.bytes()) + " bytes of " + all[k].memory.name());
    begin_frame();
    if (machine_.transport() == Transport::non_blocking)
        machine_.clock.wake(*this);
}

/// The registers may be changed between frames: each is checked when it begins.
void Host::check_inputs() const {
    const datapath::Registers& registers = machine_.registers();
    if (total() == 0)
        return;
    if (const std::string impossible = datapath::impossible_register(registers); !impossible.empty())
        refuse("the register " + impossible + " has a value that the machine's arithmetic excludes (preconditions.h)");
    for (std::size_t k = first_; k < triangles_.size(); k += step_)
        for (const datapath::Vertex& vertex : triangles_[k].vertices)
            if (!datapath::fits_formats(vertex, registers.formats))
                refuse("a value of base triangle " + std::to_string(k) + " does not fit its format (preconditions.h)");
}

/// All hosts have filled their tables: another machine's may have gone to the same place.
void Host::check_tables() {
    if (std::exchange(tables_checked_, true) || !machine_.reads_tables_elsewhere())
        return;
    fill_tables_([this](std::uint64_t address, const unsigned char* bytes, std::size_t count) {
        machine_.holds_table(tables()[table_at(address)].memory, address, bytes, count);
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
    check_inputs();
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
