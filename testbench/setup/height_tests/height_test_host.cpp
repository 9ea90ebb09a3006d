#include "testbench/setup/height_tests/height_test_host.h"

#include <array>
#include <cstddef>

namespace tessera {

const HeightTestHost& host_of(datapath::HeightTest test) {
    static const std::array<const HeightTestHost*, 4> all{&summed_height_host(), &rank_host(), &curvature_host(),
                                                          &mipmap_host()};
    return *all.at(static_cast<std::size_t>(test));
}

}  // namespace tessera
