#pragma once
#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "modules/datapath/curvature.h"
#include "modules/datapath/mipmap.h"
#include "modules/datapath/rank_test.h"
#include "modules/datapath/summed_height.h"

namespace tessera::datapath {

template <class Test>
inline const Test the_test{};

/// For add_height_test().
inline std::vector<const HeightTestFunctions*>& list_of_height_tests() {
    static std::vector<const HeightTestFunctions*> all{&the_test<SummedHeightTest>, &the_test<RankTest>,
                                                       &the_test<CurvatureTest>, &the_test<MipmapTest>};
    return all;
}

/// One for each HeightTest, in its order.
inline const std::vector<const HeightTestFunctions*>& height_tests() {
    return list_of_height_tests();
}

/// Adds a test for the rest of the program, which must call it first. Throws std::invalid_argument if its name is taken.
inline HeightTest add_height_test(const HeightTestFunctions& test) {
    for (const HeightTestFunctions* const other : height_tests())
        if (std::string_view(other->name) == test.name)
            throw std::invalid_argument("there is another height test " + std::string(test.name));
    list_of_height_tests().push_back(&test);
    return static_cast<HeightTest>(height_tests().size() - 1);
}

/// Of a test of this folder.
template <class Test>
HeightTest number_of() {
    const auto found = std::find(height_tests().begin(), height_tests().end(), &the_test<Test>);
    return static_cast<HeightTest>(found - height_tests().begin());
}

inline const HeightTestFunctions& functions_of(HeightTest test) {
    return *height_tests()[static_cast<std::size_t>(test)];
}

/// Bits of an entry of the height test's table.
inline int height_entry_bits(const Formats& formats) {
    return functions_of(formats.height_test).entry_bits(formats);
}

}  // namespace tessera::datapath
