#include <atomic>
#include <catch2/catch.hpp>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "testbench/common/in_background.h"
#include "testbench/common/parallel.h"

using namespace tessera;

TEST_CASE("every chunk is handed out once, on any number of threads") {
    for (const std::size_t threads : {1U, 2U, 3U, 8U}) {
        const OnThreads on(threads);
        CHECK(thread_count() == threads);
        for (const std::size_t chunks : {0U, 1U, 2U, 1000U}) {
            std::vector<int> calls(chunks, 0);
            for_each_chunk(chunks, [&] { return [&](std::size_t chunk) { ++calls[chunk]; }; });
            CHECK(calls == std::vector<int>(chunks, 1));
        }
    }
    CHECK(thread_count() >= 1);
}

TEST_CASE("nested work stays on its thread") {
    const OnThreads on(2);
    std::vector<int> elsewhere(4, 0);
    for_each_chunk(elsewhere.size(), [&] {
        return [&](std::size_t outer) {
            const std::thread::id here = std::this_thread::get_id();
            for_each_chunk(100, [&] {
                return [&](std::size_t) { elsewhere[outer] += std::this_thread::get_id() == here ? 0 : 1; };
            });
        };
    });
    CHECK(std::accumulate(elsewhere.begin(), elsewhere.end(), 0) == 0);
}

TEST_CASE("work nested in work of one thread may use several") {
    const OnThreads on(2);
    for (const std::size_t tasks : {1U, 4U}) {
        std::atomic<std::size_t> done{0}, workers{0};
        parallel_for(tasks, 3, [&](std::size_t task) {
            done += task + 1;
            for_each_chunk(100, [&] {
                ++workers;
                return [](std::size_t) {};
            });
        });
        CHECK(done == tasks * (tasks + 1) / 2);
        CHECK(workers == (tasks == 1 ? 2 : tasks));
    }
}

TEST_CASE("of exceptions on any threads the lowest chunk's reaches the caller") {
    for (const std::size_t threads : {1U, 3U}) {
        const OnThreads on(threads);
        const auto fail = [](std::size_t from) {
            for_each_chunk(50, [&] {
                return [&](std::size_t chunk) {
                    if (chunk >= from)
                        throw std::runtime_error("chunk " + std::to_string(chunk));
                };
            });
        };
        CHECK_THROWS_WITH(fail(49), "chunk 49");
        CHECK_THROWS_AS(fail(0), std::runtime_error);
    }
}

TEST_CASE("background items are processed in order, up to the one that fails") {
    for (const std::size_t threads : {1U, 2U}) {
        const OnThreads on(threads);
        for (const std::size_t count : {0U, 1U, 127U, 128U, 129U, 1024U, 5000U}) {
            std::vector<std::size_t> taken;
            std::vector<std::size_t> all(count);
            std::iota(all.begin(), all.end(), 0);
            InBackground<std::size_t> background([&](std::size_t item) { taken.push_back(item); });
            for (const std::size_t item : all)
                background.put(item);
            background.finish();
            CHECK(taken == all);
        }
        std::size_t last = 0;
        const auto run = [&](bool finish) {
            InBackground<std::size_t> background([&](std::size_t item) {
                if (item == 300)
                    throw std::runtime_error("300");
                last = item;
            });
            for (std::size_t item = 0; item < 5000; ++item)
                background.put(item);
            if (finish)
                background.finish();
        };
        CHECK_THROWS_WITH(run(true), "300");
        CHECK(last == 299);
        if (threads > 1)
            CHECK_NOTHROW(run(false));  // abandoned without finish()
    }
}

TEST_CASE("work beside the caller's returns its result or its exception") {
    for (const std::size_t threads : {1U, 2U}) {
        const OnThreads on(threads);
        const std::thread::id here = std::this_thread::get_id();
        auto where = beside([] { return std::this_thread::get_id(); });
        CHECK((where.get() == here) == (threads == 1));
        auto failing = beside([]() -> int { throw std::runtime_error("no"); });
        CHECK_THROWS_WITH(failing.get(), "no");
    }
}
