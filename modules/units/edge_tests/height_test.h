#pragma once
#include <optional>
#include <systemc>

#include "modules/sockets/items.h"
#include "modules/sockets/memory_port.h"
#include "modules/stage/stage.h"

namespace tessera {

/// Common base of the Summed Height Test and of the tests that a design may have in its place (datapath::HeightTest),
/// each with its own table.
///
/// In:   HeightOperands. Out: HeightResult.
class HeightTestUnit : public Stage<HeightOperands, HeightResult> {
  public:
    StreamInput<HeightOperands> input{"input"};
    StreamOutput<HeightResult> output{"output"};
    MemoryPort table;
    std::optional<MemoryPort> displacement_map;  ///< if the test reads codes

    HeightTestUnit(const sc_core::sc_module_name& name, const UnitContext& context);

  protected:
    const datapath::Registers& registers_;
};

}  // namespace tessera
