#include "testbench/machine/totals.h"

#include <algorithm>

namespace tessera {

Totals::Totals(const Simulation& simulation) {
    using C = DecidingUnit::Counts;
    using D = Decisions::Counts;
    using E = Decisions::Evaluated;
    base_triangles = simulation.setup.base_triangles.size();
    for (const auto& hosted : simulation.machines) {
        const Machine& p = hosted->machine;
        add_all_fields(counts, p.pass_or_tessellate.counts(), &C::passes, &C::normal_passes, &C::edges_tested,
                       &C::edges_split, &C::edges_uncut, &C::finished, &C::culled);
        add_all_fields(decided, hosted->decisions.counts(), &D::split_by_normal, &D::split_by_summed_height,
                       &D::split_by_both, &D::split_by_highlight, &D::split_in_highlight, &D::stopped_by_view,
                       &D::stopped_by_tex_coord, &D::stopped_by_generation, &D::stopped_by_view_alone,
                       &D::stopped_by_tex_coord_alone, &D::stopped_by_generation_alone, &D::stopped_by_several);
        add_all_fields(evaluated, hosted->decisions.evaluated(), &E::normal, &E::summed_height,
                       &E::summed_height_by_codes, &E::off_lattice);
        host_triangles += p.get_triangle.host_triangles();
        queue_triangles += p.get_triangle.queue_triangles();
        positions += p.transform.positions();
        normals += p.transform.normals();
        for (std::size_t k = 0; k < made_into.size(); ++k)
            made_into[k] += p.tessellation.made_into()[k];
        queued += p.triangle_queue.taken();
        spilled += p.triangle_queue.spilled();
        most_queued = std::max(most_queued, p.triangle_queue.high_water_mark());
        most_queued_on_chip = std::max(most_queued_on_chip, p.triangle_queue.on_chip_high_water_mark());
        lit += hosted->rasteriser.triangles();
        displacement_map_reads += p.displacement_map_reads();
        normal_map_reads += p.normal_map_reads();
        height_table_reads += p.height_table_reads();
        saturations += p.saturations();
    }
}

}  // namespace tessera
