#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "modules/datapath/parameters.h"
#include "modules/timing/timing.h"

namespace tessera {

/// The cache that is built for the given sizes, each of them rounded down.
///
/// Line:   as many whole entries of the table as fit, at least one: an entry in two lines would need two lookups.
/// Size:   whole sets of `ways` lines; with fewer lines one set of all of them, at least one line.
/// A cache with room for the whole table has one line for each of the table's, in its own set.
struct CacheShape {
    unsigned line_bytes;
    std::uint64_t ways, sets;
    bool whole_table;

    CacheShape(const CacheTiming& cache, const datapath::TableLayout& layout)
        : line_bytes(std::max(1u, cache.line_bytes / layout.entry_bytes) * layout.entry_bytes) {
        const std::uint64_t lines = std::max<std::uint64_t>(1, cache.bytes / line_bytes),
                            of_table = (layout.bytes() + line_bytes - 1) / line_bytes;
        whole_table = lines >= of_table;
        ways = whole_table ? 1 : std::min<std::uint64_t>(cache.ways, lines);
        sets = whole_table ? std::max<std::uint64_t>(1, of_table) : lines / ways;
    }

    std::uint64_t bytes() const { return ways * sets * line_bytes; }
};

/// The lines of a set-associative cache: their tags, data and order of use.
///
/// Set:    line n is in set (n ^ n / sets ^ n / sets^2) mod sets; for a power of two the exclusive OR of three groups
///         of bits. A table column is thus spread over all sets even if the pitch is a power of two; n mod sets would
///         use only a few, whose lines are then all being filled: 14.7 instead of 3.3 cycles per finished triangle on
///         the head, 10.7 instead of 4.5 on the teapot (64 bytes per cycle, latency 100).
/// Victim: the least recently used line of the set, except lines that are being filled.
class LineCache {
  public:
    enum class State : std::uint8_t { empty, filling, present };
    struct Line {
        State state = State::empty;
        std::uint64_t number = 0;  ///< line number in the memory
        std::uint64_t used = 0;
        std::vector<unsigned char> data;
    };

    LineCache(std::uint64_t sets, std::uint64_t ways, unsigned line_bytes)
        : ways_(ways), sets_(sets), lines_(ways_ * sets_) {
        for (Line& line : lines_)
            line.data.resize(line_bytes);
    }

    /// Invalidates all lines. No line may be in the process of being filled.
    void clear() {
        for (Line& line : lines_)
            line.state = State::empty;
    }

    /// Returns null if the line is neither present nor being filled.
    Line* find(std::uint64_t number) {
        Line* const set = set_of(number);
        Line* const found = std::find_if(
            set, set + ways_, [&](const Line& line) { return line.state != State::empty && line.number == number; });
        if (found == set + ways_)
            return nullptr;
        found->used = ++uses_;
        return found;
    }

    /// Replaces another line by this one and begins to fill it. Returns null if the whole set is being filled.
    Line* allocate(std::uint64_t number) {
        Line* const set = set_of(number);
        Line* victim = nullptr;
        for (Line* line = set; line != set + ways_; ++line)
            if (line->state != State::filling && (victim == nullptr || line->used < victim->used))
                victim = line;
        if (victim == nullptr)
            return nullptr;
        victim->state = State::filling;
        victim->number = number;
        victim->used = ++uses_;
        return victim;
    }

    static constexpr std::uint64_t set_number(std::uint64_t number, std::uint64_t sets) {
        return (number ^ number / sets ^ number / sets / sets) % sets;
    }

  private:
    Line* set_of(std::uint64_t number) { return &lines_[set_number(number, sets_) * ways_]; }

    std::uint64_t ways_;
    std::uint64_t sets_;
    std::vector<Line> lines_;
    std::uint64_t uses_ = 0;
};

}  // namespace tessera
