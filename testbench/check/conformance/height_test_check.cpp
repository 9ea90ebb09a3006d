#include "testbench/check/conformance/height_test_check.h"

#include <cstddef>
#include <vector>

namespace tessera {

namespace {

/// In the order of datapath::height_tests().
std::vector<const HeightTestCheck*>& list() {
#define TESSERA_ITS_PART(Test) &check_part<datapath::Test>(),
    static std::vector<const HeightTestCheck*> all{TESSERA_FOR_EACH_HEIGHT_TEST(TESSERA_ITS_PART)};
#undef TESSERA_ITS_PART
    return all;
}

}  // namespace

void add_height_test_check(const HeightTestCheck& check) {
    list().push_back(&check);
}

const HeightTestCheck& check_of(datapath::HeightTest test) {
    return *list().at(static_cast<std::size_t>(test));
}

}  // namespace tessera
