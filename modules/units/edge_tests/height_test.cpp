#include "modules/units/edge_tests/height_test.h"

#include "modules/stage/stage_steps.h"

namespace tessera {

HeightTestUnit::HeightTestUnit(const sc_core::sc_module_name& name, const UnitContext& context, unsigned memory_latency,
                               unsigned most_requests)
    : Stage(name, context, height_test_timing(context.timing(), context.registers.formats.height_test), 1,
            memory_latency),
      table(table_name(context.registers.formats.height_test), context.registers.height_table.entry_bytes,
            context.design.direct_memory),
      registers_(context.registers) {
    takes_from(context, input);
    delivers_to(context, output);
    reads_through(table, most_requests);
}

}  // namespace tessera
