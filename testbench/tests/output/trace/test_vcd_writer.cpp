#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <iterator>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "testbench/output/trace/vcd_writer.h"

namespace tessera {
namespace {

struct Stamp {
    std::uint64_t time;
    bool has_all_values;
    std::map<std::string, std::uint64_t> values;

    bool operator==(const Stamp& other) const {
        return time == other.time && has_all_values == other.has_all_values && values == other.values;
    }
};

std::ostream& operator<<(std::ostream& out, const Stamp& stamp) {
    out << '#' << stamp.time << (stamp.has_all_values ? " all:" : ":");
    for (const auto& [name, value] : stamp.values)
        out << ' ' << name << '=' << value;
    return out;
}

/// A VCD file, read word by word; input that violates the format is refused.
struct VcdReading {
    explicit VcdReading(const std::string& text) {
        std::istringstream words(text);
        std::string word;
        std::vector<std::string> scope;
        std::map<std::string, std::string> names;  // by code
        while (words >> word && word != "$enddefinitions")
            read_declaration(words, word, scope, names);
        check(scope.empty(), "a scope is left open");
        words >> word;
        check(word == "$end", "$enddefinitions");

        bool in_all_values = false;
        while (words >> word) {
            if (word[0] == '#') {
                const std::uint64_t time = std::stoull(word.substr(1));
                check(!in_all_values && (stamps.empty() || time > stamps.back().time), word);
                stamps.push_back({time, false, {}});
            } else if (word == "$dumpvars") {
                check(stamps.size() == 1 && stamps[0].values.empty(), word);
                in_all_values = stamps[0].has_all_values = true;
            } else if (word == "$end") {
                check(in_all_values, word);
                in_all_values = false;
            } else {
                read_value(words, word, names);
            }
        }
        check(!in_all_values, "$dumpvars is left open");
    }

    std::string timescale;
    std::map<std::string, std::size_t> bits;
    std::vector<std::string> order;  // of scopes and variables, as declared
    std::vector<Stamp> stamps;

  private:
    static void check(bool good, const std::string& what) {
        if (!good)
            throw std::runtime_error("bad VCD: " + what);
    }

    void read_declaration(std::istream& words, const std::string& keyword, std::vector<std::string>& scope,
                          std::map<std::string, std::string>& names) {
        std::vector<std::string> parts;
        for (std::string word; words >> word && word != "$end";)
            parts.push_back(word);
        if (keyword == "$timescale") {
            timescale = parts.at(0);
        } else if (keyword == "$scope") {
            check(parts.size() == 2 && parts[0] == "module", "$scope");
            scope.push_back(parts[1]);
            order.push_back(join(scope));
            check(std::count(order.begin(), order.end(), order.back()) == 1, "a scope twice");
        } else if (keyword == "$upscope") {
            check(!scope.empty(), "$upscope");
            scope.pop_back();
        } else if (keyword == "$var") {
            check(parts.size() >= 4 && parts[0] == "wire", "$var");
            const std::size_t width = std::stoul(parts[1]);
            check(width == 1 ? parts.size() == 4
                             : parts.size() == 5 && parts[4] == "[" + std::to_string(width - 1) + ":0]",
                  "$var");
            order.push_back(join(scope) + "." + parts[3]);
            check(bits.emplace(order.back(), width).second, "a variable twice");
            check(names.emplace(parts[2], order.back()).second, "a code twice");
        } else {
            check(keyword == "$version", keyword);
        }
    }

    void read_value(std::istream& words, const std::string& word, const std::map<std::string, std::string>& names) {
        std::string digits = word.substr(0, 1), code = word.substr(1);
        if (word[0] == 'b') {
            digits = code;
            words >> code;
        }
        const auto name = names.find(code);
        check(!stamps.empty() && name != names.end(), word);
        const std::size_t width = bits.at(name->second);
        check((width == 1) == (word[0] != 'b') && !digits.empty() && digits.size() <= width &&
                  digits.find_first_not_of("01") == std::string::npos,
              word);
        check(stamps.back().values.emplace(name->second, std::stoull(digits, nullptr, 2)).second,
              "a value twice at one time: " + word);
    }

