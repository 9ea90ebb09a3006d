#pragma once
#include <string>
#include <vector>

#include "modules/device/register_map.h"

// The register map as text for several languages. modules/device/generated has these texts for the default formats; a
// test compares them.

namespace tessera {

/// The map that the generated files describe: the registers of all designs, with the widths and reset values of the
/// default design for the registers that it has.
std::vector<DeviceRegister> documented_registers();

/// C99: offsets, bits, error causes, records, and the list of registers that the driver uses.
std::string c_header(const std::vector<DeviceRegister>& registers);
std::string systemverilog_package(const std::vector<DeviceRegister>& registers);
std::string registers_as_json(const std::vector<DeviceRegister>& registers);
/// The page REGISTERS.md, in Markdown.
std::string registers_page(const std::vector<DeviceRegister>& registers);

}  // namespace tessera
