#include "modules/units/edge_tests/height_test.h"

#include "modules/stage/stage_steps.h"

namespace tessera {

HeightTestUnit::HeightTestUnit(const sc_core::sc_module_name& name, const UnitContext& context)
    : Stage(name, context, context.timing().*kind_of(context.registers.formats.height_test).unit_timing, 1,
            height_test_latency(context.design, context.registers.formats)),
      table(kind_of(context.registers.formats.height_test).table, context.registers.height_table.entry_bytes,
            context.design.direct_memory),
      registers_(context.registers) {
    takes_from(context, input);
    delivers_to(context, output);
    reads_through(table, kind_of(registers_.formats.height_test).requests);
    if (height_test_reads_codes(registers_.formats)) {
        displacement_map.emplace("displacement_map", registers_.displacement_map.entry_bytes,
                                 context.design.direct_memory);
        reads_through(*displacement_map, 1);
    }
    keeps(static_cast<int>(kind_of(registers_.formats.height_test).requests) *
          datapath::height_entry_bits(registers_.formats));
}

}  // namespace tessera
