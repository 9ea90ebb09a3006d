"""Section 2.3.1: the paper's rivals, the tests since, fitted heights, precalculated points, and a tessellator as GPUs have it."""
import tomllib

import numpy as np

from experiments.crater_lake import MAP, elevations, vertical_errors
from gpu_tessellator import screen_lengths, write_obj
from section import Chart, Claim, Experiment, Picture, Section, Table, MEASURED, reproduced_if
from .view_distances import SOURCE
import charts

ALONE = {"tests.view": False, "tests.normal": False}
BY_RANK = {"hardware.height_test": "rank", "hardware.triangulation": "greatest_rank", "tests.generation_limit": 15}
SUMS = {"hardware.height_test": "summed_height", "hardware.triangulation": "shorter"}
TESTS = {"Summed Height Test": ("summed_height", {}), "mipmap": ("mipmap", {"tests.mipmap_filter": "mean"}),
         "maximal mipmap": ("mipmap", {"tests.mipmap_filter": "maximum"}), "Curvature Test": ("curvature", {})}
PAPER = {"Summed Height Test": "can miss details by averaging; with the Normal Test an effective filter",
         "mipmap": "smooths over areas of detail", "maximal mipmap": "proposed by others to overcome this"}
LENGTHS = "interpolated.reference_to_mesh_rms_texels", "interpolated.reference_to_mesh_max_texels"
TEXELS = 336 * 459
# job, settings, budget of triangles, unit, rank threshold
SURFACES = {
    "Crater Lake": ("crater_lake_rank", {}, 4800, "m", 0.039),
    "half torus": (None, {"mesh.source": "lattice", "mesh.spacing": 64, "map.width": 256, "map.height": 256}, 2400, "texel", 0.065),
    "head": ("head", {"mesh.columns": 16, "mesh.rows": 16}, 4800, "texel", 0.028)}
# As `tessera tune` finds them for the budget: threshold of the test, generation limit; beside the Normal Test also its
# threshold. The half torus is tuned here.
FOUND = {("Crater Lake", "Summed Height Test"): (0.045808, 8), ("Crater Lake", "mipmap"): (0.0001411, 4),
         ("Crater Lake", "maximal mipmap"): (1.079e-05, 4), ("Crater Lake", "Curvature Test"): (0.13715, 6),
         ("Crater Lake", "Normal Test, Summed Height Test"): (0.045808, 8, 1.399),
         ("Crater Lake", "Normal Test, mipmap"): (0.0010606, 4, 0.047772),
         ("Crater Lake", "Normal Test, maximal mipmap"): (0.0018327, 4, 0.040801),
         ("head", "Summed Height Test"): (0.028968, 4), ("head", "mipmap"): (0.0049774, 3),
         ("head", "maximal mipmap"): (0.0049472, 3), ("head", "Curvature Test"): (0.10182, 4)}
FITTED = (0.0885, 0.039, 0.0158)
# GPUs: base meshes that end at the map's border, with as many triangles; pixels an edge's part is long.
PATCHES = {"Crater Lake": ("crater_lake_24", {"mesh.columns": 3, "mesh.rows": 4}, (32, 22, 15, 10)),
           "half torus": (None, {"mesh.source": "plane", "mesh.columns": 4, "mesh.rows": 4, "map.width": 256, "map.height": 256},
                          (12, 8))}
UNSPLIT = {**ALONE, "tests.summed_height": False}
POINTS = (0.01, 0.005)  # thresholds of the Summed Height Test


def found_settings(surface, name):
    test, filtered = TESTS[name.removeprefix("Normal Test, ")]
    threshold, generations, *normal = FOUND[surface, name]
    return {"hardware.height_test": test, **filtered, f"tests.{test}_threshold": threshold, "tests.generation_limit": generations,
            **({"tests.normal": True, "tests.normal_threshold": normal[0]} if normal else {})}


def add_patches(study, bases):
    """Runs on meshes that a GPU's tessellator makes, by surface. They are not split further; the machine displaces them."""
    runs = {}
    for surface, (flat, displaced) in bases.items():
        job, settings, sizes = PATCHES[surface]
        camera = tomllib.loads((displaced.folder / "job.toml").read_text())["camera"]
        length = screen_lengths(displaced.mesh.positions, camera)
        # nearest the vertices of the flat run, which are in another order if some are merged
        order = {tuple(np.round(t, 9)): k for k, t in enumerate(displaced.mesh.texture)}
        number = [order[tuple(np.round(t, 9))] for t in flat.mesh.texture]
        normals = np.tile((0.0, 0.0, 1.0), (len(number), 1))
        runs[surface] = []
        for pixels in sizes:
            path = study.store.folder.parent / "meshes" / f"{surface.replace(' ', '_')}_{pixels}.obj"
            write_obj(path, flat.mesh, normals, lambda a, b: length(number[a], number[b]), pixels)
            runs[surface].append(study.run(f"gpu_{surface.replace(' ', '_')}_{pixels}", job, {
                **settings, **UNSPLIT, "mesh.source": "file", "mesh.file": path, "hardware.displacement_filter": "bilinear"},
                error=surface != "Crater Lake"))
    return runs


