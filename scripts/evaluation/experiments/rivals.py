"""Error against triangles for every test, the paper's alternatives (2.3.1) and a GPU tessellator; cycles, reads and bits of
each test; precalculated points (2.5)."""
from pathlib import Path
from typing import NamedTuple

import numpy as np

from experiments.crater_lake import MAP, OTHER_METHODS, at_equal_triangles, elevations, reference_curves, rms_and_largest
from gpu_tessellator import screen_lengths, write_obj
from section import Chart, Claim, Experiment, Picture, Section, Table, MEASURED, reproduced_if
from sweep_file import JOBS
from .rank_test import seen_errors
from .view_distances import SOURCE
import charts

HEAD = JOBS / "head_lee_perry_smith.png"
LATTICE = {"mesh.source": "lattice", "tests.view": False}


class Surface(NamedTuple):
    """A map over a plane."""

    job: str
    settings: dict
    quads: tuple  # of a mesh that ends at the map's border, for a GPU
    pixels: tuple  # of a part of an edge, for a GPU, until its error is as small as all tests' with SHOWN triangles
    unit: str  # of errors
    full: float  # the displacement's scale in this unit
    per_map_unit: float


SURFACES = {
    "Crater Lake": Surface("crater_lake_rank", LATTICE, (3, 4), (36, 26, 16, 11), "m", 2478, 1),
    "half torus": Surface(None, {**LATTICE, "mesh.spacing": 64, "map.width": 256, "map.height": 256}, (8, 8),
                          (36, 26, 16, 11, 5, 3, 2.2), "‰", 1000, 1000),
    "head": Surface(None, {**LATTICE, "mesh.spacing": 128, "map.source": "file", "map.file": HEAD}, (8, 8),
                    (36, 26, 16, 11, 5, 3), "‰", 1000, 1000 / 65535)}
BUDGETS, SHOWN = (1200, 4800, 9600), 4800
BESIDE, SUMMED, RANK, BOUND = "Normal Test or ", "Summed Height Test", "8-bit Rank Test", "Bound Test"
RIVALS = {"mipmap": {"tests.mipmap_filter": "mean"}, "maximal mipmap": {"tests.mipmap_filter": "maximum"}}
BY_RANK = {"hardware.triangulation": "greatest_rank", "tests.generation_limit": 15}
# Thresholds to search, and settings.
CURVES = {BESIDE + SUMMED: ("normal,summed_height", {}),  # the paper's
          **{BESIDE + name: ("normal,mipmap", filtered) for name, filtered in RIVALS.items()},
          "Curvature Test": ("curvature", {}), RANK: ("rank", BY_RANK),
          BOUND: ("rank", {**BY_RANK, "formats.rank_bits": 0, "formats.bound_bits": 16})}
ALONE = {SUMMED: ("summed_height", {}), **{name: ("mipmap", filtered) for name, filtered in RIVALS.items()}}
TESTS = {**CURVES, **ALONE}
PATCHES = "edge factors, as on GPUs"
UNSPLIT = {"hardware.height_test": "summed_height", "hardware.triangulation": "shorter", "tests.normal": False, "tests.summed_height": False}
REFERENCES = {"rtin": "RTIN", "hmm": "greedy insertion"}
FITTED = (0.0885, 0.039, 0.0158)
POINTS = (0.01, 0.005, 0.001)  # thresholds of the Summed Height Test


def settings_of(test):
    searched, settings = TESTS[test]
    return {"hardware.height_test": searched.split(",")[-1], "hardware.triangulation": "shorter",
            "tests.normal": "normal" in searched, **settings}


def found_settings(run):
    """The result of `tessera tune`."""
    return {**{f"tests.{name}": value for name, value in run.tuned["tests"].items()}, "hardware.triangulation": run.tuned["triangulation"]}


def label(*words):
    return "_".join(map(str, words)).lower().replace(",", "").replace(" ", "_")


