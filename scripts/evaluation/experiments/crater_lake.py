"""Figure 11a: Crater Lake, and how good its meshes are."""
import csv

import numpy as np

from emitted_mesh import density_in, values_at
from section import Chart, Claim, Experiment, Picture, Section, Table, REPRODUCED, NOT_REPRODUCED, MEASURED, PARTLY, reproduced_if
import charts

MAP = "maps/crater_lake_west_336x459.pgm"
BUDGETS = (1316, 2000, 3047, 6336, 10000, 16009, 20000)
SKETCH = {1316: 14.7, 3047: 9.1, 6336: 6.9, 16009: 5.6}  # m RMS, a double-precision sketch of the algorithm
SHOWN = 6336
# Base meshes that `--grid auto` chose between 1,000 and 20,000 triangles; it tries more and takes longer.
GRIDS = "16x22,lattice8,lattice16,lattice32,lattice128"
SHORE = 20  # texels
UNEVEN = 5  # m
RMS, MAXIMUM = "vertical.rms_map", "vertical.max_map"
# Bits of a triangle's stopped_by: tests that kept an edge whole which the Normal or Summed Height Test would split.
WHY_WHOLE = {"Generation Test": 16, "Tex Coord Test": 8, "neither Normal nor Summed Height Test asked": 0}


def elevations(path):
    """An ASCII PGM's integers, row 0 on top."""
    words = b" ".join(line.split(b"#", 1)[0] for line in path.read_bytes().splitlines()).split()
    columns, rows = int(words[1]), int(words[2])
    return np.array(words[4:], dtype=int).reshape(rows, columns)


def grown(mask, steps):
    for _ in range(steps):
        wider = mask.copy()
        wider[1:] |= mask[:-1]
        wider[:-1] |= mask[1:]
        wider[:, 1:] |= mask[:, :-1]
        wider[:, :-1] |= mask[:, 1:]
        mask = wider
    return mask


def flooded(seeds, within):
    """What can be reached from the seeds without leaving `within`."""
    reached, count = seeds & within, -1
    while count != reached.sum():
        count = reached.sum()
        reached = grown(reached, 1) & within
    return reached


def largest_part(seeds, within):
    largest = np.zeros_like(seeds)
    while seeds.any():
        first = np.zeros_like(seeds)
        first[np.unravel_index(seeds.argmax(), seeds.shape)] = True
        part = flooded(first, within)
        seeds = seeds & ~part
        if part.sum() > largest.sum():
            largest = part
    return largest


def regions_of(height):
    """The lake lies at the map's most frequent height, give or take what the survey does; slopes that pass through that
    height are not flat. The island is the land that no way over land leads to the map's border."""
    level = np.bincount(height.ravel()).argmax()
    at_level = np.abs(height - level) <= UNEVEN
    water = largest_part(~grown(~at_level, 3), at_level)
    border = np.ones_like(water)
    border[1:-1, 1:-1] = False
    outside = flooded(border, ~water)
    rim = grown(water, SHORE) & outside
    return {"island": ~water & ~outside, "rim": rim, "water": water, "land beyond the rim": outside & ~rim}


def reference_curves(path):
    curves = {}
    if path.is_file():
        for row in csv.DictReader(line for line in path.read_text().splitlines() if not line.startswith("#")):
            curves.setdefault(row["method"], []).append((int(row["triangles"]), float(row["rms"]), float(row["max"])))
    return curves


