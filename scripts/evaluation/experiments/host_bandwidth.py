"""Section 5: the host's traffic."""
from section import Chart, Claim, Experiment, Section, Table, reproduced_if
from .view_distances import SOURCE
import charts

JOBS = {
    "half donut on 18 triangles": None,
    "Utah teapot, half donut": "teapot",
    "Crater Lake on 704 triangles": "crater_lake_704",
    "head on 2,048 triangles": "head",
}


def measure(study):
    section, rows = Section(sources=[SOURCE]), []
    runs = {title: study.run(job or "half_donut", job, {"check.golden": False}, keep=False) for title, job in JOBS.items()}
    yield
    for title, run in runs.items():
        figures = run.figures
        rows.append([title, figures["host.mesh_bytes"], figures["host.table_bytes"], figures["run.triangles_finished"],
                     figures["host.tessellated_mesh_bytes"], figures["host.bandwidth_saving"],
                     figures["host.frames_to_pay_for_tables"]])
    savings = [row[5] for row in rows]
    section.claims.append(Claim(
        "Displacement mapping as a primitive can significantly reduce the bottleneck of sending triangle data.", "section 5",
        "; ".join(f"{row[0]}: {row[5]:,.0f} times fewer bytes per frame, "
                  + (f"tables paid for in {-(-row[6] // 1):,.0f} frame{'s' if row[6] > 1 else ''}" if row[6] > 0 else
                     "tables never paid for") for row in rows),
        reproduced_if(min(savings) > 2)))
    section.notes.append("These figures are for a constant displacement scale. If the scale changes in every frame, the normal map is "
                         "sent each time, and the host may send more than the tessellated meshes: see the displacement scale "
                         "between frames.")
    section.charts.append(Chart(charts.bars([row[0] for row in rows], savings,
                                            "bytes of the tessellated mesh / bytes of the base mesh"),
                                "Saving per frame, after the tables have been sent"))
    section.tables.append(Table(
        "host_bandwidth", "Bytes from the host",
        [("job", ""), ("base mesh, three vertices a triangle", "byte"), ("tables, once", "byte"), ("triangles", ""),
         ("the tessellated mesh instead, indexed", "byte"), ("saving a frame", "times"), ("tables paid after", "frames")],
        rows))
    return section


EXPERIMENT = Experiment("host_bandwidth", "Host bandwidth", "Section 5",
                        "The host sends the base mesh each frame and the tables once, instead of every triangle.", measure)
