#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "modules/schedule/history.h"

namespace tessera::schedule {

constexpr Cycle never = ~Cycle{0};

/// Which units are to act in which cycle. Within a cycle the first of those that are due acts, until none is left: numbered
/// downstream first, so that a place that becomes free is filled in the same cycle.
class Calls {
  public:
    static constexpr unsigned most_units = 32;

    Cycle now() const { return now_; }

    /// `unit` acts (again) in the present cycle.
    void wake(unsigned unit) { due_now_ |= 1u << unit; }
    /// The same in this cycle, if it is not past; if it is far off, also before. never: not at all.
    void wake_at(unsigned unit, Cycle cycle) {
        if (cycle <= now_) {
            wake(unit);
        } else if (cycle != never) {
            cycle = std::min(cycle, now_ + span - 1);
            due_[cycle % span] |= 1u << unit;
            occupied_[cycle / 64 % words] |= std::uint64_t{1} << cycle % 64;
        }
    }

    /// A unit is due in the present cycle: the first.
    bool any() const { return due_now_ != 0; }
    unsigned next() {
        const auto unit = static_cast<unsigned>(__builtin_ctz(due_now_));
        due_now_ &= due_now_ - 1;
        return unit;
    }
    /// Goes to the next cycle in which a unit is due; false: there is none.
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
    std::array<std::uint32_t, span> due_{};        // by cycle modulo span: one bit a unit
    std::array<std::uint64_t, words> occupied_{};  // one bit a cycle: due_ is not zero
};

}  // namespace tessera::schedule
