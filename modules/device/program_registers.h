#pragma once
#include "modules/datapath/parameters.h"
#include "modules/device/driver/tessera_driver.h"

namespace tessera {

/// Writes all registers of the machine that software may set, over the platform's bus. Returns TESSERA_OK, TESSERA_BUS
/// (also while a frame is under way), TESSERA_BAD_VALUE (datapath/preconditions.h), or TESSERA_NO_DEVICE. The latter means
/// that the device was built for formats other than those of `registers`, or with other features. Then, and with a bad
/// value, nothing is written. A width of summed heights that is
/// chosen for each scene (FormatSettings::summed_height_bits = 0) can differ from the device's: set it.
int program_registers(const tessera_platform& platform, const datapath::Registers& registers);

}  // namespace tessera
