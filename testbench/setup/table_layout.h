#pragma once
#include <cstdint>
#include <vector>

#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"

namespace tessera {

/// The largest possible sum over any edge's rectangle, in codes; highest_code: of the map. An inserted vertex's texture
/// coordinate lies between those of its edge's ends, so |du| and |dv| of a child's edges do not exceed the largest of
/// the parent's three, and the base triangles bound all their descendants.
std::uint64_t bound_rectangle_sum(const std::vector<datapath::Triangle>& base_triangles,
                                  const datapath::MapGeometry& map, const datapath::Formats& formats,
                                  std::uint32_t highest_code);

/// Bits of an entry of the Summed Height Table: `wanted` or, if that is 0, the least of 32, 40 and 48 that holds the
/// largest sum. Throws InputError if it does not fit.
int summed_height_bits(std::int64_t wanted, std::uint64_t largest_sum);

/// Sets the addresses of the three tables: consecutive from 4 KiB page 1 on, each at the beginning of a page. Input:
/// map, covered texels and formats of the registers.
void lay_out_tables(datapath::Registers& registers);

}  // namespace tessera
