#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace tessera::datapath {

/// The widths of a multiplication's operands in bits, the wider first.
using OperandWidths = std::pair<int, int>;

/// The multiplications of a function f, one element each: f_multiplications, in its file. Those of addresses are not
/// listed.
class Multiplications {
  public:
    Multiplications& add(unsigned times, int a, int b) {
        for (unsigned k = 0; k < times; ++k)
            widths_.at(count_++) = {std::max(a, b), std::min(a, b)};
        return *this;
    }
    Multiplications& add(const Multiplications& more, unsigned times = 1) {
        for (unsigned k = 0; k < times; ++k)
            for (const OperandWidths& widths : more)
                widths_.at(count_++) = widths;
        return *this;
    }

    const OperandWidths* begin() const { return widths_.data(); }
    const OperandWidths* end() const { return widths_.data() + count_; }
    std::size_t size() const { return count_; }

  private:
    static constexpr std::size_t most = 96;

    std::array<OperandWidths, most> widths_{};
    std::size_t count_ = 0;
};

}  // namespace tessera::datapath
