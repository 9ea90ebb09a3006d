#pragma once
#include <cstddef>
#include <functional>
#include <future>
#include <utility>

namespace tessera {

/// Number of threads used by for_each_chunk(): the cores available to this process, unless an OnThreads exists.
std::size_t thread_count();

/// Sets the number of threads while an object exists, for tests that compare results. One at a time.
class OnThreads {
  public:
    explicit OnThreads(std::size_t threads);
    ~OnThreads();
    OnThreads(const OnThreads&) = delete;
    OnThreads& operator=(const OnThreads&) = delete;
};

/// Assigns the next chunk 0, 1, ... to the calling thread; false when none is left.
using NextChunk = std::function<bool(std::size_t& chunk)>;

/// Calls work(next) once on each of at most that many threads, including the caller's, and returns when all calls have
/// returned. The assignment of chunks to threads is arbitrary: store results by chunk, and add up sums over chunks
/// afterwards, in their order. A nested call runs on the calling thread alone. After an exception no more chunks are
/// assigned; that of the lowest chunk is rethrown.
void share_chunks(std::size_t chunks, const std::function<void(const NextChunk& next)>& work,
                  std::size_t threads = thread_count());

/// The same with a worker made by make_worker() for each thread: worker(chunk) is called for every chunk.
template <class MakeWorker>
void for_each_chunk(std::size_t chunks, const MakeWorker& make_worker) {
    share_chunks(chunks, [&](const NextChunk& next) {
        auto worker = make_worker();
        for (std::size_t chunk; next(chunk);)
            worker(chunk);
    });
}

/// Calls work(k) for k = 0 .. count - 1, on at most this many threads.
inline void parallel_for(std::size_t count, std::size_t threads, const std::function<void(std::size_t)>& work) {
    share_chunks(
        count,
        [&](const NextChunk& next) {
            for (std::size_t k; next(k);)
                work(k);
        },
        threads);
}

/// Runs the work concurrently with the caller, on a thread of its own; on a single core, when its result is requested.
template <class Work>
auto beside(Work work) {
    return std::async(thread_count() > 1 ? std::launch::async | std::launch::deferred : std::launch::deferred,
                      std::move(work));
}

}  // namespace tessera
