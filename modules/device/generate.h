#pragma once
#include <string>
#include <vector>

#include "modules/device/register_map.h"

// The register map in the languages of those who use it. modules/device/generated has these texts for the default formats,
// and a test holds them equal.

namespace tessera {

/// The map that the generated files describe: the registers of every design, with the widths and reset values of the default
/// one where it has them.
std::vector<DeviceRegister> documented_registers();

/// C99: offsets, bits, error causes, records, and the list of registers that the driver uses.
std::string c_header(const std::vector<DeviceRegister>& registers);
std::string systemverilog_package(const std::vector<DeviceRegister>& registers);
std::string registers_as_json(const std::vector<DeviceRegister>& registers);
/// Markdown.
std::string registers_page(const std::vector<DeviceRegister>& registers);

}  // namespace tessera
