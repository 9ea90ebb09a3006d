"""Designs that omit tests which cannot change a decision: the same mesh in fewer cycles."""
from section import Chart, Claim, Experiment, Section, Table, MEASURED, FAILED
from .tests_units import QUIET
import charts

JOBS = ("half_donut", "crater_lake_24", "crater_lake_704", "head", "teapot")
BOTH = {"hardware.test_order": "cheap_first", "hardware.final_edges": True}
ONE_TEXEL = {**BOTH, "hardware.one_texel_from_map": True}
BANKS = {**ONE_TEXEL, "timing.summed_height_table_banks": 8, "timing.summed_height_table_interleave": "xor",
         "timing.summed_height_table_window": 12}
DESIGNS = {
    "the paper's": {},
    "final edges": {"hardware.final_edges": True},
    "cheap tests first": {"hardware.test_order": "cheap_first"},
    "both": BOTH,
    "one-texel sums from the map": ONE_TEXEL,
    "eight XOR banks": BANKS,
    "families": {**BANKS, "hardware.work": "family", "hardware.queue_order": "lifo", "hardware.queue_capacity": 256,
                 "timing.pass_or_tessellate_buffer": 32},
    "three lanes": {"hardware.design": "modern"},
    "two Normal Tests": {"hardware.design": "modern", "hardware.normal_tests": 2, "timing.normal_map_ports": 3},
    "four machines of two": {"hardware.design": "modern", "hardware.normal_tests": 2, "timing.normal_map_ports": 3,
                             "hardware.machines": 4},
    "eight machines": {"hardware.design": "modern", "hardware.machines": 8},
}
MODERN = "three lanes"


def cycles_chart(cycles):
    text = "Cycles per finished triangle"
    return Chart(charts.bars(list(cycles), list(cycles.values()), text.lower()), text)


def measure(study):
    section, rows, cycles, area, different = Section(), [], {}, {}, []
    runs = {(job, design): study.run(f"{job}_{number}", job, {**QUIET, **settings, "output.ply": True}, keep=False)
            for job in JOBS for number, (design, settings) in enumerate(DESIGNS.items())}
    yield
    for job in JOBS:
        meshes = set()
        for design in DESIGNS:
            figures = runs[job, design].figures
            meshes.add(figures["mesh.sha256"])
            triangles = figures["mesh.triangles"]
            cycles[job, design] = figures["timing.cycles_per_triangle"]
            bounded = figures["area.triangle_queue_memory_bits"]
            queue = bounded or 8 * figures["triangle_queue.high_water_bytes"]  # unbounded: what the run needed
            area[job, design] = figures["area.total_register_bits"] + queue
            rows.append([job, design, figures["timing.cycles"], cycles[job, design],
                         figures["useful_work.edge_tests"] / triangles, figures["useful_work.normal_tests"] / triangles,
                         figures["useful_work.summed_height_tests"] / triangles,
                         figures["summed_height_table.reads"] / triangles, figures["area.total_multipliers"],
                         figures["area.total_register_bits"], queue,
                         figures["area.total_memory_bits"] - bounded,
                         figures["area.total_ports"], figures["timing.bottleneck"]])
        if len(meshes) != 1:
            different.append(job)
    section.claims.append(Claim(
        "A decision depends on the edge alone.", "section 2",
        f"the mesh files of {', '.join(different)} differ between designs" if different else
        "so tests that cannot change it may be omitted: the mesh files of all designs are the same, byte for byte. Cycles per "
        "finished triangle, the paper's design and hardware.design = \"modern\": "
        + "; ".join(f"{job}: {cycles[job, next(iter(DESIGNS))]:.1f} and {cycles[job, MODERN]:.2f}" for job in JOBS),
        FAILED if different else MEASURED))
    section.charts.append(cycles_chart({f"{job}, {design}": value for (job, design), value in cycles.items()}))
    section.charts.append(Chart(
        charts.lines({job: ([area[job, design] for design in DESIGNS], [cycles[job, design] for design in DESIGNS])
                      for job in JOBS},
                     "bits of registers and of the Triangle Queue", "cycles per finished triangle", log_x=True, log_y=True),
        "Cycles against area, one mark per design, in the order of the table"))
    section.tables.append(Table(
        "ladder", "Per finished triangle; each design includes the changes of those above it (except final edges); the last two have several machines",
        [("job", ""), ("design", ""), ("cycles", ""), ("a triangle", "cycles"), ("edges tested", ""), ("Normal Tests", ""),
         ("Summed Height Tests", ""), ("table reads", ""), ("multipliers", ""), ("registers", "bits"), ("queue", "bits"), ("tables", "bits"), ("table ports", ""),
         ("bottleneck", "")], rows))
    return section


EXPERIMENT = Experiment("ladder", "Omitting repeated work", "Sections 2 and 3",
                        "Cycles of designs that evaluate only the tests a decision depends on, and test a triangle's children together.", measure)
