#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "modules/schedule/history.h"

namespace tessera::schedule {

constexpr Cycle never = ~Cycle{0};

/// Schedules calls of units by cycle. Within a cycle the unit with the lowest number that is due is called next, until
/// none is due. Units are numbered downstream first, so that a place that becomes free is filled in the same cycle.
class Calls {
  public:
    static constexpr unsigned most_units = 32;

    Cycle now() const { return now_; }

    /// Schedules `unit` (again) for the present cycle.
    void wake(unsigned unit) { due_now_ |= 1u << unit; }
    /// Schedules `unit` for this cycle, for the present one if this cycle is past, and for an earlier one if it is far
    /// off. Does nothing for `never`.
    void wake_at(unsigned unit, Cycle cycle) {
        if (cycle <= now_) {
            wake(unit);
        } else if (cycle != never) {
            cycle = std::min(cycle, now_ + span - 1);
            due_[cycle % span] |= 1u << unit;
            occupied_[cycle / 64 % words] |= std::uint64_t{1} << cycle % 64;
        }
    }

    /// Whether a unit is due in the present cycle; next() removes and returns the first.
    bool any() const { return due_now_ != 0; }
    unsigned next() {
        const auto unit = static_cast<unsigned>(__builtin_ctz(due_now_));
        due_now_ &= due_now_ - 1;
        return unit;
    }
    /// Advances to the next cycle in which a unit is due. Returns false if there is none.
    bool advance() {
        Cycle cycle = now_ + 1;
        for (std::size_t step = 0; step <= words; ++step, cycle = (cycle | 63) + 1) {
            const std::uint64_t bits = occupied_[cycle / 64 % words] >> cycle % 64;
            if (bits == 0)
                continue;
            now_ = cycle + static_cast<unsigned>(__builtin_ctzll(bits));
            occupied_[now_ / 64 % words] &= ~(std::uint64_t{1} << now_ % 64);
            due_now_ = due_[now_ % span];
            due_[now_ % span] = 0;
            return true;
        }
        return false;
    }

  private:
    static constexpr std::size_t span = 1024, words = span / 64;

    Cycle now_ = 0;
    std::uint32_t due_now_ = 0;
    std::array<std::uint32_t, span> due_{};        // by cycle modulo span: one bit per unit
    std::array<std::uint64_t, words> occupied_{};  // one bit per cycle: due_ is not zero
};

}  // namespace tessera::schedule
