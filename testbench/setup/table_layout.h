#pragma once
#include <cstdint>
#include <vector>

#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"

namespace tessera {

/// The largest sum any edge's rectangle can have, in codes; highest_code: of the map. An inserted vertex's texture
/// coordinate lies between those of its edge's ends, so |du| and |dv| of no edge of a child exceed the largest of the
/// parent's three, and the base triangles bound all their descendants.
std::uint64_t bound_rectangle_sum(const std::vector<datapath::Triangle>& base_triangles,
                                  const datapath::MapGeometry& map, const datapath::Formats& formats,
                                  std::uint32_t highest_code);

/// The bits of an entry of the Summed Height Table: those wanted, or, of 32, 40 and 48, the least that hold the largest
/// sum if 0 are. Throws InputError if it does not fit.
int summed_height_bits(std::int64_t wanted, std::uint64_t largest_sum);

/// Sets where the three tables lie, one after another from page 1 of 4 KiB on, each at a page's beginning. In: map,
/// covered texels and formats of the registers.
void lay_out_tables(datapath::Registers& registers);

}  // namespace tessera