def map_of(surface):
    """In the unit of the surface's errors, row 0 on top."""
    if surface == "half torus":
        x, y = np.meshgrid(*[(np.arange(256) + 0.5) / 128 - 1] * 2)
        return 1000 * np.sqrt(np.maximum(0, 1 - ((np.hypot(x, y) - 0.55) / 0.25) ** 2))
    return elevations(MAP if surface == "Crater Lake" else HEAD) * SURFACES[surface].per_map_unit


def references_of(surface):
    file, part = (OTHER_METHODS, None) if surface == "Crater Lake" else (Path(__file__).with_name("torus_head_curves.csv"), surface)
    return {name: reference_curves(file, part)[method] for method, name in REFERENCES.items()}


def errors_of(run, surface, height):
    """Triangles, RMS and largest vertical error at the map's points."""
    return run.triangles, *rms_and_largest(run.mesh, height, SURFACES[surface].full / run.job["displacement"]["scale"])


def move_to_points(mesh, height):
    """Moves the mesh's vertices, in place, to the map's points under them."""
    rows, columns = height.shape
    x = np.clip((mesh.texture[:, 0] * columns).astype(int), 0, columns - 1)
    y = np.clip((mesh.texture[:, 1] * rows).astype(int), 0, rows - 1)
    mesh.texture = np.column_stack([(x + 0.5) / columns, (y + 0.5) / rows])
    mesh.positions = np.column_stack([mesh.positions[:, :2], height[rows - 1 - y, x] / 1000])


def multiple(curve, mesh):
    """The number of triangles of a curve at a mesh's RMS error, relative to the mesh's triangles, by a power law."""
    points = sorted((np.log(point[1]), np.log(point[0])) for point in curve)
    if np.log(mesh[1]) < points[0][0]:
        return f"more than {max(curve)[0] / mesh[0]:.1f}"
    return f"{np.exp(np.interp(np.log(mesh[1]), *zip(*points))) / mesh[0]:.1f}"


def add_patches(study, bases):
    """Runs on meshes made by a GPU tessellator, by surface. They are not split further; the machine displaces them."""
    runs = {surface: [] for surface in bases}
    for surface, base in bases.items():
        length = screen_lengths(base.mesh.positions, base.job["camera"])
        for pixels in SURFACES[surface].pixels:
            path = study.store.folder.parent / "meshes" / f"{label(surface, pixels)}.obj"
            write_obj(path, base.mesh, length, pixels)
            runs[surface].append(study.run(label(surface, "patches", pixels), SURFACES[surface].job, {
                **SURFACES[surface].settings, **UNSPLIT, "mesh.source": "file", "mesh.file": path, "hardware.displacement_filter": "bilinear"}))
    return runs


