#include <catch2/catch.hpp>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "testbench/output/trace/timeline_writer.h"

namespace tessera {
namespace {

using nlohmann::json;

/// A timeline's events of one phase, in file order.
std::vector<json> events_of(const std::string& text, const std::string& phase) {
    std::vector<json> events;
    const json timeline = json::parse(text);
    for (const json& event : timeline.at("traceEvents"))
        if (event.at("ph") == phase)
            events.push_back(event);
    return events;
}

TEST_CASE("Timeline: a small file is written exactly") {
    std::ostringstream out;
    TimelineWriter writer(out, 2500);
    const auto track = writer.add_track("Transform");
    const TimelineWriter::Item edge{12, 3, "edge 1"};
    const TimelineWriter::Item whole{13, 4, ""};
    writer.interval(track, "busy", "", 2, 4, &edge);
    writer.flow(track, TimelineWriter::FlowStep::begin, 12, 2);
    writer.interval(track, "blocked", "Pass or Tessellate", 4, 8, &whole);
    writer.flow(track, TimelineWriter::FlowStep::pass, 13, 4);
    writer.interval(track, "blocked", "Pass or Tessellate", 8, 1'000'008);
    writer.flow(track, TimelineWriter::FlowStep::end, 13, 8);
    writer.counter("Triangle Queue", "triangles", 4, 17);
    writer.finish();
    REQUIRE(out.str() == R"({"displayTimeUnit":"ns","traceEvents":[
{"ph":"M","pid":1,"name":"process_name","args":{"name":"tessera"}},
{"ph":"M","pid":1,"name":"thread_name","tid":1,"args":{"name":"Transform"}},
{"ph":"M","pid":1,"name":"thread_sort_index","tid":1,"args":{"sort_index":0}},
{"ph":"X","pid":1,"name":"busy","tid":1,"ts":0.005,"dur":0.005,"cname":"good","args":{"triangle":12,"part":"edge 1","base":3}},
{"ph":"s","pid":1,"name":"triangle","cat":"triangle","id":12,"tid":1,"ts":0.00625},
{"ph":"X","pid":1,"name":"blocked","tid":1,"ts":0.01,"dur":0.01,"cname":"terrible","args":{"detail":"Pass or Tessellate","triangle":13,"base":4}},
{"ph":"t","pid":1,"name":"triangle","cat":"triangle","id":13,"tid":1,"ts":0.01125},
{"ph":"X","pid":1,"name":"blocked","tid":1,"ts":0.02,"dur":2500,"cname":"terrible","args":{"detail":"Pass or Tessellate"}},
{"ph":"f","pid":1,"name":"triangle","cat":"triangle","id":13,"tid":1,"ts":0.02125,"bp":"e"},
{"ph":"C","pid":1,"name":"Triangle Queue","ts":0.01,"args":{"triangles":17}}
]}
)");
}

