#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "modules/schedule/calls.h"
#include "modules/schedule/table.h"
#include "modules/timing/ring.h"

namespace tessera::schedule {

/// A memory with one table and up to four readers, whose requests it takes in the order in which they come. While its buffer
/// is full each reader's next one waits; then they take turns.
///
/// Reader: accepted(), once its request has been taken; answered(item, cycle), once it is known when the last entry comes.
template <class Reader>
class SharedTable {
  public:
    static constexpr unsigned most_readers = most_tests_units + 1;

    struct Request {
        Reader* reader = nullptr;
        const std::uint8_t* banks = nullptr;  ///< of each entry
        unsigned entries = 0;
        bool last = false;       ///< of those for this item
        std::uint64_t item = 0;  ///< the reader's
        Cycle taken = 0;
    };

    /// call: which of the calls is the memory's.
    SharedTable(Calls& calls, const TablePlan& plan, unsigned call)
        : calls_(calls),
          call_(call),
          stalls_(plan.input.stalls),
          ports_(plan, std::size_t{plan.under_way} * most_readers),
          buffer_(plan.input.depth),
          offers_(std::size_t{plan.input.depth} + most_readers) {}

    /// Reader number `number` offers a request. True: taken at once.
    bool offer(const Request& request, unsigned number) {
        const Cycle now = calls_.now();
        const unsigned stall = stalls_.next();
        readers_ = std::max(readers_, number + 1);
        offers_.push(now);
        if (stall > 0 || !buffer_.full())
            calls_.wake_at(call_, now + stall);
        if (stall == 0 && !buffer_.full() && waiting_ == 0) {
            take(request);
            return true;
        }
        held_back_[number] = {request, now + stall, true};
        ++waiting_;
        return false;
    }

    void step() {
        const Cycle now = calls_.now();
        admit();
        while (!buffer_.empty()) {
            const Cycle ready = ports_.ready(buffer_.front().banks, buffer_.front().entries);
            if (ready > now) {
                calls_.wake_at(call_, ready);
                break;
            }
            serve(now);
            admit();
        }
    }

    Ports& ports() { return ports_; }

  private:
    struct HeldBack {
        Request request;
        Cycle due = 0;
        bool waits = false;
    };

    void take(const Request& request) {
        buffer_.push(request);
        buffer_.back().taken = calls_.now();
    }
    /// Those held back, in turn, as far as there is room.
    void admit() {
        if (waiting_ == 0)
            return;
        for (unsigned tries = 0; tries < readers_ && !buffer_.full(); ++tries) {
            HeldBack& held_back = held_back_[turn_];
            turn_ = turn_ + 1 == readers_ ? 0 : turn_ + 1;
            if (!held_back.waits)
                continue;
            if (held_back.due > calls_.now()) {
                calls_.wake_at(call_, held_back.due);
                continue;
            }
            held_back.waits = false;
            --waiting_;
            take(held_back.request);
            held_back.request.reader->accepted();
        }
    }
    void serve(Cycle now) {
        const Request& request = buffer_.front();
        const Cycle answer = ports_.serve(offers_.front(), request.taken, request.banks, request.entries, now);
        offers_.pop();
        if (request.last)
            request.reader->answered(request.item, answer);
        buffer_.pop();
    }

    Calls& calls_;
    unsigned call_;
    RandomStalls stalls_;
    Ports ports_;
    Ring<Request> buffer_;
    std::array<HeldBack, most_readers> held_back_{};  // by reader
    unsigned readers_ = 0;                            // that have asked so far
    unsigned turn_ = 0;                               // of these, the next to be let in
    unsigned waiting_ = 0;                            // of these, those held back
    Ring<Cycle> offers_;                              // of the requests not served
};

}  // namespace tessera::schedule
