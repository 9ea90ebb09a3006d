#include "modules/device/register_file.h"

#include <algorithm>

#include "modules/datapath/registers.h"
#include "modules/datapath/table_shapes.h"

namespace tessera {

RegisterFile::RegisterFile(const datapath::Registers& reset, const LargestMap& largest)
    : reset_(reset), map_(register_map(reset, largest)), values_(map_.size()) {
    places_.fill(-1);
    for (std::size_t k = 0; k < map_.size(); ++k)
        for (int word = 0; word < map_[k].words; ++word)
            places_[map_[k].offset / 4 + static_cast<std::size_t>(word)] = static_cast<int>(k);
    this->reset();
}

void RegisterFile::reset() {
    std::transform(map_.begin(), map_.end(), values_.begin(), [](const DeviceRegister& field) { return field.reset; });
}

const DeviceRegister* RegisterFile::find(std::uint64_t offset) const {
    if (offset % 4 != 0 || offset >= register_bytes || places_[offset / 4] < 0)
        return nullptr;
    return &map_[index(static_cast<std::uint32_t>(offset))];
}

std::uint32_t RegisterFile::word(std::uint32_t offset) const {
    const DeviceRegister& field = map_[index(offset)];
    std::uint64_t value = values_[index(offset)];
    if (field.is_signed && (value >> (field.bits - 1) & 1) != 0)
        value |= ~mask(field);
    return static_cast<std::uint32_t>(offset == field.offset ? value : value >> 32);
}

void RegisterFile::set_word(std::uint32_t offset, std::uint32_t word) {
    std::uint64_t value = values_[index(offset)];
    if (offset == map_[index(offset)].offset)
        value = (value & ~std::uint64_t{0xffffffff}) | word;
    else
        value = (value & 0xffffffff) | std::uint64_t{word} << 32;
    set(map_[index(offset)].offset, value);
}

datapath::Registers RegisterFile::machine() const {
    datapath::Registers registers = reset_;
    auto next = static_cast<std::size_t>(
        std::find_if(map_.begin(), map_.end(), [](const DeviceRegister& r) { return r.offset >= offset::machine; }) -
        map_.begin());
    datapath::describe_registers(registers, [&](const datapath::Register& field, auto&... members) {
        const auto assign = [&](auto& member) {
            std::uint64_t value = values_[next++];
            if (field.kind == datapath::RegisterKind::signed_number && (value >> (field.bits - 1) & 1) != 0)
                value |= ~((std::uint64_t{1} << (field.bits - 1)) - 1);
            member = static_cast<std::decay_t<decltype(member)>>(value);
        };
        (assign(members), ...);
    });
    datapath::shape_tables(registers);
    return registers;
}

std::uint32_t RegisterFile::offset_of(const char* name) const {
    return std::find_if(map_.begin(), map_.end(), [&](const DeviceRegister& r) { return r.name == name; })->offset;
}

}  // namespace tessera
