#pragma once
#include <cstddef>

#include "modules/sockets/parts.h"
#include "modules/timing/ring.h"

namespace tessera {

/// What a unit keeps of each of a few triangles, found by the triangle's tag, in the order in which they came: a small
/// content-addressed memory. In functional mode, where a triangle may overtake another that waits outside, it grows.
template <class State>
class PerTriangle {
  public:
    explicit PerTriangle(std::size_t places) : entries_(places) {}

    bool empty() const { return entries_.empty(); }
    bool full() const { return entries_.full(); }
    std::size_t size() const { return entries_.size(); }

    /// Null: it keeps nothing of this triangle.
    State* find(Tag tag) {
        for (std::size_t k = 0; k < entries_.size(); ++k) {
            if (entries_.at(k).tag == tag)
                return &entries_.at(k).state;
        }
        return nullptr;
    }
    const State* find(Tag tag) const { return const_cast<PerTriangle*>(this)->find(tag); }

    /// A place for this triangle, as another left it: to be filled in.
    State& open(Tag tag) {
        if (full())
            entries_.grow();
        Entry& entry = entries_.push();
        entry.tag = tag;
        return entry.state;
    }
    /// A new place is a new State.
    State& find_or_open(Tag tag) {
        State* found = find(tag);
        return found != nullptr ? *found : open(tag) = State{};
    }

    /// Not when empty.
    State& oldest() { return entries_.front().state; }
    const State& oldest() const { return entries_.front().state; }
    void close_oldest() { entries_.pop(); }
    /// Nothing, if it keeps nothing of this triangle.
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
