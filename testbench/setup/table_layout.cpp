#include "testbench/setup/table_layout.h"

#include <fmt/core.h>

#include <algorithm>

#include "modules/datapath/map_entry.h"
#include "modules/datapath/reciprocal.h"
#include "modules/datapath/rectangle.h"
#include "testbench/common/error.h"

namespace tessera {

std::uint64_t bound_rectangle_sum(const std::vector<datapath::Triangle>& base_triangles,
                                  const datapath::MapGeometry& map, const datapath::Formats& formats,
                                  std::uint32_t highest_code) {
    std::uint64_t largest = 0;
    for (const datapath::Triangle& triangle : base_triangles) {
        std::uint64_t width = 1, height = 1;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto size = datapath::rectangle_size(triangle.vertices[k].texture,
                                                       triangle.vertices[(k + 1) % 3].texture, map, formats);
            width = std::max<std::uint64_t>(width, size.width);
            height = std::max<std::uint64_t>(height, size.height);
        }
        largest = std::max(largest, width * height);
    }
    return largest * highest_code;
}

int summed_height_bits(std::int64_t wanted, std::uint64_t largest_sum) {
    const auto holds = [&](int bits) { return largest_sum >> bits == 0; };
    int bits = static_cast<int>(wanted);
    if (bits == 0)
        bits = holds(32) ? 32 : (holds(40) ? 40 : 48);
    if (!holds(bits))
        throw InputError(
            fmt::format("formats.summed_height_bits = {}: this mesh's largest rectangle sums up to {}, which needs {} "
                        "bits; use that, or 0 to choose automatically",
                        bits, largest_sum, 64 - datapath::leading_zeros(largest_sum)));
    return bits;
}

void lay_out_tables(datapath::Registers& registers, const RankTables& rank_tables) {
    constexpr std::uint64_t page = 4096;
    const auto entry = [](int bits) { return datapath::entry_bytes(bits); };
    const auto after = [](const datapath::TableLayout& table) {
        return (table.base + table.bytes() + page - 1) / page * page;
    };
    registers.displacement_map = {page, registers.map.width, registers.map.height,
                                  entry(registers.formats.displacement.bits)};
    registers.normal_map = {after(registers.displacement_map), registers.map.width, registers.map.height,
                            entry(3 * registers.formats.normal.bits)};
    const bool ranks = registers.formats.height_test == datapath::HeightTest::rank;
    registers.height_table = {after(registers.normal_map), ranks ? rank_tables.columns : registers.map.width + 1,
                              ranks ? rank_tables.rows : registers.map.height + 1,
                              entry(datapath::height_entry_bits(registers.formats))};
}

}  // namespace tessera
