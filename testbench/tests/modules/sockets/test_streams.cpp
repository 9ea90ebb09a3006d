#include <catch2/catch.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "testbench/tests/support/timed_modules.h"

// The streams' protocol: exclusion, withheld END_REQ, annotated delays, random stalls, and each violation's message.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;
using sc_core::SC_PS;
using sc_core::sc_time;
using sc_core::SC_ZERO_TIME;

namespace {

const sc_time period(10, SC_PS);

/// An input of a given depth from which only the test takes items.
struct Holder : sc_core::sc_module {
    CycleScheduler clock{"clock", period};
    StreamInput<int> in{"in"};
    Caller owner{clock};
    std::vector<std::uint64_t> called;
    std::vector<bool> room_when_called;

    explicit Holder(const sc_core::sc_module_name& name, std::size_t depth) : sc_module(name) {
        in.clocked_by(clock, owner, depth, {});
        owner.on_step = [this] {
            called.push_back(clock.cycle());
            room_when_called.push_back(!in.holds_back());
        };
    }
};

/// An output whose owner records when it is called.
struct Offerer : sc_core::sc_module {
    CycleScheduler clock{"clock", period};
    StreamOutput<int> out{"out"};
    Caller owner{clock};
    std::vector<std::uint64_t> called;

    explicit Offerer(const sc_core::sc_module_name& name) : sc_module(name) {
        out.clocked_by(clock, owner);
        owner.on_step = [this] { called.push_back(clock.cycle()); };
    }
};

/// An input without a clock.
struct Functional : sc_core::sc_module {
    StreamInput<int> in{"in"};
    explicit Functional(const sc_core::sc_module_name& name) : sc_module(name) {}
};

std::vector<int> numbers(int count) {
    std::vector<int> result(static_cast<std::size_t>(count));
    std::iota(result.begin(), result.end(), 0);
    return result;
}

}  // namespace

TEST_CASE("stream input: takes as many items as its buffer holds, the next waits for END_REQ") {
    Holder holder("holder", 2);
    BareInitiator<int> producer("producer");
    producer.out.bind(holder.in);
    sc_core::sc_start(SC_ZERO_TIME);
    std::vector<int> items = numbers(4);
    tlm::tlm_phase phase = tlm::BEGIN_REQ;
    CHECK(producer.offer(items[0], phase, SC_ZERO_TIME) == tlm::TLM_UPDATED);
    CHECK(phase == tlm::END_REQ);
    phase = tlm::BEGIN_REQ;
    CHECK(producer.offer(items[1], phase, SC_ZERO_TIME) == tlm::TLM_UPDATED);
    CHECK(holder.in.size() == 2);
    CHECK_FALSE(holder.in.holds_back());

    phase = tlm::BEGIN_REQ;
    CHECK(producer.offer(items[2], phase, SC_ZERO_TIME) == tlm::TLM_ACCEPTED);
    CHECK(phase == tlm::BEGIN_REQ);
    CHECK(holder.in.holds_back());
    CHECK(producer.ended.empty());
    holder.clock.wake(holder.owner);
    sc_core::sc_start(sc_time(1, SC_PS));  // no room: the item stays with the producer
    CHECK(producer.ended.empty());
    items[2] = 20;  // still the producer's: the item is copied with END_REQ, not before

    CHECK(holder.in.front() == 0);
    holder.in.pop();  // makes room for it
    REQUIRE(producer.ended.size() == 1);
    CHECK(producer.ended[0].first == &items[2]);
    CHECK_FALSE(holder.in.holds_back());
    CHECK(holder.in.size() == 2);
    CHECK(holder.in.front() == 1);
    holder.in.pop();
    CHECK(holder.in.front() == 20);
    CHECK(holder.in.taken() == 3);
}