TEST_CASE("Timeline: time is exact") {
    const auto written = [](std::uint64_t period, std::uint64_t cycle) {
        std::ostringstream out;
        TimelineWriter writer(out, period);
        writer.counter("c", "s", cycle, 0);
        writer.finish();
        const std::string text = out.str();
        const std::size_t begin = text.find("\"ts\":") + 5;
        return text.substr(begin, text.find(',', begin) - begin);
    };
    CHECK(written(5000, 1) == "0.005");
    CHECK(written(1, 1) == "0.000001");
    CHECK(written(1, 0) == "0");
    CHECK(written(1000, 1000) == "1");
    CHECK(written(1000, 10'010) == "10.01");
    CHECK(written(1, 123'456'789) == "123.456789");
    CHECK(written(1, 100'000) == "0.1");
    CHECK(written(1, UINT64_MAX) == "18446744073709.551615");
    std::ostringstream out;
    CHECK_THROWS_AS(TimelineWriter(out, 0), std::logic_error);
}

TEST_CASE("Timeline: intervals are cut to the window") {
    std::mt19937_64 random(3);
    for (int i = 0; i < 300; ++i) {
        const TraceWindow window{random() % 30, i % 3 == 0 ? UINT64_MAX : random() % 30};
        std::ostringstream out;
        TimelineWriter writer(out, 1'000'000, window);
        const auto track = writer.add_track("a");
        std::vector<std::pair<std::uint64_t, std::uint64_t>> expected, written;
        for (std::uint64_t begin = random() % 3; begin < 40; begin += random() % 3) {
            const std::uint64_t end = begin + random() % 8;
            writer.interval(track, "busy", "", begin, end);
            std::set<std::uint64_t> cycles;
            for (std::uint64_t cycle = begin; cycle < end; ++cycle)
                if (cycle >= window.first && cycle <= window.last)
                    cycles.insert(cycle);
            if (!cycles.empty())
                expected.emplace_back(*cycles.begin(), cycles.size());
            begin = end;
        }
        writer.finish();
        for (const json& event : events_of(out.str(), "X"))
            written.emplace_back(event.at("ts"), event.at("dur"));
        CAPTURE(i, window.first, window.last);
        REQUIRE(written == expected);
    }
}

TEST_CASE("Timeline: a flow has no steps outside the window") {
    std::ostringstream out;
    TimelineWriter writer(out, 1'000'000, {5, 8});
    const auto track = writer.add_track("a");
    for (std::uint64_t cycle = 3; cycle < 11; ++cycle)
        writer.flow(track, TimelineWriter::FlowStep::pass, 1, cycle);
    CHECK_THROWS_AS(writer.flow(track + 1, TimelineWriter::FlowStep::pass, 1, 5), std::logic_error);
    writer.finish();
    CHECK_THROWS_AS(writer.flow(track, TimelineWriter::FlowStep::pass, 1, 5), std::logic_error);
    std::vector<double> times;
    for (const json& event : events_of(out.str(), "t"))
        times.push_back(event.at("ts"));
    CHECK(times == std::vector<double>{5.5, 6.5, 7.5, 8.5});
}

TEST_CASE("Timeline: a counter enters the window with its value") {
    const auto written = [](TraceWindow window) {
        std::ostringstream out;
        TimelineWriter writer(out, 1'000'000, window);
        writer.counter("queue", "used", 1, 10);
        writer.counter("other", "used", 2, 7);
        writer.counter("queue", "used", 3, 11);
        writer.counter("queue", "used", 6, 12);
        writer.counter("queue", "used", 9, 13);
        writer.finish();
        std::string text;
        for (const json& event : events_of(out.str(), "C"))
            text += event.at("name").get<std::string>() + " " + event.at("ts").dump() + " " +
                    event.at("args").at("used").dump() + "\n";
        return text;
    };
    CHECK(written({}) == "queue 1 10\nother 2 7\nqueue 3 11\nqueue 6 12\nqueue 9 13\n");
    CHECK(written({5, 8}) == "queue 5 11\nqueue 6 12\nother 5 7\n");
    CHECK(written({6, 6}) == "queue 6 12\nother 6 7\n");
    CHECK(written({7, 8}) == "queue 7 12\nother 7 7\n");
    CHECK(written({10, 20}).empty());
    CHECK(written({9, 3}).empty());
}

TEST_CASE("Timeline: tracks keep their order, states their colours, and any name is legal JSON") {
    std::ostringstream out;
    TimelineWriter writer(out, 1000);
    const std::vector<std::string> names = {"z", "a \"quoted\" \\ name", "tab\tand\nline\x01", "\xc3\xbc"};
    std::vector<TimelineWriter::Track> tracks;
    for (const std::string& name : names)
        tracks.push_back(writer.add_track(name));
    const std::vector<std::string> states = {"busy", "blocked", "waiting for memory", "starved", "of my own"};
    for (int i = 0; i < 5000; ++i) {
        const auto cycle = static_cast<std::uint64_t>(i);
        writer.interval(tracks[static_cast<std::size_t>(i) % names.size()],
                        states[static_cast<std::size_t>(i) % states.size()].c_str(), "\"who\"", cycle, cycle + 1);
    }
    CHECK_THROWS_AS(writer.interval(4, "busy", "", 0, 1), std::logic_error);
    writer.finish();
    CHECK_THROWS_AS(writer.finish(), std::logic_error);
    CHECK_THROWS_AS(writer.add_track("late"), std::logic_error);
    CHECK_THROWS_AS(writer.counter("late", "", 1, 1), std::logic_error);

    std::map<int, std::string> track_names;
    std::map<int, int> sort_index;
    for (const json& event : events_of(out.str(), "M")) {
        if (event.at("name") == "thread_name")
            track_names[event.at("tid")] = event.at("args").at("name");
        if (event.at("name") == "thread_sort_index")
            sort_index[event.at("tid")] = event.at("args").at("sort_index");
    }
    REQUIRE(track_names.size() == names.size());
    for (const auto& [id, name] : track_names)
        CHECK(name == names.at(static_cast<std::size_t>(sort_index.at(id))));

    const std::vector<json> intervals = events_of(out.str(), "X");
    REQUIRE(intervals.size() == 5000);
    std::map<std::string, std::set<std::string>> colours;
    for (std::size_t i = 0; i < intervals.size(); ++i) {
        const json& event = intervals[i];
        CHECK(track_names.at(event.at("tid")) == names[i % names.size()]);
        CHECK(event.at("name") == states[i % states.size()]);
        CHECK(event.at("args").at("detail") == "\"who\"");
        colours[event.at("name")].insert(event.at("cname").get<std::string>());
    }
    CHECK(colours["busy"] == std::set<std::string>{"good"});
    CHECK(colours["blocked"] == std::set<std::string>{"terrible"});
    CHECK(colours["waiting for memory"] == std::set<std::string>{"yellow"});
    CHECK(colours["starved"] == std::set<std::string>{"grey"});
    CHECK(colours["of my own"].size() == 1);
}

}  // namespace
}  // namespace tessera
