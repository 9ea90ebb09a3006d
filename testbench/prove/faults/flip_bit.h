#pragma once
#include <cstdint>

#include "modules/sockets/items.h"

namespace tessera {

/// Flips one bit of an item, counted over its fields; a field stays within its format. A codec of fields.h.
class BitFlipper {
  public:
    explicit BitFlipper(std::uint64_t bit) : left_(bit) {}

    bool flipped() const { return flipped_; }

    std::int64_t field(const datapath::Field& field, std::int64_t value) {
        const auto bits = static_cast<std::uint64_t>(field.bits);
        if (flipped_ || left_ >= bits) {
            left_ -= flipped_ ? 0 : bits;
            return value;
        }
        flipped_ = true;
        const std::uint64_t code = static_cast<std::uint64_t>(value) ^ std::uint64_t{1} << left_;
        if (!field.is_signed)
            return static_cast<std::int64_t>(code);
        const std::uint64_t sign = std::uint64_t{1} << (bits - 1);
        return static_cast<std::int64_t>(((code & (2 * sign - 1)) ^ sign) - sign);
    }
    std::uint32_t annotation(const char*, std::uint32_t value) const { return value; }

  private:
    std::uint64_t left_;  // bits left until the field's own bit
    bool flipped_ = false;
};

/// Bit 0 is the lowest of the item's first field (modules/sockets/README.md). Returns false if the item has fewer bits.
template <class Item>
bool flip_bit(Item& item, const datapath::Formats& formats, int tag_bits, std::uint64_t bit) {
    BitFlipper flipper(bit);
    describe_item(flipper, item, formats, tag_bits);
    return flipper.flipped();
}

}  // namespace tessera
