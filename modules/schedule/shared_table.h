#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "modules/schedule/calls.h"
#include "modules/schedule/table.h"
#include "modules/timing/ring.h"

namespace tessera::schedule {

/// A memory with one table and up to four readers. It accepts requests in order of arrival. While its buffer is full,
/// the next request of each reader waits; waiting requests are accepted round-robin.
///
/// A Reader has accepted(), called when a request that had to wait is accepted, and answered(item, cycle), called when
/// the arrival cycle of the item's last entry is known.
template <class Reader>
class SharedTable {
  public:
    static constexpr unsigned most_readers = most_tests_units + 1;

    struct Request {
        Reader* reader = nullptr;
        const std::uint8_t* banks = nullptr;  ///< of each entry
        unsigned entries = 0;
        bool last = false;       ///< the last request for this item
        std::uint64_t item = 0;  ///< the reader's number for it
        Cycle taken = 0;
    };

    /// call: the memory's number in `calls`.
    SharedTable(Calls& calls, const TablePlan& plan, unsigned call)
        : calls_(calls),
          call_(call),
          stalls_(plan.input.stalls),
          ports_(plan, std::size_t{plan.under_way} * most_readers),
          buffer_(plan.input.depth),
          offers_(std::size_t{plan.input.depth} + most_readers) {}

    /// Reader `number` offers a request. Returns true if it is accepted at once.
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
    /// Accepts waiting requests round-robin while there is room.
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
    unsigned readers_ = 0;                            // highest reader number so far, plus 1
    unsigned turn_ = 0;                               // next reader, round-robin
    unsigned waiting_ = 0;                            // readers whose request is held back
    Ring<Cycle> offers_;                              // of the requests not served yet
};

}  // namespace tessera::schedule
