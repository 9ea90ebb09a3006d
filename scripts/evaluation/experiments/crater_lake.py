"""Figure 11a: Crater Lake, and the quality of its meshes."""
import csv
from pathlib import Path

import matplotlib.image
import numpy as np

from emitted_mesh import density_in, values_at
from section import Chart, Claim, Experiment, Picture, Section, Table, REPRODUCED, NOT_REPRODUCED, PARTLY, reproduced_if
from sweep_file import JOBS
import charts

MAP = JOBS / "crater_lake_west.png"
OTHER_METHODS = Path(__file__).with_name("crater_lake_curves.csv")
BUDGETS = (1316, 2000, 3047, 6336, 10000, 16009, 20000)
LIMITS_AT = (1316, 6336, 20000)
SHOWN = 6336
# `--grid auto` tries more base meshes and takes longer, but finds none better between 1,000 and 20,000 triangles.
GRIDS = "16x22,lattice8,lattice16,lattice32,lattice128"
SHORE = 20  # texels
UNEVEN = 5  # m
RMS, MAXIMUM = "vertical.rms_map", "vertical.max_map"
# A triangle's stopped_by: the tests that prevented splits requested by the Normal or Summed Height Test.
WHY_WHOLE = {"no split requested by Normal or Summed Height Test": 0, "Tex Coord Test": 8, "Generation Test": 16,
             "Tex Coord Test and Generation Test": 24}


def elevations(path):
    """A 16-bit PNG's samples, row 0 on top."""
    return np.rint(65535.0 * matplotlib.image.imread(path)).astype(int)


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
    """The region connected to the seeds inside `within`."""
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
    """The lake has the map's most frequent height, within the survey's error; slopes at that height are excluded, since
    they are not flat. The island is the land that is not connected over land to the map's border."""
    level = np.bincount(height.ravel()).argmax()
    at_level = np.abs(height - level) <= UNEVEN
    water = largest_part(~grown(~at_level, 3), at_level)
    border = np.ones_like(water)
    border[1:-1, 1:-1] = False
    outside = flooded(border, ~water)
    rim = grown(water, SHORE) & outside
    return {"island": ~water & ~outside, "rim": rim, "water": water, "land beyond the rim": outside & ~rim}


def reference_curves(path, surface=None):
    curves = {}
    for row in csv.DictReader(line for line in path.read_text().splitlines() if not line.startswith("#")):
        if row.get("map") == surface:
            curves.setdefault(row["method"], []).append((int(row["triangles"]), float(row["rms"]), float(row["max"])))
    return curves


