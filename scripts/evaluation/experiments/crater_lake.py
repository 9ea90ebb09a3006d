"""Figure 11a: Crater Lake, and how good its meshes are."""
import csv

import numpy as np

from emitted_mesh import density_in
from section import Chart, Claim, Experiment, Picture, Section, Table, REPRODUCED, NOT_REPRODUCED, MEASURED, PARTLY, reproduced_if
import charts

MAP = "maps/crater_lake_west_336x459.pgm"
BUDGETS = (1316, 2000, 3047, 6336, 10000, 16009, 20000)
SKETCH = {1316: 14.7, 3047: 9.1, 6336: 6.9, 16009: 5.6}  # m RMS, a double-precision sketch of the algorithm
SHOWN = 6336
SHORE = 20  # texels


def elevations(path):
    words = path.read_bytes().split(b"\n", 1)[1]
    numbers = np.array([int(word) for line in words.splitlines() if not line.startswith(b"#") for word in line.split()])
    columns, rows = numbers[0], numbers[1]
    return numbers[3:].reshape(rows, columns)


def grown(mask, steps):
    for _ in range(steps):
        wider = mask.copy()
        wider[1:] |= mask[:-1]
        wider[:-1] |= mask[1:]
        wider[:, 1:] |= mask[:, :-1]
        wider[:, :-1] |= mask[:, 1:]
        mask = wider
    return mask


def regions_of(height):
    """The lake is the map's most frequent height; the island is land that only the lake surrounds."""
    level = np.bincount(height.ravel()).argmax()
    water = height == level
    outside = np.zeros_like(water)
    outside[:, 0] = ~water[:, 0]
    outside[0] |= ~water[0]
    outside[-1] |= ~water[-1]
    reached = -1
    while reached != outside.sum():
        reached = outside.sum()
        outside = grown(outside, 1) & ~water
    inside = ~water & ~outside
    # Specks of a few texels apart from the lake's level are no island.
    island = grown(inside & ~grown(~inside, 3), 4) & inside
    return {"island": island, "rim": grown(water, SHORE) & outside, "water": water,
            "land beyond the rim": outside & ~grown(water, SHORE)}


def reference_curves(path):
    curves = {}
    if path.is_file():
        for row in csv.DictReader(line for line in path.read_text().splitlines() if not line.startswith("#")):
            curves.setdefault(row["method"], []).append((int(row["triangles"]), float(row["rms"]), float(row["max"])))
    return curves


def measure(study):
    height = elevations(study.data_file(MAP))
    regions = regions_of(height)
    section, rows, runs = Section(), [], {}
    for budget in BUDGETS:
        run = runs[budget] = study.tune(f"budget_{budget}", "crater_lake_704", budget, "normal,summed_height",
                                        {"tests.view": False}, grid=True)
        rows.append([budget, run.triangles, run.figures["host.base_triangles"], run.error["height_field.rms_map"],
                     run.error["height_field.max_map"], run.settings["tests.normal_threshold"],
                     run.settings["tests.summed_height_threshold"]])
    references = reference_curves(study.data / "reference/crater_lake_curves.csv")
    for column, name in ((1, "RMS"), (2, "maximum")):
        series = {"tessera": ([row[1] for row in rows], [row[2 + column] for row in rows])}
        series.update({method: ([point[0] for point in points if 900 <= point[0] <= 40000],
                                [point[column] for point in points if 900 <= point[0] <= 40000])
                       for method, points in references.items()})
        section.charts.append(Chart(charts.lines(series, "triangles", f"{name} vertical error, m", True, True, ("tessera",)),
                                    f"{name} error at every grid point, against methods that choose vertices freely and by error"))
    shown = runs[SHOWN]
    density = {name: density_in(shown.mesh, mask) for name, mask in regions.items()}
    better = {budget: next(row[3] for row in rows if row[0] == budget) for budget in SKETCH}
    section.claims = [
        Claim("The island and the crater's edge are represented with a high level of detail.", "section 4, figure 11 (a)",
              f"triangles per area of the map at {shown.triangles:,} triangles, against the land beyond the rim: "
              f"island {density['island'] / density['land beyond the rim']:.1f}, rim {density['rim'] / density['land beyond the rim']:.1f}",
              reproduced_if(min(density["island"], density["rim"]) > 1.5 * density["land beyond the rim"])),
        Claim("The water is left at the resolution of the original mesh.", "section 4, figure 11 (a)",
              f"on the water {density['water'] / density['island']:.3f} of the island's density",
              REPRODUCED if density["water"] < 0.1 * density["island"] else
              PARTLY if density["water"] < 0.5 * density["island"] else NOT_REPRODUCED),
        Claim("The algorithm generates adaptive meshes with low triangle counts.", "section 5",
              "RMS vertical error: " + "; ".join(f"{row[3]:.2f} m at {row[1]:,} triangles" for row in rows)
              + ". A double-precision sketch had " + "; ".join(f"{value} m at {budget:,}" for budget, value in SKETCH.items())
              + f": {sum(better[b] < value for b, value in SKETCH.items())} of {len(SKETCH)} are better here.",
              MEASURED)]
    section.pictures = [
        Picture(shown.render("shaded"), f"Crater Lake, {shown.triangles:,} triangles"),
        Picture(shown.render("wireframe"), "Its triangles"),
        Picture(shown.render("error"), "Where the error is"),
        Picture(shown.render("stopped"), "Why edges were not split that a test would have split"),
    ]
    section.tables = [
        Table("crater_lake_curve", "Thresholds tuned for a budget of triangles",
              [("budget", "triangles"), ("triangles", ""), ("base triangles", ""), ("RMS error", "m"),
               ("maximum error", "m"), ("Normal Test threshold", ""), ("Summed Height Test threshold", "")], rows),
        Table("crater_lake_density", f"Triangles per area of the map (triangles / map), {shown.triangles:,} triangles",
              [("region", ""), ("share of the map", "%"), ("density", "triangles / map")],
              [[name, 100 * float(mask.mean()), density[name]] for name, mask in regions.items()])]
    return section


EXPERIMENT = Experiment("crater_lake", "Crater Lake", "Figure 11a",
                        "Real terrain: triangles gather at the island and the rim, and how far the mesh is from the ground.",
                        measure)
