#include "testbench/check/conformance/height_test_check.h"

#include <cstddef>
#include <vector>

namespace tessera {

namespace {

/// In the order of datapath::height_tests().
std::vector<const HeightTestCheck*>& list() {
    static std::vector<const HeightTestCheck*> all{&summed_height_check(), &rank_check(), &curvature_check(),
                                                   &mipmap_check()};
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