    static std::string join(const std::vector<std::string>& scope) {
        std::string path;
        for (const std::string& name : scope)
            path += (path.empty() ? "" : ".") + name;
        return path;
    }
};

struct Operation {
    std::size_t signal;
    bool is_pulse;
    std::uint64_t value;
};

/// The calls that a simulation makes to a writer.
struct Stimulus {
    struct Signal {
        std::string scope, name;
        unsigned bits;
    };
    std::vector<Signal> signals;
    std::vector<std::pair<std::uint64_t, std::vector<Operation>>> cycles;
    std::uint64_t finish = 0;
    TraceWindow window;
    std::uint64_t period = 1000;

    std::string write(std::uint64_t* changes = nullptr) const {
        std::ostringstream out;
        VcdWriter writer(out, period, window);
        std::vector<VcdWriter::Signal> handles;
        for (const Signal& signal : signals)
            handles.push_back(writer.add(signal.scope, signal.name, signal.bits));
        for (const auto& [cycle, operations] : cycles) {
            for (const Operation& operation : operations)
                if (operation.is_pulse)
                    writer.pulse(handles[operation.signal]);
                else
                    writer.set(handles[operation.signal], operation.value);
            writer.end_cycle(cycle);
        }
        writer.finish(finish);
        if (changes != nullptr)
            *changes = writer.changes();
        return out.str();
    }

    /// The expected changes, found by stepping through every cycle and comparing all values with the previous ones.
    std::vector<Stamp> expect(std::uint64_t units_per_cycle) const {
        const std::uint64_t end = cycles.empty() ? finish : std::max(finish, cycles.back().first + 1);
        std::vector<std::uint64_t> values(signals.size()), before;
        std::set<std::size_t> falling;
        std::vector<Stamp> stamps;
        std::size_t next = 0;
        for (std::uint64_t cycle = 0; cycle <= end; ++cycle) {
            before = values;
            for (const std::size_t signal : falling)
                values[signal] = 0;
            falling.clear();
            if (next < cycles.size() && cycles[next].first == cycle) {
                for (const Operation& operation : cycles[next].second) {
                    values[operation.signal] = operation.is_pulse ? 1 : masked(operation);
                    falling.erase(operation.signal);
                    if (operation.is_pulse)
                        falling.insert(operation.signal);
                }
                ++next;
            }
            const bool is_first = cycle == std::min(window.first, end);
            Stamp stamp{cycle * units_per_cycle, is_first, {}};
            for (std::size_t s = 0; s < signals.size(); ++s)
                if (is_first || values[s] != before[s])
                    stamp.values[signals[s].scope + "." + signals[s].name] = values[s];
            if (is_first || (cycle > window.first && cycle <= window.last && !stamp.values.empty()))
                stamps.push_back(stamp);
        }
        const std::uint64_t last = end <= window.last ? end : window.last + 1;
        if (last * units_per_cycle > stamps.back().time)
            stamps.push_back({last * units_per_cycle, false, {}});
        return stamps;
    }

  private:
    std::uint64_t masked(const Operation& operation) const {
        const unsigned bits = signals[operation.signal].bits;
        return bits == 64 ? operation.value : operation.value % (std::uint64_t{1} << bits);
    }
};

class StimulusMaker {
  public:
    explicit StimulusMaker(std::uint64_t seed) : random_(seed) {}

