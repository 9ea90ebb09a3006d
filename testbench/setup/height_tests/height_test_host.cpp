#include "testbench/setup/height_tests/height_test_host.h"

#include <fmt/format.h>

#include <cstddef>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

#include "modules/datapath/height_tests.h"
#include "testbench/common/error.h"

namespace tessera {

namespace {

std::vector<const HeightTestHost*>& list() {
#define TESSERA_ITS_PART(Test) &host_part<datapath::Test>(),
    static std::vector<const HeightTestHost*> all{TESSERA_FOR_EACH_HEIGHT_TEST(TESSERA_ITS_PART)};
#undef TESSERA_ITS_PART
    return all;
}

/// What the parts of a test do not agree on; empty if there is nothing.
std::string fault_of(const HeightTestHost& host, const datapath::HeightTestFunctions& test) {
    std::set<std::string> keys, registers;
    for (const HeightThresholdKey& key : host.thresholds())
        keys.insert(key.name);
    for (const auto& threshold : test.thresholds(datapath::Formats()))
        if (threshold.name != nullptr)
            registers.insert(threshold.name);
    for (const std::string& name : registers)
        if (keys.count(name) == 0)
            return fmt::format("the register of {} has no key in the host's part", name);
    for (const std::string& name : keys)
        if (registers.count(name) == 0)
            return fmt::format("the key {} of the host's part has no register: there are {}, at most two", name,
                               fmt::join(registers, ", "));
    if (const char* const searched = host.searched(); searched != nullptr) {
        if (keys.count(searched) == 0)
            return fmt::format("searched() is {}, but the host's keys are {}", searched, fmt::join(keys, ", "));
        if (test.compared < 0)
            return fmt::format("searched() is {}, but compared = {}: no value is compared with it", searched,
                               test.compared);
    }
    return {};
}

}  // namespace

const std::vector<const HeightTestHost*>& height_test_hosts() {
    return list();
}

void add_height_test_host(const HeightTestHost& host) {
    if (list().size() + 1 != datapath::height_tests().size())
        throw std::invalid_argument("the host's part belongs to the height test that was added last");
    if (const std::string fault = fault_of(host, *datapath::height_tests().back()); !fault.empty())
        throw std::invalid_argument(fmt::format("height test {}: {}", datapath::height_tests().back()->name, fault));
    list().push_back(&host);
}

std::string meaning_of_height_tests() {
    std::string text;
    for (std::size_t k = 0; k < list().size(); ++k)
        text += std::string(k == 0   ? ""
                            : k == 1 ? ". In its place: "
                                     : "; ") +
                datapath::height_tests()[k]->name + ": " + list()[k]->meaning();
    return text;
}

std::vector<std::string_view> searched_height_tests() {
    std::vector<std::string_view> names;
    for (std::size_t k = 0; k < list().size(); ++k)
        if (list()[k]->searched() != nullptr)
            names.emplace_back(datapath::height_tests()[k]->name);
    return names;
}

const HeightTestHost& host_of(datapath::HeightTest test) {
    return *height_test_hosts().at(static_cast<std::size_t>(test));
}

HeightTestHost::Range searched_range(datapath::HeightTest test, const PreparedScene& scene,
                                     datapath::SummedHeightUnit unit) {
    const HeightTestHost& host = host_of(test);
    const HeightTestHost::Range range = host.range(scene, unit);
    double most = 0;  // of the key
    for (const HeightThresholdKey& key : host.thresholds())
        if (key.name == std::string_view(host.searched()))
            most = key.range.high;
    if (!(range.finest > 0 && range.finest < range.coarsest && range.coarsest <= most))
        throw InputError(
            fmt::format("height test {}: range() is {:g} to {:g}, but 0 < finest < coarsest <= {:g} is needed",
                        functions_of(test).name, range.finest, range.coarsest, most));
    return range;
}

}  // namespace tessera
