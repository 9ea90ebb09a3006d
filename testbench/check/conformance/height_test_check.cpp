#include "testbench/check/conformance/height_test_check.h"

#include <cstddef>

namespace tessera {

const std::array<const HeightTestCheck*, 4>& height_test_checks() {
    static const std::array<const HeightTestCheck*, 4> all{&summed_height_check(), &rank_check(), &curvature_check(),
                                                           &mipmap_check()};
    return all;
}

const HeightTestCheck& check_of(datapath::HeightTest test) {
    return *height_test_checks().at(static_cast<std::size_t>(test));
}

}  // namespace tessera
