#include "modules/device/program_registers.h"

#include <vector>

#include "modules/datapath/preconditions.h"
#include "modules/device/register_map.h"

namespace tessera {

namespace {

/// Whether a register's value is determined by the design alone.
bool is_of_the_design(const DeviceRegister& r) {
    return r.name.rfind("format.", 0) == 0 || r.name == "features" || r.name == "entry_bytes";
}

}  // namespace

int program_registers(const tessera_platform& platform, const datapath::Registers& registers) {
    if (!datapath::impossible_register(registers).empty())
        return TESSERA_BAD_VALUE;
    const std::vector<DeviceRegister> map = register_map(registers, {});
    for (const DeviceRegister& r : map) {
        std::uint32_t value = 0;
        if (!is_of_the_design(r))
            continue;
        if (platform.read32(platform.context, r.offset, &value) != 0)
            return TESSERA_BUS;
        if (value != static_cast<std::uint32_t>(r.reset))
            return TESSERA_NO_DEVICE;
    }
    for (const DeviceRegister& r : map) {
        if (r.offset < offset::machine || r.access != RegisterAccess::read_write)
            continue;
        for (int word = 0; word < r.words; ++word)
            if (platform.write32(platform.context, r.offset + 4 * static_cast<std::uint32_t>(word),
                                 static_cast<std::uint32_t>(r.reset >> 32 * word)) != 0)
                return TESSERA_BUS;
    }
    return TESSERA_OK;
}

}  // namespace tessera
