#include "testbench/common/parallel.h"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tessera {
namespace {

std::size_t chosen_threads = 0;  // 0: one per core
thread_local bool sharing = false;

}  // namespace

std::size_t thread_count() {
    if (chosen_threads > 0)
        return chosen_threads;
    cpu_set_t cores;
    if (::sched_getaffinity(0, sizeof cores, &cores) == 0)
        return static_cast<std::size_t>(CPU_COUNT(&cores));
    return std::max(1U, std::thread::hardware_concurrency());
}

OnThreads::OnThreads(std::size_t threads) {
    chosen_threads = threads;
}

OnThreads::~OnThreads() {
    chosen_threads = 0;
}

void share_chunks(std::size_t chunks, const std::function<void(const NextChunk& next)>& work, std::size_t threads) {
    threads = sharing ? 1 : std::min(threads, chunks);
    std::atomic<std::size_t> handed_out{0};
    std::mutex failing;
    std::exception_ptr failure;
    std::size_t failed_chunk = chunks;
    const auto run = [&] {
        const bool outer = sharing;
        sharing = outer || threads > 1;
        std::size_t at = 0;
        try {
            work([&](std::size_t& chunk) {
                chunk = at = handed_out++;
                return chunk < chunks;
            });
        } catch (...) {
            handed_out = chunks;
            const std::lock_guard<std::mutex> lock(failing);
            if (!failure || at < failed_chunk) {
                failure = std::current_exception();
                failed_chunk = at;
            }
        }
        sharing = outer;
    };
    std::vector<std::thread> others;
    others.reserve(threads);
    try {
        while (others.size() + 1 < threads)
            others.emplace_back(run);
    } catch (const std::exception&) {
        // No more threads, or no memory for them: the existing ones do the work.
    }
    run();
    for (std::thread& other : others)
        other.join();
    if (failure)
        std::rethrow_exception(failure);
}

}  // namespace tessera
