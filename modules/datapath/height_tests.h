#pragma once
#include <cstddef>
#include <vector>

#include "modules/datapath/curvature.h"
#include "modules/datapath/mipmap.h"
#include "modules/datapath/rank_test.h"
#include "modules/datapath/summed_height.h"

namespace tessera::datapath {

template <class Test>
inline const Test the_test{};

/// One for each HeightTest, in its order.
inline const std::vector<const HeightTestFunctions*>& height_tests() {
    static const std::vector<const HeightTestFunctions*> all{&the_test<SummedHeightTest>, &the_test<RankTest>,
                                                             &the_test<CurvatureTest>, &the_test<MipmapTest>};
    return all;
}

inline const HeightTestFunctions& functions_of(HeightTest test) {
    return *height_tests()[static_cast<std::size_t>(test)];
}

/// Bits of an entry of the height test's table.
inline int height_entry_bits(const Formats& formats) {
    return functions_of(formats.height_test).entry_bits(formats);
}

}  // namespace tessera::datapath
