#include "testbench/check/transport/read_checked_units.h"

namespace tessera {

ReadCheck& ReadCheckedUnits::check(MemoryPort& port, const sc_core::sc_object& memory) {
    checks_.push_back(std::make_unique<ReadCheck>(sc_core::sc_gen_unique_name("read_check"), port.socket.name()));
    port.bind(*checks_.back(), memory);
    return *checks_.back();
}

void ReadCheckedUnits::join(MemoryPort& port, TableMemory& memory) {
    check(port, memory).to_memory.bind(memory.socket);
}

void ReadCheckedUnits::join(MemoryPort& port, TableCache& cache) {
    check(port, cache).to_memory.bind(cache.socket);
}

ReadResult ReadCheckedUnits::result() const {
    ReadResult all;
    for (const auto& read_check : checks_) {
        const ReadResult& one = read_check->result();
        all.entries += one.entries;
        all.wrong += one.wrong;
        if (all.first_wrong.empty())
            all.first_wrong = one.first_wrong;
    }
    return all;
}

}  // namespace tessera