TEST_CASE("stream input: the delay of nb_transport_fw is added before the item is taken") {
    Holder holder("holder", 1);
    BareInitiator<int> producer("producer");
    producer.out.bind(holder.in);
    sc_core::sc_start(sc_time(100, SC_PS));  // cycle 10
    int item = 7;
    tlm::tlm_phase phase = tlm::BEGIN_REQ;
    // 21 ps after cycle 10 it arrives in cycle 13, rounded up; until then it waits, even if there is room
    CHECK(producer.offer(item, phase, sc_time(21, SC_PS)) == tlm::TLM_ACCEPTED);
    CHECK(holder.in.empty());
    holder.clock.wake(holder.owner);
    sc_core::sc_start(sc_time(9, SC_PS));
    CHECK(holder.called == std::vector<std::uint64_t>{10});
    CHECK(holder.in.empty());
    sc_core::sc_start(sc_time(20, SC_PS));
    CHECK(producer.ended.empty());
    sc_core::sc_start(sc_time(2, SC_PS));
    REQUIRE(producer.ended.size() == 1);
    CHECK(holder.in.size() == 1);
    CHECK(holder.called.back() == 13);
    CHECK(holder.room_when_called == std::vector<bool>{false, true});  // admitted before its owner's step
}

TEST_CASE("stream output: the delay of nb_transport_bw is added before its owner is called") {
    Offerer offerer("offerer");
    StreamOutput<int>& out = offerer.out;
    BareTarget<int> target("target");
    out.bind(target.in);
    sc_core::sc_start(sc_time(100, SC_PS));  // cycle 10
    int item = 1;
    CHECK_FALSE(out.send(item));
    CHECK_FALSE(out.free());
    target.send_back(item, tlm::END_REQ, sc_time(35, SC_PS));
    CHECK(out.free());
    sc_core::sc_start();
    CHECK(offerer.called == std::vector<std::uint64_t>{14});
}

TEST_CASE("stream output: END_REQ by return leaves it free, and does not call its owner") {
    Offerer offerer("offerer");
    StreamOutput<int>& out = offerer.out;
    BareTarget<int> target("target");
    out.bind(target.in);
    sc_core::sc_start(SC_ZERO_TIME);
    target.status = tlm::TLM_UPDATED;
    target.phase_back = tlm::END_REQ;
    int item = 1;
    CHECK(out.send(item));
    CHECK(out.free());
    sc_core::sc_start();
    CHECK(offerer.called.empty());
}

TEST_CASE("stream output: deliver offers an item once, and reports once that it is taken") {
    Offerer offerer("offerer");
    StreamOutput<int>& out = offerer.out;
    BareTarget<int> target("target");
    out.bind(target.in);
    sc_core::sc_start(SC_ZERO_TIME);
    int item = 1;
    CHECK_FALSE(out.deliver(item));
    CHECK_FALSE(out.deliver(item));  // a second BEGIN_REQ would be a breach
    target.send_back(item, tlm::END_REQ, SC_ZERO_TIME);
    target.status = tlm::TLM_COMPLETED;  // a response to BEGIN_REQ that would be a violation
    CHECK(out.deliver(item));
    target.status = tlm::TLM_UPDATED;
    target.phase_back = tlm::END_REQ;
    CHECK(out.deliver(item));  // the next, accepted at once
    target.status = tlm::TLM_ACCEPTED;
    CHECK_FALSE(out.deliver(item));
}

TEST_CASE("stream: no item is duplicated, lost or reordered before a consumer of one place") {
    // The consumer takes an item in every cycle in which it is called; producer and consumer have no latency: all 100
    // items are transferred in the cycle in which they are offered, one at a time.
    CycleScheduler clock("clock", period);
    Sink<int> sink("sink", clock);
    Driver<int> driver("driver", clock);
    driver.out.bind(sink.in);
    driver.items = numbers(100);
    sc_core::sc_start();
    CHECK(sink.items == numbers(100));
    CHECK(driver.idle());
    CHECK(clock.last_cycle() == 0);
}

TEST_CASE("stream: items that are each stalled for one cycle pass one per cycle") {
    // longest = 1 and 1000 per mille: item k is offered when item k - 1 is taken, in cycle k, and taken in cycle k + 1
    CycleScheduler clock("clock", period);
    Sink<int> sink("sink", clock, {1, 1000, 1});
    Driver<int> driver("driver", clock);
    driver.out.bind(sink.in);
    driver.items = numbers(50);
    sc_core::sc_start();
    CHECK(sink.items == numbers(50));
    for (std::size_t k = 0; k < 50; ++k)
        REQUIRE(sink.cycles[k] == k + 1);
}

