#include "testbench/tests/output/trace/vcd_file.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

namespace tessera {

std::uint64_t VcdFile::Signal::at(std::uint64_t time) const {
    const auto after = std::upper_bound(changes.begin(), changes.end(), std::pair{time, UINT64_MAX});
    return after == changes.begin() ? initial : std::prev(after)->second;
}

std::uint64_t VcdFile::Signal::high_cycles(std::uint64_t period, std::uint64_t end_time) const {
    std::uint64_t cycles = 0, since = 0, value = initial;
    for (const auto& [time, next] : changes) {
        cycles += value * (time - since) / period;
        since = time;
        value = next;
    }
    return cycles + value * (end_time - since) / period;
}

VcdFile::VcdFile(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    INFO(file);
    REQUIRE(in);
    std::map<std::string, std::string> names;  // by code
    std::vector<std::string> scopes;
    bool header = true, dumping = false, timed = false;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string first, word, code, name;
        words >> first;
        if (header) {
            unsigned bits = 0;
            if (first == "$scope" && words >> word >> name)
                scopes.push_back(name);
            else if (first == "$upscope")
                scopes.pop_back();
            else if (first == "$var" && words >> word >> bits >> code >> name) {
                std::string path;
                for (const std::string& scope : scopes)
                    path += scope + ".";
                REQUIRE(names.emplace(code, path + name).second);
                signals[path + name].bits = bits;
            } else if (first == "$enddefinitions")
                header = false;
            continue;
        }
        if (first[0] == '#') {
            const std::uint64_t time = std::stoull(first.substr(1));
            if (timed && time <= end)
                FAIL("time stamps that do not increase: " << line);
            begin = timed ? begin : time;
            end = time;
            timed = true;
        } else if (first[0] == '$') {
            dumping = first == "$dumpvars";
        } else {
            const bool vector = first[0] == 'b';
            if (vector)
                words >> code;
            else
                code = first.substr(1);
            if (names.count(code) == 0)
                FAIL("a value of no signal: " << line);
            const std::uint64_t value = std::stoull(vector ? first.substr(1) : first.substr(0, 1), nullptr, 2);
            Signal& signal = signals[names[code]];
            if (dumping)
                signal.initial = value;
            else
                signal.changes.emplace_back(end, value);
        }
    }
    REQUIRE(timed);
}

const VcdFile::Signal& VcdFile::operator[](const std::string& name) const {
    const auto found = signals.find(name);
    INFO(name);
    REQUIRE(found != signals.end());
    return found->second;
}

}  // namespace tessera
