#include "testbench/setup/table_layout.h"

#include <fmt/core.h>

#include <algorithm>

#include "modules/datapath/reciprocal.h"
#include "modules/datapath/rectangle.h"
#include "modules/datapath/table_shapes.h"
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
            fmt::format("formats.summed_height_bits = {}: this mesh's largest rectangle sums up to {}, beyond "
                        "these bits: set formats.summed_height_bits = {}, or 0 to choose automatically",
                        bits, largest_sum, 64 - datapath::leading_zeros(largest_sum)));
    return bits;
}

void lay_out_tables(datapath::Registers& registers) {
    constexpr std::uint64_t page = 4096;
    datapath::shape_tables(registers);
    std::uint64_t next = page;
    for (datapath::TableLayout* table : {&registers.displacement_map, &registers.normal_map, &registers.height_table}) {
        table->base = next;
        next = (next + table->bytes() + page - 1) / page * page;
    }
}

}  // namespace tessera
