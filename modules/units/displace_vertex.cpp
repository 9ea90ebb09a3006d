#include "modules/units/displace_vertex.h"

#include "modules/datapath/bilinear.h"
#include "modules/datapath/bump.h"
#include "modules/datapath/displace.h"
#include "modules/datapath/normalise.h"
#include "modules/stage/stage_steps.h"

namespace tessera {

DisplaceVertex::DisplaceVertex(const sc_core::sc_module_name& name, const UnitContext& context)
    : Stage(name, context, context.timing().displace_vertex, 1, displace_vertex_latency(context.design)),
      displacement_map("displacement_map", context.registers.displacement_map.entry_bytes,
                       context.design.direct_memory),
      registers_(context.registers) {
    takes_from(context, from_calculate_new_p);
    delivers_to(context, to_transform);
    reads_through(displacement_map, 1);
    if (context.design.work == Work::family) {
        normal_map.emplace("normal_map", context.registers.normal_map.entry_bytes, context.design.direct_memory);
        reads_through(*normal_map, 1);
    }
    const datapath::Formats& f = registers_.formats;
    const datapath::Multiplications interpolates = interpolate_multiplications(f);
    const int entries = static_cast<int>(map_entry_count(f));
    const datapath::Multiplications for_direction =
        f.families ? bump_multiplications(f).add(interpolates, 3) : normalise_multiplications(f, f.normal.bits);
    multiplies(displace_multiplications(f).add(interpolates).add(for_direction));
    keeps(entries * (f.displacement.bits + (f.families ? 3 * f.normal.bits : 0)));
}

void DisplaceVertex::reads(const BasePoint& point, Reads& reads) const {
    const auto add_request = [&](const datapath::TableLayout& map) {
        reads.add_request();
        map_entries(point.t, map, registers_.map, registers_.formats,
                    [&](std::uint64_t address) { reads.add_entry(address); });
    };
    if (!point.tag.is_normal())
        add_request(registers_.displacement_map);
    if (normal_map && point.tag.is_vertex()) {
        reads.through(1);
        add_request(registers_.normal_map);
    }
}

DisplacedPoint DisplaceVertex::process(const BasePoint& point, const Entries& entries) {
    const datapath::Formats& formats = registers_.formats;
    DisplacedPoint displaced{point, {}, 0};
    if (point.tag.is_normal())
        return displaced;
    const bool unit_length = !point.tag.is_edge() || formats.families;
    const datapath::Direction normal = unit_length ? point.n : normalise(point.n, formats, saturations_);
    displaced.displaced = displace(point.p, normal, map_code(point.t, entries.data(), formats), registers_.displacement,
                                   formats, saturations_);
    displaced.code = formats.codes ? nearest_code(point.t, entries.data(), formats) : std::uint16_t{0};
    if (normal_map && point.tag.is_vertex()) {
        const std::uint64_t* const normals = entries.data() + map_entry_count(formats);
        displaced.displaced_n = bump(point.n, point.displaced_n, point.handedness,
                                     map_normal(point.t, normals, formats), formats, saturations_);
    }
    return displaced;
}

}  // namespace tessera
