#include "testbench/commands/own_height_tests.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>

#include "modules/datapath/height_tests.h"
#include "modules/timing/timing.h"
#include "testbench/common/error.h"
#include "testbench/job/job_keys.h"

namespace tessera {

namespace {

constexpr int first_free_feature = 13, last_feature = 15;
constexpr const char* variable = "TESSERA_HEIGHT_TESTS";
/// Of other tests, and of what splits a triangle.
const std::set<std::string> taken_words{"base", "both", "generation", "highlight", "normal", "tex_coord", "view"};

/// What is wrong with a test's declarations; empty if nothing is.
std::string fault_of(const datapath::HeightTestFunctions& test, const HeightTestHost& host) {
    struct Number {
        const char* name;
        long long value, least, most;
    };
    const datapath::Formats formats;
    for (const Number& number : {Number{"latency", test.latency, 1, most_cycles},
                                 Number{"requests", test.requests, 0, datapath::Reads::most_requests},
                                 Number{"compared", test.compared, host.searched() == nullptr ? -1 : 0,
                                        static_cast<long long>(datapath::height_values) - 1},
                                 Number{"entry_bits()", test.entry_bits(formats), 1, 64}})
        if (number.value < number.least || number.value > number.most)
            return fmt::format("{} = {}, but the range is {} to {}", number.name, number.value, number.least,
                               number.most);
    if (test.feature >= 0 && (test.feature < first_free_feature || test.feature > last_feature))
        return fmt::format("feature = {}, but free are {} to {}", test.feature, first_free_feature, last_feature);
    for (const auto& threshold : test.thresholds(formats))
        if (const char* const name = threshold.name; name != nullptr) {
            const auto& keys = host.thresholds();
            if (std::none_of(keys.begin(), keys.end(), [&](const auto& key) { return key.name == std::string(name); }))
                return fmt::format("the register of {} has no key in the host's part", name);
        }
    return {};
}

void load(const std::string& file) {
    const auto refuse = [&](const std::string& why) {
        throw InputError(fmt::format("{}: {}: {}", variable, file, why));
    };
    // A name without a slash would be looked for in the system's folders.
    void* const library = dlopen((file.find('/') == std::string::npos ? "./" + file : file).c_str(), RTLD_NOW);
    if (library == nullptr)
        refuse(fmt::format("{}; set it to a library built as in testbench/examples/height_test/README.md", dlerror()));
    using Find = const OwnHeightTest* (*)();
    const auto find = reinterpret_cast<Find>(dlsym(library, "tessera_height_test"));
    if (find == nullptr)
        refuse("it has no tessera_height_test(): define it by the macro TESSERA_HEIGHT_TEST (own_height_tests.h)");
    const OwnHeightTest* const found = find();
    if (found == nullptr || found->version == nullptr)
        refuse("its tessera_height_test() gives no test");
    const OwnHeightTest& test = *found;
    if (test.version != std::string(version))
        refuse(fmt::format("it was built with tessera {}, this is {}: build it again", test.version, version));
    if (test.functions == nullptr || test.host == nullptr || test.check == nullptr || test.functions->name == nullptr)
        refuse("its tessera_height_test() gives no test");
    const std::string name = test.functions->name;
    if (!std::regex_match(name, std::regex("[a-z][a-z0-9_]*")) || taken_words.count(name) > 0)
        refuse(fmt::format(
            "its height test is called \"{}\": choose a name of lower-case letters, digits and _, other than {}", name,
            fmt::join(taken_words, ", ")));
    try {
        datapath::add_height_test(*test.functions);
        add_height_test_host(*test.host);
        add_height_test_check(*test.check);
    } catch (const std::invalid_argument& taken) {
        refuse(fmt::format("{}: rename the library's", taken.what()));
    }
    if (const std::string fault = fault_of(*test.functions, *test.host); !fault.empty())
        refuse(fmt::format("height test {}: {}", name, fault));
}

}  // namespace

void load_own_height_tests() {
    const char* const files = std::getenv(variable);
    std::istringstream list(files == nullptr ? "" : files);
    for (std::string file; std::getline(list, file, ':');)
        if (!file.empty())
            load(file);
    std::set<std::string> keys;
    for (const KeyTable& table : job_tables())
        for (const Key& key : table.keys)
            if (!keys.insert(key.name).second)
                throw InputError(
                    fmt::format("{}: {}: there is another key {}: rename the library's", variable, files, key.name));
}

}  // namespace tessera