def errors_of(run, surface, height):
    """RMS and largest. At Crater Lake's grid points, as `tessera compare` does it beside other measures that take longer."""
    if surface != "Crater Lake":
        return run.error[LENGTHS[0]], run.error[LENGTHS[1]]
    errors, owner = vertical_errors(run.mesh, height)
    return float(np.sqrt((errors[owner >= 0] ** 2).mean())), float(np.abs(errors).max())


def move_to_points(run, height):
    """A run's mesh with its vertices at the map's points under them, in its place."""
    rows, columns = height.shape
    mesh = run.mesh
    x = np.clip((mesh.texture[:, 0] * columns).astype(int), 0, columns - 1)
    y = np.clip((mesh.texture[:, 1] * rows).astype(int), 0, rows - 1)
    mesh.texture = np.column_stack([(x + 0.5) / columns, (y + 0.5) / rows])
    mesh.positions = np.column_stack([mesh.positions[:, :2], height[rows - 1 - y, x] / 1000])


def triangles_at(measured, error):
    """Between meshes of (triangles, RMS error), by a power law; None beyond them."""
    points = sorted((np.log(rms), np.log(triangles)) for triangles, rms in measured)
    if not points[0][0] <= np.log(error) <= points[-1][0]:
        return None
    return float(np.exp(np.interp(np.log(error), *zip(*points))))


def measure(study):
    found = {}
    for surface, (job, settings, budget, _, rank) in SURFACES.items():
        exact = surface != "Crater Lake"
        for prefix in ("", "Normal Test, "):
            for name, (test, filtered) in TESTS.items():
                label = f"{surface}_{prefix}{name}".replace(", ", "_").replace(" ", "_")
                chosen = {**settings, **ALONE, **SUMS}
                if (surface, prefix + name) in FOUND:
                    found[surface, prefix + name] = study.run(label, job, {**chosen, **found_settings(surface, prefix + name)}, error=exact)
                elif surface == "half torus" and (not prefix or name != "Curvature Test"):
                    found[surface, prefix + name] = study.tune(label, budget, job, f"normal,{test}" if prefix else test, {**chosen, **filtered})
        found[surface, "Rank Test"] = study.run(f"{surface}_rank".replace(" ", "_"), job, {
            **settings, **ALONE, **BY_RANK, "tests.rank_threshold": rank}, error=exact)
    fitted = [[study.run(f"{heights}_{rank}", "crater_lake_rank", {"tests.rank_threshold": rank, "map.heights": heights})
               for heights in ("given", "fitted")] for rank in FITTED]
    points = [[study.run(f"points_{threshold}_{which}", "crater_lake_24", {
        **ALONE, "tests.generation_limit": 14, "tests.summed_height_threshold": threshold, "hardware.displacement_filter": which})
        for which in ("nearest", "bilinear")] for threshold in POINTS]
    timed = {name: {design: study.run(f"timed_{name}_{design}".replace(" ", "_"), "crater_lake_rank", {
        **ALONE, "mode": "timed", "hardware.design": design,
        **({"tests.rank_threshold": SURFACES["Crater Lake"][4]} if name == "Rank Test" else
           {**SUMS, **found_settings("Crater Lake", name)})}) for design in ("paper", "modern")} for name in (*TESTS, "Rank Test")}
    bases = {}
    for surface, (job, settings, _) in PATCHES.items():
        name = f"base_{surface.replace(' ', '_')}"
        bases[surface] = (study.run(f"{name}_flat", job, {**settings, **UNSPLIT, "displacement.scale": 0}),
                          study.run(name, job, {**settings, **UNSPLIT}))
    yield
    patches = add_patches(study, bases)
    yield
    return section_of(found, fitted, points, timed, patches)


def table_figures(run):
    table = next(f"{kind}_table" for kind in ("summed_height", "rank", "curvature", "mipmap") if f"{kind}_table.size" in run.figures)
    return run.figures[f"{table}.reads"] / run.figures["run.edges_tested"], 8 * run.figures[f"{table}.size"] / TEXELS