TEST_CASE("stream: random stalls delay the requested share of items, for up to the longest time") {
    CycleScheduler clock("clock", period);
    Sink<int> sink("sink", clock, {42, 300, 8});
    Driver<int> driver("driver", clock);
    driver.out.bind(sink.in);
    driver.items = numbers(4000);
    sc_core::sc_start();
    REQUIRE(sink.items == numbers(4000));
    std::vector<unsigned> waited(9, 0);
    for (std::size_t k = 0; k < 4000; ++k) {
        REQUIRE(sink.cycles[k] >= driver.offered[k]);
        const std::uint64_t wait = sink.cycles[k] - driver.offered[k];
        REQUIRE(wait <= 8);
        ++waited[wait];
    }
    // 1200 of 4000 expected, standard deviation 29; each of 8 lengths 150, deviation 12: tolerance of five deviations
    const unsigned stalled = 4000 - waited[0];
    CHECK(stalled > 1200 - 145);
    CHECK(stalled < 1200 + 145);
    for (std::size_t length = 1; length <= 8; ++length) {
        CHECK(waited[length] > 150 - 60);
        CHECK(waited[length] < 150 + 60);
    }
}

TEST_CASE("stream: stalls depend on the seed and the channel, and on nothing else") {
    const auto draw = [](std::uint64_t seed, const char* channel) {
        RandomStalls stalls({seed, 500, 16}, channel);
        std::vector<unsigned> drawn(200);
        for (unsigned& stall : drawn)
            stall = stalls.next();
        return drawn;
    };
    CHECK(draw(1, "a.in") == draw(1, "a.in"));
    CHECK(draw(1, "a.in") != draw(2, "a.in"));
    CHECK(draw(1, "a.in") != draw(1, "b.in"));
    RandomStalls never({1, 0, 16}, "a.in");
    for (int k = 0; k < 1000; ++k)
        REQUIRE(never.next() == 0);
}

TEST_CASE("stream: every protocol violation of a producer is an error that names the consumer's socket") {
    Holder holder("holder", 1);
    BareInitiator<int> producer("producer"), second("second");
    Functional functional("functional");
    producer.out.bind(holder.in);
    second.out.bind(functional.in);
    sc_core::sc_start(SC_ZERO_TIME);
    int item = 1;
    for (tlm::tlm_phase phase : {tlm::tlm_phase(tlm::END_REQ), tlm::tlm_phase(tlm::BEGIN_RESP),
                                 tlm::tlm_phase(tlm::END_RESP), tlm::tlm_phase(tlm::UNINITIALIZED_PHASE)})
        CHECK_THAT(error_of([&] { producer.offer(item, phase, SC_ZERO_TIME); }),
                   Contains("holder.in") && Contains("other than BEGIN_REQ"));
    tlm::tlm_phase phase = tlm::BEGIN_REQ;
    producer.offer(item, phase, SC_ZERO_TIME);  // taken
    phase = tlm::BEGIN_REQ;
    producer.offer(item, phase, SC_ZERO_TIME);  // waits
    phase = tlm::BEGIN_REQ;
    CHECK_THAT(error_of([&] { producer.offer(item, phase, SC_ZERO_TIME); }),
               Contains("holder.in") && Contains("BEGIN_REQ before END_REQ"));
    CHECK(holder.in.taken() == 1);
    phase = tlm::BEGIN_REQ;
    CHECK_THAT(error_of([&] { second.offer(item, phase, SC_ZERO_TIME); }),
               Contains("functional.in") && Contains("nb_transport in functional mode"));
}

