#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "modules/datapath/parameters.h"
#include "modules/device/register_map.h"

namespace tessera {

/// The values of the device's registers, read and written by word. The device acts on writes to control.
class RegisterFile {
  public:
    /// reset: the formats, and the reset values of the machine's registers.
    RegisterFile(const datapath::Registers& reset, const LargestMap& largest);

    /// Sets all registers to their reset values.
    void reset();

    /// Returns null if no register has a word at this offset.
    const DeviceRegister* find(std::uint64_t offset) const;
    std::uint32_t word(std::uint32_t offset) const;
    /// Stores the bits that the register has, without checking write access.
    void set_word(std::uint32_t offset, std::uint32_t word);

    /// A whole register, zero-extended.
    std::uint64_t value(std::uint32_t offset) const { return values_[index(offset)]; }
    void set(std::uint32_t offset, std::uint64_t value) { values_[index(offset)] = value & mask(map_[index(offset)]); }

    /// The current values of the machine's registers, with tables laid out for the map's size.
    datapath::Registers machine() const;
    /// The offset of a register of the machine, by name.
    std::uint32_t offset_of(const char* name) const;

  private:
    static std::uint64_t mask(const DeviceRegister& field) {
        return field.bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << field.bits) - 1;
    }
    std::size_t index(std::uint32_t offset) const { return static_cast<std::size_t>(places_[offset / 4]); }

    datapath::Registers reset_;
    std::vector<DeviceRegister> map_;
    std::vector<std::uint64_t> values_;
    std::array<int, register_bytes / 4> places_;  // by word: the register's index, or -1
};

}  // namespace tessera