def section_of(found, fitted, points, timed, patches):
    height = elevations(MAP)
    errors = {of: errors_of(run, of[0], height) for of, run in found.items()}
    of_patches = {surface: [(run.triangles, *errors_of(run, surface, height)) for run in runs] for surface, runs in patches.items()}
    rows = []
    for (surface, name), run in found.items():
        machine = [""] * 4
        if surface == "Crater Lake" and name in timed:
            machine = [*reversed(table_figures(timed[name]["paper"])),
                       *(one.figures["timing.cycles"] / one.triangles for one in timed[name].values())]
        rows.append([surface, name, PAPER.get(name, ""), run.triangles, *errors[surface, name], SURFACES[surface][3], *machine])
    for surface, measured in of_patches.items():
        rows += [[surface, "a factor an edge, uniform inside", "", *figures, SURFACES[surface][3], "", "", "", ""] for figures in measured]

    def beside(surface, prefix):
        return ", ".join(f"{name} {errors[surface, prefix + name][0]:.3g}" for name in PAPER) + f" {SURFACES[surface][3]}"

    def best(surfaces, prefix):
        return all(errors[surface, f"{prefix}Summed Height Test"][0] < min(errors[surface, f"{prefix}{rival}"][0]
                                                                           for rival in ("mipmap", "maximal mipmap")) for surface in surfaces)

    def multiple(surface, name):
        triangles = triangles_at([figures[:2] for figures in of_patches[surface]], errors[surface, name][0])
        return f"{surface}, of the {name}: " + (f"{triangles / found[surface, name].triangles:.1f}" if triangles else "beyond those tried")
    flat = tuple(patches)
    fits = [[(run.triangles, errors_of(run, "Crater Lake", height)[0]) for run in pair] for pair in fitted]
    gains = [1 - after[1] / before[1] for before, after in fits]
    compared = []
    for nearest, bilinear in points:
        rms = [errors_of(run, "Crater Lake", height)[0] for run in (nearest, bilinear)]
        move_to_points(nearest, height)
        compared.append((nearest.triangles, rms[0], errors_of(nearest, "Crater Lake", height)[0], rms[1]))
    section = Section(sources=[SOURCE])
    section.claims = [
        Claim("The averaging of mipmaps smooths over areas of detail in the displacement map.", "section 2.3.1",
              "RMS error of each test alone, at equal triangles: " + "; ".join(f"{s}: {beside(s, '')}" for s in SURFACES),
              reproduced_if(best(SURFACES, ""))),
        Claim("The Normal Test with the Summed Height Test filters the map effectively, which is not possible with maximal mipmaps.",
              "sections 2.3.1, 5", "RMS error beside the Normal Test, thresholds tuned: "
              + "; ".join(f"{s}: {beside(s, 'Normal Test, ')}" for s in flat), reproduced_if(best(flat, "Normal Test, "))),
        Claim("A triangle patch has a factor for each edge and is uniform inside, as in GPUs since Direct3D 11.", "since the paper",
              "triangles at equal RMS error, as a multiple: "
              + ", ".join(multiple(s, name) for s in flat for name in ("Summed Height Test", "Rank Test"))
              + ". From one camera: a factor follows from an edge's length on the screen, not from the map.", MEASURED),
        Claim("Fitted heights take a seventh off the error of the same mesh.", "modules/DECISIONS.md",
              ", ".join(f"{100 * gain:.0f} % with {pair[0][0]:,} triangles" for gain, pair in zip(gains, fits)),
              reproduced_if(min(gains) > 0.13)),
        Claim("Precalculated points in place of midpoints represent the map more accurately.", "section 2.5",
              "Crater Lake from 24 base triangles, RMS error with vertices at midpoints; at the map's points; at midpoints, read between "
              "four texels: " + ", ".join("{:,} triangles {:.2f}, {:.2f}, {:.2f} m".format(*figures) for figures in compared),
              reproduced_if(all(moved < nearest for _, nearest, moved, _ in compared)))]
    series = {"Rank Test": list(zip(*(before for before, _ in fits))), "Rank Test, fitted heights": list(zip(*(after for _, after in fits))),
              "a factor an edge": list(zip(*(figures[:2] for figures in of_patches["Crater Lake"])))}
    series.update({name: ([found["Crater Lake", name].triangles], [errors["Crater Lake", name][0]]) for name in TESTS})
    section.charts.append(Chart(charts.lines(series, "triangles", "RMS vertical error, m", True, True, ("Rank Test, fitted heights",)),
                                "Crater Lake from 24 base triangles: RMS vertical error at every grid point"))
    budget = SURFACES["Crater Lake"][2]
    patch, of_patch = min(zip(patches["Crater Lake"], of_patches["Crater Lake"]), key=lambda pair: abs(pair[0].triangles - budget))
    shown = [(name, found["Crater Lake", name], errors["Crater Lake", name][0]) for name in ("mipmap", "Summed Height Test", "Rank Test")]
    section.pictures = [Picture(run.render("wireframe"), f"{name}: {run.triangles:,} triangles, RMS {rms:.1f} m")
                        for name, run, rms in [*shown, ("a factor an edge", patch, of_patch[1])]]
    section.tables = [Table(
        "rivals", "At equal triangles: one test alone, or beside the Normal Test. Cycles: Crater Lake, timed, one test alone",
        [("surface", ""), ("test", ""), ("what the paper says", ""), ("triangles", ""), ("RMS error", ""), ("maximum error", ""), ("unit", ""),
         ("table", "bit/texel"), ("reads an edge", ""), ("cycles a triangle, paper's design", ""), ("modern design", "")], rows)]
    return section


EXPERIMENT = Experiment("rivals", "The paper's rivals, and hardware since", "section 2.3.1",
                        "Other tests in the Summed Height Test's place, fitted heights, precalculated points, and a GPU's uniform patches.",
                        measure)
