#pragma once
#include <cstdint>

#include "modules/schedule/calls.h"
#include "modules/schedule/stage.h"
#include "modules/timing/ring.h"

namespace tessera::schedule {

/// A part of a triangle in a given pass.
class Item {
  public:
    Item() = default;
    Item(std::uint64_t pass, unsigned part) : number_(pass << 4 | part) {}
    std::uint64_t pass() const { return number_ >> 4; }
    unsigned part() const { return number_ & 15; }

  private:
    std::uint64_t number_ = 0;
};

/// A connection of two units: the buffer at the consumer's input, and the item on offer that is not accepted yet.
class Link {
  public:
    /// from, to: the numbers of producer and consumer in `calls`.
    Link(Calls& calls, const InputPlan& plan, unsigned from, unsigned to)
        : calls_(&calls), stalls_(plan.stalls), from_(from), to_(to), buffer_(plan.depth) {}

    /// True if nothing is on offer.
    bool free() const { return !offers_; }
    /// Offers an item. Returns true if it is accepted at once.
    bool send(Item item) {
        const unsigned stall = stalls_.next();
        if (stall == 0 && !buffer_.full()) {
            push(item);
            calls_->wake(to_);
            return true;
        }
        offered_ = item;
        due_ = calls_->now() + stall;
        offers_ = true;
        if (!buffer_.full())
            calls_->wake_at(to_, due_);
        return false;
    }
    /// Accepts the item on offer, if possible. The consumer calls this whenever it is called.
    void admit() {
        if (!offers_ || buffer_.full())
            return;
        if (due_ > calls_->now()) {
            calls_->wake_at(to_, due_);
            return;
        }
        offers_ = false;
        push(offered_);
        calls_->wake(from_);
    }

    bool empty() const { return buffer_.empty(); }
    Item front() const { return buffer_.front().item; }
    /// The cycle in which the first item was accepted.
    Cycle since() const { return buffer_.front().taken; }
    void pop() {
        buffer_.pop();
        admit();
    }
    std::uint64_t taken() const { return taken_; }

  private:
    struct Taken {
        Item item;
        Cycle taken = 0;
    };

    void push(Item item) {
        buffer_.push({item, calls_->now()});
        ++taken_;
    }

    Calls* calls_;
    RandomStalls stalls_;
    unsigned from_, to_;
    Ring<Taken> buffer_;
    Item offered_;
    Cycle due_ = 0;
    bool offers_ = false;
    std::uint64_t taken_ = 0;
};

}  // namespace tessera::schedule
