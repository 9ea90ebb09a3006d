#pragma once
#include <cstdint>
#include <vector>

#include "testbench/common/random.h"
#include "testbench/prove/random_edges/datapath_edge.h"

namespace tessera::testing {

/// A unit vector pointing up, from three random numbers.
inline datapath::Direction random_normal(Random& random, const datapath::Formats& formats) {
    datapath::Saturations unused;
    const datapath::Direction any{random.integer32(-999, 999), random.integer32(-999, 999), random.integer32(1, 999)};
    return normalise(any, formats, unused);
}

/// The three tables of a map of the registers' size, with random heights and normals.
inline Tables random_tables(Random& random, datapath::Registers& registers) {
    std::vector<std::uint32_t> codes;
    std::vector<datapath::Direction> normals;
    const std::uint32_t texels = registers.map.width * registers.map.height;
    for (std::uint32_t k = 0; k < texels; ++k) {
        codes.push_back(random.natural(0, 65535));
        normals.push_back(random_normal(random, registers.formats));
    }
    return make_tables(registers, codes, normals);
}

}  // namespace tessera::testing