    Stimulus make(std::size_t cycles) {
        Stimulus stimulus;
        constexpr unsigned widths[] = {1, 1, 1, 2, 7, 8, 9, 16, 33, 63, 64};
        const std::size_t count = 1 + below(12);
        for (std::size_t s = 0; s < count; ++s)
            stimulus.signals.push_back(
                {below(2) != 0 ? "top.a" : "top.a.b", "s" + std::to_string(s), widths[below(std::size(widths))]});
        const std::uint64_t longest_gap = 1 + below(below(2) != 0 ? 2 : 8);
        std::uint64_t cycle = below(2) * below(10);
        for (std::size_t c = 0; c < cycles; ++c, cycle += 1 + below(longest_gap)) {
            std::vector<Operation> operations(below(2 * count));
            for (Operation& operation : operations)
                operation = {below(count), below(3) == 0, value()};
            stimulus.cycles.emplace_back(cycle, operations);
        }
        stimulus.finish = cycle - std::min(cycle, below(3)) + below(2) * below(10);
        switch (below(4)) {
            case 0: break;
            case 1: stimulus.window.first = below(cycle + 10); break;
            case 2: stimulus.window.last = below(cycle + 10); break;
            default: stimulus.window = {below(cycle + 10), below(cycle + 10)};
        }
        return stimulus;
    }

  private:
    std::uint64_t below(std::uint64_t limit) { return random_() % limit; }

    std::uint64_t value() {
        switch (below(4)) {
            case 0: return below(2);
            case 1: return 0 - below(5);
            case 2: return std::uint64_t{1} << below(64);
            default: return random_();
        }
    }