def vertical_errors(mesh, height, scale=1000):
    """At every grid point (texel centre, row 0 on top): the mesh's height minus the map's, in m, and the triangle there, or
    -1. scale: metres per model unit."""
    rows, columns = height.shape
    errors, owner = np.zeros(height.shape), np.full(height.shape, -1)
    x, y, z = (values[mesh.triangles].T for values in (mesh.texture[:, 0] * columns - 0.5, (1 - mesh.texture[:, 1]) * rows - 0.5,
                                                       mesh.positions[:, 2] * scale))
    double_area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])
    left, top = (np.maximum(np.ceil(values.min(axis=0) - 1e-9), 0).astype(int) for values in (x, y))
    right, bottom = (np.minimum(np.floor(values.max(axis=0) + 1e-9), most - 1).astype(int) for values, most in ((x, columns), (y, rows)))
    width = np.maximum(right - left + 1, 0)
    points = np.where(double_area != 0, width * np.maximum(bottom - top + 1, 0), 0)
    # Every point of a triangle's box.
    k = np.repeat(np.arange(len(points)), points)
    place = np.arange(len(k)) - np.repeat(np.cumsum(points) - points, points)
    u, v = left[k] + place % width[k], top[k] + place // width[k]
    x, y, z = x[:, k], y[:, k], z[:, k]
    weight_b = ((u - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (v - y[0])) / double_area[k]
    weight_c = ((x[1] - x[0]) * (v - y[0]) - (u - x[0]) * (y[1] - y[0])) / double_area[k]
    inside = (weight_b >= -1e-9) & (weight_c >= -1e-9) & (weight_b + weight_c <= 1 + 1e-9)
    value = z[0] + weight_b * (z[1] - z[0]) + weight_c * (z[2] - z[0])
    u, v = u[inside], v[inside]
    errors[v, u] = value[inside] - height[v, u]
    owner[v, u] = k[inside]
    return errors, owner


def rms_and_largest(mesh, height, scale=1000):
    errors, owner = vertical_errors(mesh, height, scale)
    return float(np.sqrt((errors[owner >= 0] ** 2).mean())), float(np.abs(errors).max())


def worst_spot(run, finest):
    """The mesh at its largest vertical error, and the finest mesh there for comparison."""
    spot = np.array([run.error[f"worst_vertical.{axis}"] for axis in "xyz"])
    ground = run.mesh.positions[np.argmin(((run.mesh.positions - spot)[:, :2] ** 2).sum(axis=1))]
    camera = {"eye": [float(x) for x in ground + (0.9, -1.3, 1.3)], "target": [float(x) for x in ground], "field_of_view": 38,
              "whole_viewport": True}
    return [Picture(run.render("error", "worst_spot", **camera),
                    f"The worst spot, in the middle: {run.error[MAXIMUM]:.0f} m vertical error (colours: distance to the surface); "
                    f"its triangle was not split because of: {run.error['worst_vertical.why_whole']}"),
            Picture(finest.render("wireframe", "worst_spot_of_the_other", **camera),
                    f"The same place with {finest.triangles:,} triangles")]


def squares_by(run, height, regions):
    """Shares of a mesh's squared vertical error: by the reason why a triangle was not split, by region, by
    generation, and of the worst 1 % of the grid points. Also triangles and RMS error by reason."""
    errors, owner = vertical_errors(run.mesh, height)
    covered = owner >= 0
    square = np.where(covered, errors, 0) ** 2
    total = square.sum()
    reason = np.where(covered, run.mesh.stopped_by[owner], -1)
    generation = np.where(covered, run.mesh.generation[owner], -1)
    reasons = {}
    for name, mask in WHY_WHOLE.items():
        points = reason == mask
        reasons[name] = [int((run.mesh.stopped_by == mask).sum()), 100 * float(points.sum() / covered.sum()),
                         float((square[points].sum() / max(points.sum(), 1)) ** 0.5), 100 * float(square[points].sum() / total)]
    return {"reasons": reasons,
            "regions": {name: 100 * float(square[mask].sum() / total) for name, mask in regions.items()},
            "generations": {int(g): 100 * float(square[generation == g].sum() / total)
                            for g in range(run.mesh.generation.max() + 1)},
            "worst": 100 * float(np.sort(square.ravel())[-square.size // 100:].sum() / total)}


def at_equal_triangles(points, triangles, column=1):
    """A reference curve's RMS (2: largest) error at a number of triangles, interpolated by a power law; None outside its points."""
    count, error = np.log([point[0] for point in points]), np.log([point[column] for point in points])
    if not count[0] <= np.log(triangles) <= count[-1]:
        return None
    return float(np.exp(np.interp(np.log(triangles), count, error)))


def low_counts(rows, references):
    """The claim of low triangle counts, compared with the other midpoint method and with the best of the other methods."""
    found, ratios = [], {}
    for method in ("rtin", "terra"):
        pairs = [(row, at_equal_triangles(references[method], row[1])) for row in rows]
        ratios[method] = [row[4] / other for row, other in pairs if other]
        found.append(f"against {method} at equal triangles {min(ratios[method]):.2f} to {max(ratios[method]):.2f} times its RMS")
    measured = "RMS vertical error " + "; ".join(f"{row[4]:.2f} m at {row[1]:,} triangles" for row in rows)
    verdict = REPRODUCED if max(ratios["terra"]) < 1.1 else PARTLY if max(ratios["rtin"]) < 1 else NOT_REPRODUCED
    return Claim("The algorithm is capable of generating low triangle count meshes.", "section 5",
                 "; ".join([measured, *found]), verdict)


def measure(study):
    height = elevations(MAP)
    regions = regions_of(height)
    section, rows = Section(), []
    runs = {budget: study.tune(f"budget_{budget}", budget, "crater_lake_704", settings={"tests.view": False}, grid=GRIDS)
            for budget in BUDGETS}
    yield
    for budget, run in runs.items():
        tests = run.tuned["tests"]
        rows.append([budget, run.triangles, run.tuned["base"]["name"], run.figures["host.base_triangles"],
                     run.error[RMS], run.error[MAXIMUM],
                     tests["normal_threshold"] if tests["normal"] else "off",
                     tests["summed_height_threshold"] if tests["summed_height"] else "off",
                     tests["summed_height_unit"], tests["generation_limit"]])
    references = reference_curves(OTHER_METHODS)
    against = ("; others: greedy insertion (terra, hmm), quadric simplification (meshoptimizer), edges split at midpoints according to the "
               "true error (rtin)")
    for column, name in ((1, "RMS"), (2, "maximum")):
        series = {"tessera": ([row[1] for row in rows], [row[3 + column] for row in rows])}
        series.update({method: ([point[0] for point in points if 900 <= point[0] <= 40000],
                                [point[column] for point in points if 900 <= point[0] <= 40000])
                       for method, points in references.items()})
        section.charts.append(Chart(charts.lines(series, "triangles", f"{name} vertical error, m", True, True, ("tessera",)),
                                    f"{name} vertical error at every grid point{against}"))
    shown = runs[SHOWN]
    density = {name: density_in(shown.mesh, mask) for name, mask in regions.items()}
    land = density["land beyond the rim"]
    generation_on = {"all": shown.mesh.generation[values_at(shown.mesh, regions["water"])],
                     "open": shown.mesh.generation[values_at(shown.mesh, ~grown(~regions["water"], SHORE))]}
    whole = {where: float((generation == 0).mean()) for where, generation in generation_on.items()}
    section.claims = [
        Claim("The island and the crater's edge are represented with a high level of detail.", "section 4, figure 11 (a)",
              f"triangles per area of the map at {shown.triangles:,} triangles: island relative to water "
              f"{density['island'] / density['water']:.1f}, rim relative to water {density['rim'] / density['water']:.1f}; relative to the "
              f"land beyond the rim {density['island'] / land:.1f} and {density['rim'] / land:.1f}",
              reproduced_if(min(density["island"], density["rim"]) > 1.5 * max(density["water"], land))),
        Claim("The water is left at the resolution of the original mesh.", "section 4, figure 11 (a)",
              f"more than {SHORE} texels from the shore {100 * whole['open']:.0f} % of {len(generation_on['open'])} triangles are "
              f"base triangles, never split (a base of {shown.figures['host.base_triangles']:,}); of all {len(generation_on['all'])} "
              f"on the water, shore included, {100 * whole['all']:.0f} %",
              REPRODUCED if whole["open"] > 0.9 else PARTLY if whole["open"] > 0.5 else NOT_REPRODUCED),
        low_counts(rows, references)]
    section.pictures = [
        Picture(shown.render("shaded"), f"Crater Lake, {shown.triangles:,} triangles"),
        Picture(shown.render("wireframe"), "Its triangles"),
        Picture(shown.render("error"), "Its error (distance to the surface)"),
        Picture(shown.render("stopped"), "Tests that prevented splits requested by another test"),
        *worst_spot(shown, runs[BUDGETS[-1]])]
    squares = {budget: squares_by(runs[budget], height, regions) for budget in LIMITS_AT}
    of_shown = squares[SHOWN]
    asked = {budget: 100 - of["reasons"]["no split requested by Normal or Summed Height Test"][3] for budget, of in squares.items()}
    section.notes.append(
        f"Causes of the error: at {SHOWN:,} triangles {100 - asked[SHOWN]:.0f} % of the squared error is in triangles for which neither "
        "test requested a split at the thresholds that the budget allows. "
        + " ".join(f"At {budget:,}, triangles for which one test requested a split and another stopped it have {share:.0f} % of it."
                   for budget, share in asked.items())
        + " By region: " + ", ".join(f"{name} {share:.0f} %" for name, share in of_shown["regions"].items())
        + "; by generation: " + ", ".join(f"{g}: {share:.0f} %" for g, share in of_shown["generations"].items())
        + f". The worst hundredth of the grid points has {of_shown['worst']:.0f} %. The triangle at the worst spot was not split because of: "
        f"{shown.error['worst_vertical.why_whole']}.")
    section.tables = [
        Table("crater_lake_curve", "Thresholds tuned for a budget of triangles",
              [("budget", "triangles"), ("triangles", ""), ("base mesh", ""), ("base triangles", ""), ("RMS error", "m"),
               ("maximum error", "m"), ("Normal Test threshold", ""), ("Summed Height Test threshold", ""),
               ("its unit", ""), ("generation limit", "")], rows),
        Table("crater_lake_limits", "Triangles by the reason why they were not split, and the vertical error in them",
              [("budget", "triangles"), ("kept whole by", ""), ("triangles", ""), ("grid points in them", "%"),
               ("RMS error there", "m"), ("share of the squared error", "%")],
              [[budget, name, *values] for budget, of in squares.items() for name, values in of["reasons"].items()]),
        Table("crater_lake_density", f"Triangles per area of the map (triangles / map), {shown.triangles:,} triangles",
              [("region", ""), ("share of the map", "%"), ("density", "triangles / map")],
              [[name, 100 * float(mask.mean()), density[name]] for name, mask in regions.items()])]
    return section


EXPERIMENT = Experiment("crater_lake", "Crater Lake", "Figure 11a",
                        "Real terrain: where the triangles are concentrated, and the distance of the mesh from the ground.",
                        measure)