def measure(study):
    tuned = {(name, test, budget): study.tune(
        label(name, test, budget), budget, surface.job, TESTS[test][0], {**surface.settings, **settings_of(test)},
        metric="max" if test == BOUND else None, run=False)
        for name, surface in SURFACES.items() for test in TESTS for budget in (BUDGETS if test in CURVES else (SHOWN,))}
    bases = {name: study.run(label(name, "base"), surface.job, {
        **surface.settings, **UNSPLIT, "mesh.source": "plane", "mesh.columns": surface.quads[0], "mesh.rows": surface.quads[1]})
        for name, surface in SURFACES.items()}
    fitted = [[study.run(f"{heights}_{rank}", "crater_lake_rank", {"tests.rank_threshold": rank, "map.heights": heights})
               for heights in ("given", "fitted")] for rank in FITTED]
    points = [[study.run(f"points_{threshold}_{which}", "crater_lake_24", {
        "tests.view": False, "tests.normal": False, "tests.generation_limit": 15, "tests.summed_height_threshold": threshold,
        "hardware.displacement_filter": which, "formats.tex_coord_fraction": 0}) for which in ("nearest", "bilinear")]
        for threshold in POINTS]
    yield
    timed = {test: [study.run(label("timed", test, design), SURFACES["Crater Lake"].job, {
        **LATTICE, **settings_of(test), **found_settings(tuned["Crater Lake", test, SHOWN]), "mode": "timed", "hardware.design": design})
        for design in ("paper", "modern")] for test in TESTS}
    patches = add_patches(study, bases)
    yield
    section = Section(sources=[SOURCE])
    maps = {name: map_of(name) for name in SURFACES}
    curves = {name: {} for name in SURFACES}
    for (name, test, _), run in tuned.items():
        found, unit = run.tuned, SURFACES[name].per_map_unit
        curves[name].setdefault(test, []).append((found["triangles"], found["error"]["rms"] * unit, found["error"]["max"] * unit))
    for name, runs in patches.items():
        curves[name][PATCHES] = [errors_of(run, name, maps[name]) for run in runs]
        curves[name].update(references_of(name))
    lake = maps["Crater Lake"]
    seen = [seen_errors(run, lake) for run in patches["Crater Lake"]]
    add_curves(section, curves, "By the error in pixels in the picture of Crater Lake: " + ", ".join(
        f"{multiple(seen, seen_errors(timed[test][0], lake))} of the {test}'s" for test in (BESIDE + SUMMED, RANK)))
    add_machines(section, timed)
    add_fitted(section, [[errors_of(run, "Crater Lake", lake) for run in pair] for pair in fitted])
    add_points(section, points, lake)
    patch = min(patches["Crater Lake"], key=lambda run: abs(run.triangles - SHOWN))
    section.pictures = [Picture(run.render("wireframe"), f"{name}: {run.triangles:,} triangles, RMS {errors_of(run, 'Crater Lake', lake)[1]:.1f} m")
                        for name, run in [*((test, timed[test][0]) for test in CURVES if test != BESIDE + "mipmap"), (PATCHES, patch)]]
    return section


def add_curves(section, curves, in_picture):
    for name, of in curves.items():
        for column, error in ((1, "RMS"), (2, "largest")):
            series = {test: list(zip(*((point[0], point[column]) for point in points if 600 <= point[0] <= 20000)))
                      for test, points in of.items() if test not in ALONE}
            section.charts.append(Chart(charts.lines(series, "triangles", f"{error} vertical error, {SURFACES[name].unit}", True, True, (RANK,)),
                                        f"{name}: {error} vertical error at every grid point"
                                        + (", thousandths of the map's range" if SURFACES[name].unit == "‰" else "")))
    # At equal triangles: a mesh, or between two meshes.
    at = {name: {test: points[0] if test in ALONE else points[BUDGETS.index(SHOWN)] if test in CURVES else
                 (SHOWN, *(at_equal_triangles(sorted(points), SHOWN, column) for column in (1, 2)))
                 for test, points in of.items()} for name, of in curves.items()}

    def beside(prefix):
        return "RMS error at equal triangles, thresholds tuned: " + "; ".join(
            f"{name}: " + ", ".join(f"{test} {of[prefix + test][1]:.3g}" for test in ALONE) + f" {SURFACES[name].unit}" for name, of in at.items())

    def best(prefix):
        return all(of[prefix + SUMMED][1] < min(of[prefix + rival][1] for rival in RIVALS) for of in at.values())

    def multiples(test):
        return f"of the {test}'s: " + ", ".join(f"{name} {multiple(curves[name][PATCHES], of[test])}" for name, of in at.items())

    against = {name: [point[1] / other for point in of[RANK] if (other := at_equal_triangles(of["RTIN"], point[0]))] for name, of in curves.items()}
    section.claims += [
        Claim("The averaging of mipmaps smooths over areas of detail; a maximal filter was proposed to overcome this.", "section 2.3.1",
              "each alone in place of the Summed Height Test. " + beside(""), reproduced_if(best(""))),
        Claim("The Normal Test with the Summed Height Test filters the map effectively, which is not possible with maximal mipmaps.",
              "sections 2.3.1, 5", "each together with the Normal Test. " + beside(BESIDE), reproduced_if(best(BESIDE))),
        Claim("A patch with a factor for each edge, from its length on the screen, and uniform inside, as on GPUs since Direct3D 11.",
              "since the paper", f"triangles at equal RMS error, {multiples(BESIDE + SUMMED)}; {multiples(RANK)}. {in_picture}", MEASURED),
        Claim("The Rank Test's error is below RTIN's at every number of triangles.", "beyond the paper",
              "; ".join(f"{name}: {min(parts):.2f} to {max(parts):.2f} times its RMS error" for name, parts in against.items()),
              reproduced_if(all(max(parts) < 1 for parts in against.values())))]
    section.tables.append(Table(
        "rivals", f"At about {SHOWN:,} triangles: vertical error at every grid point; other methods and GPU interpolated between two meshes",
        [("test", ""), *((column, unit) for name in at for column, unit in
                         ((f"{name}: triangles", ""), ("RMS", SURFACES[name].unit), ("largest", SURFACES[name].unit)))],
        [[test, *(figure for of in at.values() for figure in of[test])] for test in at["head"]]))


