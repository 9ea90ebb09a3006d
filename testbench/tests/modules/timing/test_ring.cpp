#include <catch2/catch.hpp>
#include <memory>
#include <vector>

#include "modules/timing/pending_item.h"
#include "modules/timing/ring.h"

// The ring on which buffers are based, and the item that waits in front of a full one.

using namespace tessera;

TEST_CASE("ring: items leave in the order they came, over several turns") {
    Ring<int> ring(3);
    CHECK(ring.capacity() == 3);
    CHECK(ring.empty());
    int pushed = 0;
    int popped = 0;
    for (int round = 0; round < 5; ++round) {
        while (!ring.full()) {
            ring.push(pushed++);
            CHECK(ring.back() == pushed - 1);
        }
        CHECK(ring.size() == 3);
        for (std::size_t k = 0; k < 3; ++k)
            CHECK(ring.at(k) == popped + static_cast<int>(k));
        for (int k = 0; k < 2; ++k) {
            CHECK(ring.front() == popped++);
            ring.pop();
        }
        CHECK(ring.size() == 1);
    }
    ring.pop();
    CHECK(ring.empty());
    CHECK(ring.back() == pushed - 1);  // the last one, although it has left
}

TEST_CASE("ring: growing doubles the capacity, and keeps the items in order") {
    Ring<int> ring(3);
    for (int k = 0; k < 3; ++k)
        ring.push(k);
    ring.pop();
    ring.push(3);  // the oldest is not in the first slot
    ring.grow();
    CHECK(ring.capacity() == 6);
    for (int k = 4; k < 7; ++k)
        ring.push(k);
    CHECK(ring.full());
    for (int k = 1; k < 7; ++k) {
        CHECK(ring.front() == k);
        ring.pop();
    }
    Ring<int> none;
    none.grow();
    CHECK(none.capacity() == 1);
}

TEST_CASE("ring: a capacity of one") {
    Ring<int> ring(1);
    for (int k = 0; k < 3; ++k) {
        ring.push(k);
        CHECK(ring.full());
        CHECK(ring.front() == k);
        CHECK(ring.back() == k);
        ring.pop();
        CHECK(ring.empty());
        CHECK(ring.back() == k);
    }
}

TEST_CASE("ring: items are pushed and popped at both ends") {
    Ring<int> ring(3);
    ring.push(1);
    ring.push_front() = 0;  // before the first slot
    ring.push(2);
    for (int k = 0; k < 3; ++k)
        CHECK(ring.at(static_cast<std::size_t>(k)) == k);
    ring.pop_back();
    ring.push(3);
    ring.pop();
    CHECK(ring.front() == 1);
    CHECK(ring.at(1) == 3);
    CHECK(ring.size() == 2);
}

TEST_CASE("ring: without capacity it is both full and empty") {
    const Ring<int> ring;
    CHECK(ring.empty());
    CHECK(ring.full());
}

TEST_CASE("ring: slots keep what they own, and a reused slot is as it was left") {
    struct Slot {
        std::unique_ptr<int> owned = std::make_unique<int>(0);  // not copied
    };
    Ring<Slot> ring(2);
    const int* const first = ring.at(0).owned.get();
    *ring.push().owned = 7;
    ring.pop();
    ring.push();
    ring.pop();
    CHECK(ring.push().owned.get() == first);
    CHECK(*ring.front().owned == 7);
}

TEST_CASE("pending item: due from its cycle on, until it is taken") {
    int item = 5;
    PendingItem<int> pending;
    CHECK(pending.empty());
    CHECK_FALSE(pending.due(100));
    pending.hold(item, 10);
    CHECK_FALSE(pending.empty());
    CHECK(pending.due_cycle() == 10);
    CHECK_FALSE(pending.due(9));
    CHECK(pending.due(10));
    CHECK(&pending.take() == &item);
    CHECK(pending.empty());
    CHECK_FALSE(pending.due(100));
}