    std::mt19937_64 random_;
};

/// The file's content after its declarations; checks the number of changes.
std::vector<Stamp> stamps_of(const Stimulus& stimulus) {
    std::uint64_t changes = 0;
    const VcdReading reading(stimulus.write(&changes));
    std::uint64_t read = 0;
    for (const Stamp& stamp : reading.stamps)
        read += stamp.has_all_values ? 0 : stamp.values.size();
    CHECK(read == changes);
    return reading.stamps;
}

/// For values that are too long to print.
bool agrees(const Stimulus& stimulus) {
    return stamps_of(stimulus) == stimulus.expect(1);
}

TEST_CASE("VCD: random signals, pulses, gaps and windows agree with a walk through every cycle") {
    for (std::uint64_t seed = 0; seed < 3000; ++seed) {
        StimulusMaker maker(seed);
        const Stimulus stimulus = maker.make(seed % 40);
        CAPTURE(seed, stimulus.window.first, stimulus.window.last, stimulus.finish);
        REQUIRE(stamps_of(stimulus) == stimulus.expect(1));
    }
}

TEST_CASE("VCD: a file much longer than the writer's buffer is complete") {
    StimulusMaker maker(1);
    Stimulus stimulus = maker.make(30000);
    stimulus.window = {};
    REQUIRE(stimulus.write().size() > 1'000'000);
    REQUIRE(agrees(stimulus));
}

TEST_CASE("VCD: the same signals give the same bytes") {
    StimulusMaker first(7), second(7);
    REQUIRE(first.make(500).write() == second.make(500).write());
}

TEST_CASE("VCD: a small file is written exactly") {
    std::ostringstream out;
    VcdWriter writer(out, 5000);
    const auto address = writer.add("tessera.memory", "address", 12);
    const auto valid = writer.add("tessera.transform", "valid", 1);
    const auto ready = writer.add("tessera.memory", "ready", 1);
    const auto run = writer.add("tessera", "run", 1);
    writer.set(run, 1);
    writer.end_cycle(0);
    writer.pulse(valid);
    writer.set(address, 0x1005);
    writer.end_cycle(3);
    writer.set(address, 0);
    writer.set(ready, 1);
    writer.set(ready, 0);
    writer.end_cycle(9);
    writer.finish(12);
    REQUIRE(writer.changes() == 4);
    REQUIRE(out.str() ==
            "$version tessera $end\n"
            "$timescale 1ns $end\n"
            "$scope module tessera $end\n"
            "$var wire 1 $ run $end\n"
            "$scope module memory $end\n"
            "$var wire 12 ! address [11:0] $end\n"
            "$var wire 1 # ready $end\n"
            "$upscope $end\n"
            "$scope module transform $end\n"
            "$var wire 1 \" valid $end\n"
            "$upscope $end\n"
            "$upscope $end\n"
            "$enddefinitions $end\n"
            "#0\n$dumpvars\nb0 !\n0\"\n0#\n1$\n$end\n"
            "#15\n1\"\nb101 !\n"
            "#20\n0\"\n"
            "#45\nb0 !\n"
            "#60\n");
}

TEST_CASE("VCD: the timescale is the largest power of ten that divides the period") {
    const std::map<std::uint64_t, std::pair<std::string, std::uint64_t>> expected = {
        {1, {"1ps", 1}},         {7, {"1ps", 7}},         {2500, {"100ps", 25}},
        {1000, {"1ns", 1}},      {20000, {"10ns", 2}},    {1'000'000'000'000, {"1s", 1}},
        {100'000, {"100ns", 1}}, {3'000'000, {"1us", 3}}, {1'000'000'000'000'000, {"100s", 10}}};
    for (const auto& [period, timescale] : expected) {
        Stimulus stimulus;
        stimulus.signals = {{"top", "a", 4}};
        stimulus.cycles = {{0, {{0, false, 3}}}, {4, {{0, true, 0}}}};
        stimulus.finish = 10;
        stimulus.period = period;
        CHECK(VcdReading(stimulus.write()).timescale == timescale.first);
        CHECK(stamps_of(stimulus) == stimulus.expect(timescale.second));
    }
    std::ostringstream out;
    CHECK_THROWS_AS(VcdWriter(out, 0), std::logic_error);
}

TEST_CASE("VCD: windows at and beyond the ends of the run have the right values") {
    Stimulus stimulus;
    stimulus.signals = {{"top", "state", 64}, {"top", "valid", 1}};
    stimulus.cycles = {
        {2, {{0, false, UINT64_MAX}, {1, true, 0}}}, {3, {{1, true, 0}}}, {8, {{0, false, 5}, {1, true, 0}}}};
    stimulus.finish = 20;
    const auto with = [&](std::uint64_t first, std::uint64_t last) {
        stimulus.window = {first, last};
        const std::vector<Stamp> stamps = stamps_of(stimulus);
        CHECK(stamps == stimulus.expect(1));
        return stamps;
    };
    const auto all = [](std::uint64_t state, std::uint64_t valid) {
        return std::map<std::string, std::uint64_t>{{"top.state", state}, {"top.valid", valid}};
    };
    using Stamps = std::vector<Stamp>;
    const std::uint64_t ones = UINT64_MAX;
    // Nothing happens in the first cycle; a pulse ends there; one ends past the last.
    CHECK(with(6, 7) == Stamps{{6, true, all(ones, 0)}, {8, false, {}}});
    CHECK(with(4, 4) == Stamps{{4, true, all(ones, 0)}, {5, false, {}}});
    CHECK(with(3, 3) == Stamps{{3, true, all(ones, 1)}, {4, false, {}}});
    CHECK(with(7, 8) == Stamps{{7, true, all(ones, 0)}, {8, false, all(5, 1)}, {9, false, {}}});
    CHECK(with(9, ones) == Stamps{{9, true, all(5, 0)}, {20, false, {}}});
    // Windows that begin between the last activity and the end, at the end or after it, and empty ones.
    CHECK(with(15, 30) == Stamps{{15, true, all(5, 0)}, {20, false, {}}});
    CHECK(with(20, 30) == Stamps{{20, true, all(5, 0)}});
    CHECK(with(21, 30) == Stamps{{20, true, all(5, 0)}});
    CHECK(with(ones, ones) == Stamps{{20, true, all(5, 0)}});
    CHECK(with(0, 1) == Stamps{{0, true, all(0, 0)}, {2, false, {}}});
    CHECK(with(7, 3) == Stamps{{7, true, all(ones, 0)}});
    // The run's end is not before the last cycle's end.
    stimulus.finish = 0;
    CHECK(with(8, ones) == Stamps{{8, true, all(5, 1)}, {9, false, {{"top.valid", 0}}}});
    stimulus.cycles.clear();
    CHECK(with(0, ones) == Stamps{{0, true, all(0, 0)}});
    stimulus.signals.clear();
    CHECK(with(0, ones) == Stamps{{0, true, {}}});
}

TEST_CASE("VCD: a pulse lasts one cycle, also on a signal that is set directly") {
    Stimulus stimulus;
    stimulus.signals = {{"top", "valid", 1}};
    const Operation pulse{0, true, 0}, high{0, false, 1}, low{0, false, 0};
    const auto edges = [&](const std::vector<std::pair<std::uint64_t, std::vector<Operation>>>& cycles) {
        stimulus.cycles = cycles;
        stimulus.finish = 20;
        std::vector<std::uint64_t> times;
        for (const Stamp& stamp : stamps_of(stimulus))
            if (!stamp.has_all_values && !stamp.values.empty())
                times.push_back(stamp.time);
        return times;
    };
    using Times = std::vector<std::uint64_t>;
    CHECK(edges({{1, {pulse}}, {9, {}}}) == Times{1, 2});
    CHECK(edges({{1, {pulse}}, {2, {pulse}}, {3, {pulse}}, {5, {pulse}}}) == Times{1, 4, 5, 6});
    CHECK(edges({{1, {pulse, high}}, {9, {low}}}) == Times{1, 9});
    CHECK(edges({{1, {pulse, low}}}).empty());
    CHECK(edges({{1, {high, pulse, pulse}}}) == Times{1, 2});
    CHECK(edges({{1, {pulse}}, {2, {high}}, {9, {low}}}) == Times{1, 9});
    CHECK(edges({{1, {pulse}}, {2, {low}}}) == Times{1, 2});
    CHECK(edges({{1, {pulse}}, {4, {high}}}) == Times{1, 2, 4});
    CHECK(edges({{1, {high}}, {4, {pulse}}}) == Times{1, 5});
}

TEST_CASE("VCD: thousands of signals have a code each") {
    Stimulus stimulus;
    for (std::size_t s = 0; s < 10000; ++s) {
        stimulus.signals.push_back(
            {"top.u" + std::to_string(s % 100), std::to_string(s), static_cast<unsigned>(1 + s % 64)});
        stimulus.cycles.push_back({s, {{s, false, UINT64_MAX}}});
    }
    REQUIRE(agrees(stimulus));
    REQUIRE(VcdReading(stimulus.write()).bits.at("top.u99.9999") == 16);
}

TEST_CASE("VCD: misuse is refused") {
    std::ostringstream out;
    VcdWriter writer(out, 1000);
    writer.add("top.a", "x", 1);
    writer.add("top", "a", 1);  // a scope's name is free
    CHECK_THROWS_AS(writer.add("top.a", "x", 2), std::logic_error);
    CHECK_THROWS_AS(writer.add("top", "y", 0), std::logic_error);
    CHECK_THROWS_WITH(writer.add("top", "y", 65), Catch::Contains("top.y needs 1 to 64 bits and a name"));
    CHECK_NOTHROW(writer.add("top", "one_bit", 1));
    CHECK_NOTHROW(writer.add("top", "widest", 64));
    CHECK_THROWS_AS(writer.add("top", "", 1), std::logic_error);
    CHECK_THROWS_AS(writer.add("top", "y z", 1), std::logic_error);
    CHECK_THROWS_AS(writer.add("top", "y\x7f", 1), std::logic_error);
    CHECK_THROWS_AS(writer.add("", "y", 1), std::logic_error);
    CHECK_THROWS_AS(writer.add("top..b", "y", 1), std::logic_error);
    writer.end_cycle(5);
    CHECK_THROWS_AS(writer.add("top", "y", 1), std::logic_error);
    CHECK_THROWS_AS(writer.end_cycle(5), std::logic_error);
    CHECK_THROWS_AS(writer.end_cycle(4), std::logic_error);
    writer.finish(6);
    CHECK_THROWS_AS(writer.finish(6), std::logic_error);
    CHECK_THROWS_AS(writer.end_cycle(9), std::logic_error);
}

}  // namespace
}  // namespace tessera