def vertical_errors(mesh, height):
    """At every grid point (texel centre, row 0 on top): the mesh's height minus the map's, in m, and its triangle."""
    rows, columns = height.shape
    errors, owner = np.zeros(height.shape), np.full(height.shape, -1)
    x, y = mesh.texture[:, 0] * columns - 0.5, (1 - mesh.texture[:, 1]) * rows - 0.5
    z = mesh.positions[:, 2] * 1000
    for k, (a, b, c) in enumerate(mesh.triangles):
        double_area = (x[b] - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (y[b] - y[a])
        if double_area == 0:
            continue
        left, right = int(np.ceil(min(x[a], x[b], x[c]) - 1e-9)), int(np.floor(max(x[a], x[b], x[c]) + 1e-9))
        top, bottom = int(np.ceil(min(y[a], y[b], y[c]) - 1e-9)), int(np.floor(max(y[a], y[b], y[c]) + 1e-9))
        left, top, right, bottom = max(left, 0), max(top, 0), min(right, columns - 1), min(bottom, rows - 1)
        if left > right or top > bottom:
            continue
        u, v = np.meshgrid(np.arange(left, right + 1), np.arange(top, bottom + 1))
        weight_b = ((u - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (v - y[a])) / double_area
        weight_c = ((x[b] - x[a]) * (v - y[a]) - (u - x[a]) * (y[b] - y[a])) / double_area
        inside = (weight_b >= -1e-9) & (weight_c >= -1e-9) & (weight_b + weight_c <= 1 + 1e-9)
        value = z[a] + weight_b * (z[b] - z[a]) + weight_c * (z[c] - z[a])
        errors[v[inside], u[inside]] = value[inside] - height[v[inside], u[inside]]
        owner[v[inside], u[inside]] = k
    return errors, owner


def worst_spot(run):
    spot = np.array([run.error[f"worst_vertical.{axis}"] for axis in "xyz"])
    ground = run.mesh.positions[np.argmin(((run.mesh.positions - spot)[:, :2] ** 2).sum(axis=1))]
    picture = run.render("error", "worst_spot", eye=[float(x) for x in ground + (0.9, -1.3, 1.3)],
                         target=[float(x) for x in ground], field_of_view=38, whole_viewport=True)
    return Picture(picture, f"The worst spot, in the middle: {run.error[MAXIMUM]:.0f} m off; its triangle was kept whole by: "
                            f"{run.error['worst_vertical.why_whole']}")


def limits_of(run, height):
    """Which edges were not split, by the reason of the triangle that a grid point lies in, and what that costs."""
    errors, owner = vertical_errors(run.mesh, height)
    covered = owner >= 0
    rows, taken = [], np.zeros(len(run.mesh.triangles), bool)
    for reason, bit in WHY_WHOLE.items():
        of_triangle = ~taken & ((run.mesh.stopped_by & bit) != 0 if bit else True)
        taken |= of_triangle
        points = covered.copy()
        points[covered] = of_triangle[owner[covered]]
        square = float((errors[points] ** 2).sum())
        rows.append([reason, int(of_triangle.sum()), 100 * float(points.sum() / covered.sum()),
                     (square / max(int(points.sum()), 1)) ** 0.5, 100 * square / float((errors[covered] ** 2).sum())])
    return Table("crater_lake_limits", f"Why triangles were not split further, {run.triangles:,} triangles: the first reason that holds",
                 [("kept whole by", ""), ("triangles", ""), ("grid points in them", "%"), ("RMS error there", "m"),
                  ("share of the squared error", "%")], rows)


def measure(study):
    height = elevations(study.data_file(MAP))
    regions = regions_of(height)
    section, rows, runs = Section(), [], {}
    for budget in BUDGETS:
        run = runs[budget] = study.tune(f"budget_{budget}", budget, "crater_lake_704",
                                        settings={"tests.view": False}, grid=GRIDS)
        tests = run.tuned["tests"]
        rows.append([budget, run.triangles, run.tuned["base"]["name"], run.figures["host.base_triangles"],
                     run.error[RMS], run.error[MAXIMUM],
                     tests["normal_threshold"] if tests["normal"] else "off",
                     tests["summed_height_threshold"] if tests["summed_height"] else "off",
                     tests["summed_height_unit"], tests["generation_limit"]])
    references = reference_curves(study.data / "reference/crater_lake_curves.csv")
    for column, name in ((1, "RMS"), (2, "maximum")):
        series = {"tessera": ([row[1] for row in rows], [row[3 + column] for row in rows])}
        series.update({method: ([point[0] for point in points if 900 <= point[0] <= 40000],
                                [point[column] for point in points if 900 <= point[0] <= 40000])
                       for method, points in references.items()})
        section.charts.append(Chart(charts.lines(series, "triangles", f"{name} vertical error, m", True, True, ("tessera",)),
                                    f"{name} error at every grid point, against methods that choose vertices freely and by error"))
    shown = runs[SHOWN]
    density = {name: density_in(shown.mesh, mask) for name, mask in regions.items()}
    open_water = values_at(shown.mesh, ~grown(~regions["water"], SHORE))
    whole = float((shown.mesh.generation[open_water] == 0).mean())
    better = {budget: next(row[4] for row in rows if row[0] == budget) for budget in SKETCH}
    section.claims = [
        Claim("The island and the crater's edge are represented with a high level of detail.", "section 4, figure 11 (a)",
              f"triangles per area of the map at {shown.triangles:,} triangles, against the land beyond the rim: "
              f"island {density['island'] / density['land beyond the rim']:.1f}, rim {density['rim'] / density['land beyond the rim']:.1f}",
              reproduced_if(min(density["island"], density["rim"]) > 1.5 * density["land beyond the rim"])),
        Claim("The water is left at the resolution of the original mesh.", "section 4, figure 11 (a)",
              f"away from the shore {100 * whole:.0f} % of the triangles on the water are base triangles, never split",
              REPRODUCED if whole > 0.9 else PARTLY if whole > 0.5 else NOT_REPRODUCED),
        Claim("The algorithm generates adaptive meshes with low triangle counts.", "section 5",
              "RMS vertical error: " + "; ".join(f"{row[4]:.2f} m at {row[1]:,} triangles" for row in rows)
              + ". A double-precision sketch had " + "; ".join(f"{value} m at {budget:,}" for budget, value in SKETCH.items())
              + f": {sum(better[b] < value for b, value in SKETCH.items())} of {len(SKETCH)} are better here.",
              MEASURED)]
    section.pictures = [
        Picture(shown.render("shaded"), f"Crater Lake, {shown.triangles:,} triangles"),
        Picture(shown.render("wireframe"), "Its triangles"),
        Picture(shown.render("error"), "Where the error is"),
        Picture(shown.render("stopped"), "Why edges were not split that a test would have split"),
        worst_spot(shown),
    ]
    limits = limits_of(shown, height)
    section.notes.append(
        f"What limits it: {limits.rows[-1][4]:.0f} % of the squared error lies under triangles of which neither test asked to "
        "split an edge. Each test looks at an edge's two ends and its midpoint only; a crest that an edge crosses in between is "
        "missed. A vertex can only stand at a midpoint, and is as high as the texel it falls into: base vertices at texel "
        "centres (lattices) save half a texel of that. The other methods choose vertices anywhere, by the error itself.")
    section.tables = [
        Table("crater_lake_curve", "Thresholds tuned for a budget of triangles",
              [("budget", "triangles"), ("triangles", ""), ("base mesh", ""), ("base triangles", ""), ("RMS error", "m"),
               ("maximum error", "m"), ("Normal Test threshold", ""), ("Summed Height Test threshold", ""),
               ("its unit", ""), ("generation limit", "")], rows),
        limits,
        Table("crater_lake_density", f"Triangles per area of the map (triangles / map), {shown.triangles:,} triangles",
              [("region", ""), ("share of the map", "%"), ("density", "triangles / map")],
              [[name, 100 * float(mask.mean()), density[name]] for name, mask in regions.items()])]
    return section


EXPERIMENT = Experiment("crater_lake", "Crater Lake", "Figure 11a",
                        "Real terrain: triangles gather at the island and the rim, and how far the mesh is from the ground.",
                        measure)
