#include "testbench/check/transport/read_checked_units.h"

#include <fmt/core.h>

#include <algorithm>

namespace tessera {

ReadCheck& ReadCheckedUnits::check(MemoryPort& port, const sc_core::sc_object& memory) {
    checks_.push_back(
        {&port, std::make_unique<ReadCheck>(sc_core::sc_gen_unique_name("read_check"), port.socket.name())});
    ReadCheck& check = *checks_.back().check;
    port.bind(check, memory);
    return check;
}

void ReadCheckedUnits::join(MemoryPort& port, TableMemory& memory) {
    check(port, memory).to_memory.bind(memory.socket);
}

void ReadCheckedUnits::join(MemoryPort& port, TableCache& cache) {
    check(port, cache).to_memory.bind(cache.socket);
}

ReadResult ReadCheckedUnits::result() const {
    ReadResult all;
    for (const Checked& checked : checks_) {
        const ReadResult& one = checked.check->result();
        const std::uint64_t read = checked.port->reads();
        all.entries += one.entries;
        all.wrong += one.wrong;
        all.missed += read - std::min(read, one.entries);
        if (!all.first_wrong.empty())
            continue;
        all.first_wrong = one.first_wrong;
        if (one.wrong == 0 && one.entries < read)
            all.first_wrong =
                fmt::format("{}: {} entries were read, {} compared", checked.check->port(), read, one.entries);
    }
    return all;
}

}  // namespace tessera
