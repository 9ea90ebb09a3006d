#pragma once
#include <array>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "testbench/common/parallel.h"

namespace tessera {

/// Processes items in order on a thread of its own, or immediately on a single core. put() waits while the buffer is
/// full.
template <class Item>
class InBackground {
  public:
    explicit InBackground(std::function<void(const Item&)> take) : take_(std::move(take)) {
        if (thread_count() == 1)
            return;
        try {
            taker_ = std::thread([this] { take_all(); });
        } catch (const std::system_error&) {
            // No thread available: items are processed immediately.
        }
    }
    ~InBackground() { end(); }
    InBackground(const InBackground&) = delete;
    InBackground& operator=(const InBackground&) = delete;

    void put(const Item& item) {
        if (!taker_.joinable()) {
            take_(item);
            return;
        }
        std::vector<Item>& block = blocks_[filled_ % blocks_.size()];
        block.push_back(item);
        if (block.size() < block_items)
            return;
        std::unique_lock<std::mutex> lock(mutex_);
        ++filled_;
        changed_.notify_all();
        changed_.wait(lock, [&] { return filled_ < taken_ + blocks_.size(); });
    }

    /// Returns when all items have been processed. Rethrows the exception of an item; later items were skipped.
    void finish() {
        end();
        if (failure_)
            std::rethrow_exception(std::exchange(failure_, nullptr));
    }

  private:
    static constexpr std::size_t block_items = 512;

    void end() {
        if (!taker_.joinable())
            return;
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            ++filled_;  // the last block, which may be empty
            ended_ = true;
        }
        changed_.notify_all();
        taker_.join();
    }

    void take_all() {
        std::unique_lock<std::mutex> lock(mutex_);
        for (;;) {
            changed_.wait(lock, [&] { return taken_ < filled_ || ended_; });
            if (taken_ == filled_)
                return;
            lock.unlock();
            take_block(blocks_[taken_ % blocks_.size()]);
            lock.lock();
            ++taken_;
            changed_.notify_all();
        }
    }

    void take_block(std::vector<Item>& block) {
        try {
            for (const Item& item : block)
                if (!failure_)
                    take_(item);
        } catch (...) {
            failure_ = std::current_exception();
        }
        block.clear();
    }

    std::function<void(const Item&)> take_;
    std::array<std::vector<Item>, 8> blocks_;  // a ring: [taken_, filled_) are the taker's, the next is put()'s
    std::exception_ptr failure_;               // of the thread
    std::mutex mutex_;                         // guards the members below
    std::condition_variable changed_;
    std::size_t filled_ = 0, taken_ = 0;
    bool ended_ = false;
    std::thread taker_;
};

}  // namespace tessera