TEST_CASE("stream: every protocol violation of a consumer is an error that names the producer's socket") {
    Offerer offerer("offerer");
    StreamOutput<int>& out = offerer.out;
    BareTarget<int> target("target");
    out.bind(target.in);
    sc_core::sc_start(SC_ZERO_TIME);
    int item = 1;
    CHECK_THAT(error_of([&] { target.send_back(item, tlm::END_REQ, SC_ZERO_TIME); }),
               Contains("offerer.out") && Contains("the expected END_REQ"));  // nothing is on offer
    // invalid responses
    target.status = tlm::TLM_COMPLETED;
    CHECK_THAT(error_of([&] { out.send(item); }), Contains("offerer.out: BEGIN_REQ was answered by neither"));
    target.status = tlm::TLM_UPDATED;
    target.phase_back = tlm::BEGIN_RESP;
    CHECK_THAT(error_of([&] { out.send(item); }), Contains("offerer.out: BEGIN_REQ was answered by neither"));
    CHECK(out.free());

    target.status = tlm::TLM_ACCEPTED;
    CHECK_FALSE(out.send(item));
    for (const tlm::tlm_phase& phase :
         {tlm::tlm_phase(tlm::BEGIN_REQ), tlm::tlm_phase(tlm::BEGIN_RESP), tlm::tlm_phase(tlm::END_RESP)})
        CHECK_THAT(error_of([&] { target.send_back(item, phase, SC_ZERO_TIME); }), Contains("the expected END_REQ"));
    CHECK_FALSE(out.free());
    CHECK_THAT(error_of([&] { out.send(item); }),
               Contains("offerer.out: BEGIN_REQ before END_REQ"));  // exclusion
    CHECK(error_of([&] { target.send_back(item, tlm::END_REQ, SC_ZERO_TIME); }).empty());
    CHECK(out.free());
    int other = 2;
    CHECK_FALSE(out.send(item));
    CHECK_THAT(error_of([&] { target.send_back(other, tlm::END_REQ, SC_ZERO_TIME); }),
               Contains("offerer.out"));  // for an item that was not offered
}

TEST_CASE("stream: it has neither direct nor debug access") {
    CycleScheduler clock("clock", period);
    Sink<int> sink("sink", clock);
    Offerer offerer("offerer");
    offerer.out.bind(sink.in);
    sc_core::sc_start(SC_ZERO_TIME);
    int item = 3;
    tlm::tlm_dmi dmi;
    CHECK_FALSE(offerer.out->get_direct_mem_ptr(item, dmi));
    CHECK(offerer.out->transport_dbg(item) == 0);
    sink.in->invalidate_direct_mem_ptr(0, 7);  // it has none: no effect
    CHECK(sink.items.empty());
}

TEST_CASE("stream: the module behind a socket is found") {
    struct NoObject : sc_core::sc_interface {
    } no_object;
    struct Channel : sc_core::sc_module, sc_core::sc_interface {
        explicit Channel(const sc_core::sc_module_name& name) : sc_module(name) {}
    } channel("channel");
    CycleScheduler clock("clock", period);
    Sink<int> sink("sink", clock);
    Offerer offerer("offerer");
    offerer.out.bind(sink.in);
    sc_core::sc_start(SC_ZERO_TIME);
    CHECK(module_behind(nullptr) == nullptr);
    CHECK(module_behind(&no_object) == nullptr);
    CHECK(module_behind(&channel) == &channel);
    CHECK(module_behind(offerer.out.get_base_port().get_interface()) == &sink);
    CHECK(module_behind(sink.in.get_base_port().get_interface()) == &offerer);
    CHECK(offerer.out.consumer() == &sink);
}

TEST_CASE("stream: b_transport passes on the delay it is given") {
    CycleScheduler clock("clock", period);
    Sink<int> sink("sink", clock);
    Offerer offerer("offerer");
    offerer.out.bind(sink.in);
    sc_core::sc_start(SC_ZERO_TIME);
    int item = 3;
    sc_time delay(70, SC_PS);
    offerer.out->b_transport(item, delay);
    CHECK(sink.items == std::vector<int>{3});
    CHECK(sink.delays[0] == sc_time(70, SC_PS));
    CHECK(delay == sc_time(70, SC_PS));
}
