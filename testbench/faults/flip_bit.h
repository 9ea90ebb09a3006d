#pragma once
#include <cstdint>

#include "modules/datapath/pack_triangle.h"
#include "modules/stream/work.h"
#include "modules/units/lighting.h"

namespace tessera {

/// Flips one bit of a payload, counted over its fields in the hardware's widths; a field stays within its format.
/// Visits fields as datapath::visit_packed_triangle hands them over.
class BitFlipper {
  public:
    explicit BitFlipper(std::uint64_t bit) : left_(bit) {}

    bool flipped() const { return flipped_; }

    void signed_number(std::int32_t& value, int bits) {
        if (!here(bits))
            return;
        const std::uint64_t sign = std::uint64_t{1} << (bits - 1);
        const std::uint64_t code = (static_cast<std::uint64_t>(value) ^ mask()) & (2 * sign - 1);
        value = static_cast<std::int32_t>(static_cast<std::int64_t>((code ^ sign) - sign));
    }
    template <class Number>
    void unsigned_number(Number& value, int bits) {
        if (here(bits))
            value = static_cast<Number>(value ^ mask());
    }
    void flag(bool& value) {
        if (here(1))
            value = !value;
    }
    void sign(std::int8_t& value) {
        if (here(1))
            value = static_cast<std::int8_t>(-value);
    }
    void test_bits(std::uint8_t& value, int place, int bits) {
        if (here(bits))
            value = static_cast<std::uint8_t>(value ^ mask() << place);
    }
    void split_by(std::uint8_t& value, bool highlight_tag) {
        test_bits(value, 0, 2);
        if (highlight_tag && here(1))
            value ^= datapath::highlight_bit;
    }

  private:
    bool here(int bits) {
        if (flipped_)
            return false;
        flipped_ = left_ < static_cast<std::uint64_t>(bits);
        if (!flipped_)
            left_ -= static_cast<std::uint64_t>(bits);
        return flipped_;
    }
    std::uint64_t mask() const { return std::uint64_t{1} << left_; }

    std::uint64_t left_;  // until it is the field's own bit
    bool flipped_ = false;
};

/// False: the payload has fewer bits. A triangle's are those of its queue entry (pack_triangle.h).
bool flip_bit(datapath::Triangle& triangle, const datapath::Formats& formats, std::uint64_t bit);

/// Of a part of a pass: 0 to 8 the part's own mask (work.h). From 9 on what is carried for it: of an edge, the first of
/// several,
///     P_ij  (N_i+N_j)/2  t_ij  P'_ij  P's_ij x, y, w, in front     of Calculate New P to Transform
///     t_ij  N_ij  T_ij  N'_ij  NT SHT VT TCT GT HT                 of Tessellation Tests
/// and of a vertex or a normal that vertex as in a queue entry.
bool flip_bit(Work& work, const datapath::Formats& formats, std::uint64_t bit);

/// Per corner: P's x, y, w, in front, t, intensity.
bool flip_bit(LitTriangle& triangle, const datapath::Formats& formats, std::uint64_t bit);

}  // namespace tessera
