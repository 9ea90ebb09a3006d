#pragma once
#include "modules/memory/memory_port.h"
#include "modules/memory/off_chip_memory.h"
#include "modules/memory/table_memory.h"
#include "modules/stream/stream_input.h"
#include "modules/stream/stream_output.h"
#include "modules/stream/work.h"
#include "modules/units/lighting.h"

namespace tessera {

/// How the machine's wires are made: each output to its input, each port to its memory. Who derives from it may put
/// something in between (testbench/faults). Asked once, while the machine is built: it costs a run nothing.
class Wiring {
  public:
    virtual void join(StreamOutput<datapath::Triangle>& from, StreamInput<datapath::Triangle>& to) {
        from.bind(to);
    }
    virtual void join(StreamOutput<Work>& from, StreamInput<Work>& to) { from.bind(to); }
    virtual void join(StreamOutput<LitTriangle>& from, StreamInput<LitTriangle>& to) { from.bind(to); }
    virtual void join(MemoryPort& port, TableMemory& memory) { port.bind(memory); }
    virtual void join(MemoryPort& port, OffChipMemory& memory) { port.bind(memory); }

    Wiring() = default;
    virtual ~Wiring() = default;
    Wiring(const Wiring&) = delete;
    Wiring& operator=(const Wiring&) = delete;
};

}  // namespace tessera
