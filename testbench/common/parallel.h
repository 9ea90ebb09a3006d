#pragma once
#include <cstddef>
#include <functional>
#include <future>
#include <utility>

namespace tessera {

/// Threads that for_each_chunk() uses: the cores this process may run on, unless an OnThreads lives.
std::size_t thread_count();

/// While one lives, work is done on `threads` threads: for tests that compare results. One at a time.
class OnThreads {
  public:
    explicit OnThreads(std::size_t threads);
    ~OnThreads();
    OnThreads(const OnThreads&) = delete;
    OnThreads& operator=(const OnThreads&) = delete;
};

/// The chunk 0, 1, ... that a thread is to work on next; false when there is none left.
using NextChunk = std::function<bool(std::size_t& chunk)>;

/// Calls work(next) once on each of at most that many threads, the caller's among them, and returns when all have
/// returned. Which thread gets which chunk is a matter of chance: a result must be put where the chunk says, and sums
/// over chunks made afterwards in their order. A nested call runs on the calling thread alone. An
/// exception ends the handing out of chunks; that of the lowest chunk is thrown again.
void share_chunks(std::size_t chunks, const std::function<void(const NextChunk& next)>& work,
                  std::size_t threads = thread_count());

/// The same with a worker of its own, make_worker(), for each thread: worker(chunk) is called for every chunk.
template <class MakeWorker>
void for_each_chunk(std::size_t chunks, const MakeWorker& make_worker) {
    share_chunks(chunks, [&](const NextChunk& next) {
        auto worker = make_worker();
        for (std::size_t chunk; next(chunk);)
            worker(chunk);
    });
}

/// Calls work(k) for each k from 0 to count - 1, on at most this many threads.
inline void parallel_for(std::size_t count, std::size_t threads, const std::function<void(std::size_t)>& work) {
    share_chunks(
        count,
        [&](const NextChunk& next) {
            for (std::size_t k; next(k);)
                work(k);
        },
        threads);
}

/// Does the work beside the caller's, on a thread of its own; where there is but one core, when it is asked for.
template <class Work>
auto beside(Work work) {
    return std::async(thread_count() > 1 ? std::launch::async | std::launch::deferred : std::launch::deferred,
                      std::move(work));
}

}  // namespace tessera
