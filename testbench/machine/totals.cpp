#include "testbench/machine/totals.h"

#include <algorithm>

namespace tessera {

Totals::Totals(const Simulation& simulation) {
    base_triangles = simulation.setup.base_triangles.size();
    for (const auto& hosted : simulation.machines) {
        const Machine& p = hosted->machine;
        add_counts(counts, p.pass_or_tessellate.counts());
        add_counts(decided, hosted->decisions.counts());
        add_counts(evaluated, hosted->decisions.evaluated());
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
