#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tessera {

/// A set-associative cache's lines: their tags, their bytes, and which of a set was used last.
///
/// Size:   max(1, bytes / line bytes) lines, in sets of `ways`.
/// Set:    of line n (n ^ n / sets ^ n / sets^2) mod sets: with a power of two the exclusive OR of three groups of bits.
///         A column of a table whose pitch is a power of two lies in all sets; n mod sets would put it in a few.
/// Victim: of a set the line used least recently, but for those that are being filled.
class LineCache {
  public:
    enum class State : std::uint8_t { empty, filling, present };
    struct Line {
        State state = State::empty;
        std::uint64_t number = 0;  ///< in the memory
        std::uint64_t used = 0;
        std::vector<unsigned char> data;
    };

    LineCache(std::uint64_t bytes, unsigned ways, unsigned line_bytes)
        : ways_(std::min<std::uint64_t>(ways, lines_of(bytes, line_bytes))),
          sets_(lines_of(bytes, line_bytes) / ways_),
          lines_(ways_ * sets_) {
        for (Line& line : lines_)
            line.data.resize(line_bytes);
    }

    std::uint64_t lines() const { return lines_.size(); }

    /// Forgets all lines; none may be being filled.
    void clear() {
        for (Line& line : lines_)
            line.state = State::empty;
    }

    /// Null: not there, and not being filled.
    Line* find(std::uint64_t number) {
        Line* const set = set_of(number);
        Line* const found = std::find_if(
            set, set + ways_, [&](const Line& line) { return line.state != State::empty && line.number == number; });
        if (found == set + ways_)
            return nullptr;
        found->used = ++uses_;
        return found;
    }

    /// Begins to fill a line that is not there, in another's place. Null: the whole set is being filled.
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
    static std::uint64_t lines_of(std::uint64_t bytes, unsigned line_bytes) {
        return std::max<std::uint64_t>(1, bytes / line_bytes);
    }
    Line* set_of(std::uint64_t number) { return &lines_[set_number(number, sets_) * ways_]; }

    std::uint64_t ways_;
    std::uint64_t sets_;
    std::vector<Line> lines_;
    std::uint64_t uses_ = 0;
};

}  // namespace tessera
