#pragma once
#include <optional>
#include <systemc>

#include "modules/sockets/items.h"
#include "modules/sockets/memory_port.h"
#include "modules/stage/stage.h"

namespace tessera {

/// The place of the Summed Height Test in Tessellation Tests, for it and for the tests that a design may have there
/// instead (datapath::HeightTest), each with its own table.
///
/// In:   HeightOperands. Out: HeightResult.
class HeightTestUnit : public Stage<HeightOperands, HeightResult> {
  public:
    StreamInput<HeightOperands> input{"input"};
    StreamOutput<HeightResult> output{"output"};
    MemoryPort table;
    std::optional<MemoryPort> displacement_map;  ///< if it reads codes

    HeightTestUnit(const sc_core::sc_module_name& name, const UnitContext& context);

  protected:
    const datapath::Registers& registers_;
};

}  // namespace tessera
