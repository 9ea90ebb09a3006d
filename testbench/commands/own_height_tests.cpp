#include "testbench/commands/own_height_tests.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>

#include "modules/datapath/height_tests.h"
#include "testbench/common/error.h"
#include "testbench/job/job_keys.h"

namespace tessera {

namespace {

constexpr const char* variable = "TESSERA_HEIGHT_TESTS";

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
    if (test.functions == nullptr || test.host == nullptr || test.check == nullptr)
        refuse("its tessera_height_test() gives no test");
    try {
        datapath::add_height_test(*test.functions);
        add_height_test_host(*test.host);
        add_height_test_check(*test.check);
    } catch (const std::invalid_argument& fault) {
        refuse(fault.what());
    }
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
                    fmt::format("{}: {}: there is another key {}: choose another name", variable, files, key.name));
}

}  // namespace tessera
