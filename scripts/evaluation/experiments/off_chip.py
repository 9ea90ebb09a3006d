"""Tables that do not fit on chip: hardware.design = "modern" with caches in front of off-chip memory."""
from section import Claim, Experiment, Section, Table, MEASURED, FAILED
from .ladder import DESIGNS, JOBS, MODERN, cycles_chart
from .tests_units import QUIET

TABLES = {"displacement_map": 8, "normal_map": 8, "summed_height_table": 16}  # KiB
BANDWIDTHS = (16, 64)
MAPS = {job: {} for job in JOBS} | {"half_donut, a map of 4096 x 4096": {"map.width": 4096, "map.height": 4096}}


def caches(bandwidth):
    settings = {"timing.off_chip_latency": 100, "timing.off_chip_bandwidth": bandwidth,
                "timing.edges_in_sequence": 192, "timing.results_buffer": 32}
    for table, size in TABLES.items():
        settings[f"timing.{table}_cache_bytes"] = 1024 * size
        settings[f"timing.{table}_cache_fills"] = 96
    return settings


def measure(study):
    section, rows, cycles, wrong = Section(), [], {}, []
    runs = {}
    for name, map_settings in MAPS.items():
        job = name.split(",")[0]
        for bandwidth in (None, *BANDWIDTHS):
            settings = {**QUIET, **DESIGNS[MODERN], **map_settings, "output.ply": True,
                        **(caches(bandwidth) if bandwidth else {})}
            runs[name, bandwidth] = study.run(f"{job}_{len(map_settings)}_{bandwidth}", job, settings, keep=False)
    yield
    for name in MAPS:
        meshes = set()
        for bandwidth in (None, *BANDWIDTHS):
            figures = runs[name, bandwidth].figures
            meshes.add(figures["mesh.sha256"])
            triangles = figures["mesh.triangles"]
            where = f"{bandwidth} bytes per cycle" if bandwidth else "on chip"
            cycles[f"{name}, {where}"] = figures["timing.cycles_per_triangle"]
            hits = [figures[f"{table}.cache_hit_rate"] if bandwidth else "" for table in TABLES]
            fetched = sum(figures[f"{table}.bytes_fetched"] for table in TABLES) / triangles if bandwidth else 0
            rows.append([name, bandwidth or "on chip", figures["timing.cycles_per_triangle"], *hits, fetched,
                         figures["host.tessellated_mesh_bytes"] / triangles, figures["host.table_bytes"] / 1e6,
                         figures["timing.bottleneck"]])
        if len(meshes) != 1:
            wrong.append(name)
    section.claims.append(Claim(
        "The tables are read from off-chip memory.", "section 3",
        f"the mesh files of {', '.join(wrong)} differ" if wrong else
        "the mesh files are the same, byte for byte, with the tables on chip and behind caches of "
        + ", ".join(f"{size} KiB ({table.replace('_', ' ')})" for table, size in TABLES.items())
        + f". With 100 cycles of latency {min(row[6] for row in rows if row[6]):.0f} to {max(row[6] for row in rows):.0f} bytes "
        "of tables are fetched per finished triangle. Sending the finished mesh from the host instead would take "
        f"{max(row[7] for row in rows):.0f} bytes per triangle.",
        FAILED if wrong else MEASURED))
    section.charts.append(cycles_chart(cycles))
    section.tables.append(Table(
        "off_chip", "Per finished triangle, with 64 byte lines, 4 ways, up to 96 lines and 96 families under way",
        [("job", ""), ("off-chip memory", "bytes per cycle"), ("cycles", ""), ("displacement map hits", "%"),
         ("normal map hits", "%"), ("Summed Height Table hits", "%"), ("fetched", "bytes"), ("finished mesh", "bytes"),
         ("tables", "MB"), ("bottleneck", "")], rows))
    return section


EXPERIMENT = Experiment("off_chip", "Tables in off-chip memory", "Section 3",
                        "The cost of caches, latency and bandwidth in a design whose tables do not fit on chip.", measure)
