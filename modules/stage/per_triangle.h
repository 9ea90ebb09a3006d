#pragma once
#include <cstddef>

#include "modules/sockets/parts.h"
#include "modules/timing/ring.h"

namespace tessera {

/// State that a unit keeps for each of a few triangles, in order of arrival and looked up by the triangle's tag: a
/// small content-addressable memory, of one triangle in the Normal Test, of the places in Pass or Tessellate, and of
/// two more in the View Test. It grows in functional mode, where triangles can overtake one another.
template <class State>
class PerTriangle {
  public:
    explicit PerTriangle(std::size_t places) : entries_(places) {}

    bool empty() const { return entries_.empty(); }
    bool full() const { return entries_.full(); }
    std::size_t size() const { return entries_.size(); }

    std::size_t places() const { return entries_.capacity(); }

    /// Returns null if there is no state for this triangle.
    State* find(Tag tag) {
        // The tags are mostly consecutive: the first guess is right.
        if (!entries_.empty()) {
            const std::size_t guess = tag - entries_.front().tag;
            if (guess < entries_.size() && entries_.at(guess).tag == tag)
                return &entries_.at(guess).state;
        }
        for (std::size_t k = 0; k < entries_.size(); ++k)
            if (entries_.at(k).tag == tag)
                return &entries_.at(k).state;
        return nullptr;
    }
    const State* find(Tag tag) const { return const_cast<PerTriangle*>(this)->find(tag); }

    /// Opens a place for this triangle. It still has its old contents, which the caller must overwrite.
    State& open(Tag tag) {
        if (full())
            entries_.grow();
        Entry& entry = entries_.push();
        entry.tag = tag;
        return entry.state;
    }
    /// A newly opened place holds a default State.
    State& find_or_open(Tag tag) {
        State* found = find(tag);
        return found != nullptr ? *found : open(tag) = State{};
    }

    /// The k-th oldest.
    State& at(std::size_t k) { return entries_.at(k).state; }
    /// Must not be empty.
    State& oldest() { return entries_.front().state; }
    const State& oldest() const { return entries_.front().state; }
    void close_oldest() { entries_.pop(); }
    /// Does nothing if there is no state for this triangle.
    void close(Tag tag) {
        for (std::size_t k = 0; k < entries_.size(); ++k) {
            if (entries_.at(k).tag != tag)
                continue;
            for (; k > 0; --k)
                entries_.at(k) = entries_.at(k - 1);
            entries_.pop();
            return;
        }
    }

  private:
    struct Entry {
        Tag tag = 0;
        State state{};
    };

    Ring<Entry> entries_;
};

}  // namespace tessera
