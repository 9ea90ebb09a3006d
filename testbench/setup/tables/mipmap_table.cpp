#include "testbench/setup/tables/mipmap_table.h"

#include <algorithm>

namespace tessera {

namespace {

/// Sum, number and maximum of a block's texels.
struct Block {
    std::uint64_t sum = 0, texels = 0;
    std::uint16_t maximum = 0;

    void add(const Block& part) {
        sum += part.sum;
        texels += part.texels;
        maximum = std::max(maximum, part.maximum);
    }
    std::uint16_t height(MipmapFilter filter) const {
        return filter == MipmapFilter::maximum ? maximum
                                               : static_cast<std::uint16_t>((2 * sum + texels) / (2 * texels));
    }
};

std::vector<Block> blocks_of(const QuantisedMap& map) {
    std::vector<Block> blocks;
    blocks.reserve(map.codes.size());
    for (const std::uint16_t code : map.codes)
        blocks.push_back({code, 1, code});
    return blocks;
}

/// Joins four blocks into one.
std::vector<Block> joined(const std::vector<Block>& from, const datapath::MipmapBlocks& of,
                          const datapath::MipmapBlocks& to) {
    std::vector<Block> blocks(std::size_t{to.columns} * to.rows);
    for (std::size_t k = 0; k < from.size(); ++k)
        blocks[k / of.columns / 2 * to.columns + k % of.columns / 2].add(from[k]);
    return blocks;
}

}  // namespace

MipmapTable make_mipmap_table(const QuantisedMap& map, MipmapFilter filter) {
    MipmapTable table{filter, {}};
    std::vector<Block> blocks = blocks_of(map);
    const int highest = datapath::highest_mipmap_level(map.geometry);
    for (int level = 0; level <= highest; ++level) {
        const datapath::MipmapBlocks size = datapath::mipmap_blocks(level, map.geometry);
        if (level > 0)
            blocks = joined(blocks, datapath::mipmap_blocks(level - 1, map.geometry), size);
        for (const Block& block : blocks)
            table.entries.push_back(block.height(filter));
    }
    return table;
}

}  // namespace tessera
