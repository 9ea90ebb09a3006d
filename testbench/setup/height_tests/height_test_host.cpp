#include "testbench/setup/height_tests/height_test_host.h"

#include <cstddef>

namespace tessera {

const std::vector<const HeightTestHost*>& height_test_hosts() {
    static const std::vector<const HeightTestHost*> all{&summed_height_host(), &rank_host(), &curvature_host(),
                                                        &mipmap_host()};
    return all;
}

const HeightTestHost& host_of(datapath::HeightTest test) {
    return *height_test_hosts().at(static_cast<std::size_t>(test));
}

}  // namespace tessera