def add_machines(section, timed):
    rows = {}
    for test, runs in timed.items():
        table = TESTS[test][0].split(",")[-1] + "_table"
        of = [run.figures for run in runs]
        reads = [figures[f"{table}.reads"] for figures in of]
        texels = of[0]["displacement_map.size"] / of[0]["displacement_map.entry"]
        rows[test] = [runs[0].triangles, 8 * of[0][f"{table}.size"] / texels,
                      *(value for figures, read, run in zip(of, reads, runs) for value in
                        (read / figures["run.edges_tested"], read / run.triangles, figures["timing.cycles"] / run.triangles))]
    section.claims.append(Claim(
        "The Summed Height Test takes four cycles per point, since each of four values must be read.", "section 3.1.3",
        f"{rows[SUMMED][2]:.3g} entries per edge; cycles per triangle in the paper's design and in the modern one: "
        + ", ".join(f"{test} {rows[test][4]:.1f} and {rows[test][7]:.1f}" for test in (*ALONE, "Curvature Test", RANK, BOUND)),
        reproduced_if(rows[SUMMED][2] == 12)))
    section.tables.append(Table(
        "rivals_machine", "Crater Lake: reads of the test's table, and cycles, in the paper's design and the modern one",
        [("test", ""), ("triangles", ""), ("table", "bit/texel"), *((column, "") for design in ("paper's design", "modern design") for column in
                                                                    (f"{design}: reads an edge", "reads a triangle", "cycles a triangle"))],
        [[test, *row] for test, row in rows.items()]))


def add_fitted(section, fits):
    gains = [1 - after[1] / before[1] for before, after in fits]
    section.claims.append(Claim(
        "Fitted heights reduce the error of the same mesh by an eighth.", "testbench/setup/tables/fitted_heights.h",
        ", ".join(f"{100 * gain:.0f} % with {before[0]:,} triangles" for gain, (before, _) in zip(gains, fits)), reproduced_if(min(gains) > 1 / 8)))


def add_points(section, points, height):
    rows = []
    for nearest, bilinear in points:
        row = [*errors_of(nearest, "Crater Lake", height)[:2]]
        between = errors_of(bilinear, "Crater Lake", height)[1]
        move_to_points(nearest.mesh, height)
        rows.append([*row, errors_of(nearest, "Crater Lake", height)[1], between])
    section.claims.append(Claim(
        "Precalculated points in place of midpoints and the Tex Coord Test represent the map more accurately.", "section 2.5",
        "RMS error at midpoints and at the map's points: " + ", ".join("{1:.2f} and {2:.2f} m with {0:,} triangles".format(*row) for row in rows),
        reproduced_if(all(moved < midpoints for _, midpoints, moved, _ in rows))))
    section.tables.append(Table(
        "rivals_points", "Crater Lake from 24 base triangles: RMS vertical error by the position of an inserted vertex",
        [("triangles", ""), ("midpoint", "m"), ("precalculated point", "m"), ("midpoint, height between four texels", "m")], rows))


EXPERIMENT = Experiment("rivals", "The paper's alternatives, and later hardware", "Sections 2.3.1, 2.5",
                        "Every test, mipmaps, precalculated points and a GPU's patches on three maps, and the cost of each test.", measure)
