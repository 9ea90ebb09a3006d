#include "modules/sockets/stream_input.h"
#include "modules/sockets/stream_output.h"

// The streams' only instances. gcc puts the tables with which a class with virtual bases is constructed into the section
// group of its vtable, clang into groups of their own. If a library and its client both had an instance, by different
// compilers, the linker could drop the only group that has them. For the same reason classes whose members are TLM's own
// sockets or analysis ports have constructor and destructor in a source file.

namespace tessera {

#define TESSERA_DEFINE_STREAMS(Item)  \
    template class StreamInput<Item>; \
    template class StreamOutput<Item>;
TESSERA_FOR_EACH_STREAM_ITEM(TESSERA_DEFINE_STREAMS)

}  // namespace tessera
