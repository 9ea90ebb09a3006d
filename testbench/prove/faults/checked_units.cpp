#include "testbench/prove/faults/checked_units.h"

#include <fmt/format.h>

#include "testbench/common/error.h"
#include "testbench/job/job_choices.h"
#include "testbench/job/nearest_name.h"
#include "testbench/prove/faults/memory_fault.h"
#include "testbench/prove/faults/stream_fault.h"

namespace tessera {

namespace {

/// A socket's name as fault.place has it: without the machine's own.
std::string place_name(const char* name) {
    const std::string machine = "tessera.";
    const std::string whole = name;
    return whole.compare(0, machine.size(), machine) == 0 ? whole.substr(machine.size()) : whole;
}

}  // namespace

bool strikes_streams(FaultKind kind) {
    switch (kind) {
        case FaultKind::bit_flip:
        case FaultKind::dropped:
        case FaultKind::doubled:
        case FaultKind::reordered:
        case FaultKind::back_pressure_ignored:
        case FaultKind::request_before_end:
        case FaultKind::end_request_doubled:
            return true;
        default:
            return false;
    }
}

bool strikes_memories(FaultKind kind) {
    return kind != FaultKind::none && kind != FaultKind::reordered &&
           kind != FaultKind::back_pressure_ignored;
}

CheckedUnits::CheckedUnits(const Job& job, const datapath::Formats& formats, int tag_bits)
    : fault_(job.fault),
      formats_(formats),
      tag_bits_(tag_bits),
      timed_(job.mode == Mode::timed),
      check_reads_(job.check.reads || job.fault.kind != FaultKind::none),
      trigger_(job.fault, job.timing.cycle_picoseconds) {}

CheckedUnits::~CheckedUnits() = default;

bool CheckedUnits::is_place(const std::string& name, bool applies) {
    if (!applies)
        return false;
    places_.push_back(name);
    if (name != fault_.place)
        return false;
    placed_ = true;
    return true;
}

template <class Payload>
void CheckedUnits::interpose(StreamOutput<Payload>& output) {
    if (!is_place(place_name(output.name()), strikes_streams(fault_.kind)))
        return;
    output.interpose([this](StreamOutput<Payload>& from, StreamInput<Payload>& to) {
        auto fault = std::make_unique<StreamFault<Payload>>("fault", trigger_, formats_, tag_bits_, to);
        from.bind(fault->in);
        fault->out.bind(to);
        faults_.push_back(std::move(fault));
    });
}

void CheckedUnits::made(sc_core::sc_module& module) {
    for_each_output(module, [&](auto& output) { interpose(output); });
}

void CheckedUnits::join_memory(MemoryPort& port, MemoryServer& memory, bool check_reads) {
    const std::string name = place_name(port.socket.name());
    ReadCheck* check = nullptr;
    if (check_reads && check_reads_) {
        read_checks_.push_back(std::make_unique<ReadCheck>(sc_core::sc_gen_unique_name("read_check"), name));
        check = read_checks_.back().get();
        port.bind(*check, memory);
    }
    if (is_place(name, strikes_memories(fault_.kind))) {
        lacks_cycles_ = !timed_ && fault_.kind == FaultKind::doubled;
        auto fault = std::make_unique<MemoryFault>("fault", trigger_);
        if (check != nullptr)
            check->to_memory.bind(fault->socket);
        else
            port.bind(*fault, memory);
        fault->to_memory.bind(memory.socket);
        faults_.push_back(std::move(fault));
    } else if (check != nullptr) {
        check->to_memory.bind(memory.socket);
    } else {
        port.bind(memory);
    }
}

void CheckedUnits::join(MemoryPort& port, TableMemory& memory) {
    join_memory(port, memory, true);
}
// What comes back of a triangle is the work check's to judge.
void CheckedUnits::join(MemoryPort& port, OffChipMemory& memory) {
    join_memory(port, memory, false);
}

void CheckedUnits::require_placed() const {
    if (lacks_cycles_)
        throw InputError(
            fmt::format("`fault.kind` = \"{}\" at a memory, `fault.place` = \"{}\", breaks the handshake, "
                        "which only timed "
                        "mode has: set mode = \"timed\"",
                        name_of(fault_.kind), fault_.place));
    if (fault_.kind == FaultKind::none || placed_)
        return;
    const std::string near = nearest_name(fault_.place, {places_.begin(), places_.end()});
    throw InputError(fmt::format("fault.place = \"{}\" is no place for fault.kind = \"{}\"{}. There are {}",
                                 fault_.place, name_of(fault_.kind),
                                 near.empty() ? "" : "; did you mean \"" + near + "\"?",
                                 fmt::join(places_, ", ")));
}

}  // namespace tessera
