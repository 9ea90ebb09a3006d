"""Rank and Bound Test on Crater Lake: tables of several widths, a guaranteed bound, and the view from the rim."""
import numpy as np

from emitted_mesh import on_screen
from experiments.crater_lake import MAP, elevations, rms_and_largest, vertical_errors
from section import Chart, Claim, Experiment, Picture, Section, Table, reproduced_if
import charts

JOB = "crater_lake_rank"
FULL_SCALE = 945  # m, of the map's range
# full scale times the root of a texel: about 1,200, 3,500 and 10,000 triangles
RANKS = (0.16, 0.0505, 0.0158)
BOUNDS = (0.08, 0.055, 0.04, 0.028, 0.02, 0.014, 0.01)  # full scale
SHOWN = 0.0505, 8
BIT_WIDTHS = (6, 8, 12, 16)
# From the crater's northern rim, 30 m above the ground, across the lake; errors are those in the picture.
RIM = {"camera.eye": [4.262, 4.101, 2.463], "camera.target": [1.42, -1.766, 1.95], "camera.up": [0, 0, 1],
       "camera.field_of_view": 50, "camera.near_plane": 0.02}
SEEN_RANKS = {"per_point": (36, 22, 14, 7.6, 4.4, 2.7), "per_pixel": (1000, 400, 150, 60, 24, 10)}
SEEN_BOUNDS = (64, 32, 16, 8, 4, 2)  # pixels
PAPER_HEIGHTS, PAPER_LENGTHS = (0.005, 0.01, 0.02, 0.03, 0.0787), (12, 24, 48)
SEEN_BUDGETS = (2400, 9600)


def with_bounds(bound, bits=16):
    return {"formats.rank_bits": 0, "formats.bound_bits": bits, "tests.bound_threshold": bound}


def from_the_rim(study):
    """Runs by method; for a bound also its guarantee in pixels."""
    def seen(view, settings):
        return {**RIM, "hardware.test_order": "cheap_first", "tests.rank_view": view, **settings}

    # What is all behind the camera is left out: by the View Test, or by a bound's radius.
    ranks = {view: [study.run(f"seen_{view}_{rank}", JOB, seen(view, {"tests.rank_threshold": rank, "tests.view": True,
                                                                   "tests.view_threshold": 0}))
                    for rank in thresholds] for view, thresholds in SEEN_RANKS.items()}
    bounds = {bound: study.run(f"seen_bound_{bound}", JOB, seen("per_point", with_bounds(bound)))
              for bound in SEEN_BOUNDS}
    papers = [study.run(f"seen_paper_{job}_{height}_{length}", job, {
        **RIM, "tests.normal": False, "tests.generation_limit": 14, "tests.summed_height_threshold": height,
        "tests.view_threshold": length})
        for job in ("crater_lake_24", "crater_lake_704") for height in PAPER_HEIGHTS for length in PAPER_LENGTHS]
    return ranks, bounds, papers


def seen_errors(run, height):
    """Triangles, and the RMS and largest distance in pixels between a grid point and the mesh's point, as they appear in the picture."""
    errors, owner = vertical_errors(run.mesh, height)
    (rows, columns), camera = height.shape, run.job["camera"]
    x, y = np.meshgrid((np.arange(columns) + 0.5) / columns - 0.5, 0.5 - (np.arange(rows) + 0.5) / rows)
    mesh = run.job["mesh"]
    places, depths = zip(*(on_screen(np.stack([x * mesh["width"], y * mesh["depth"], z / 1000], axis=-1), camera) for z in (height, height + errors)))
    seen = (owner >= 0) & (depths[0] > camera["near_plane"]) & (
        np.abs(places[0]) <= np.array([camera["viewport_width"], camera["viewport_height"]]) / 2).all(axis=-1)
    apart = np.where(depths[1] > camera["near_plane"], np.linalg.norm(places[1] - places[0], axis=-1), np.inf)[seen]
    return run.triangles, float(np.sqrt((apart ** 2).mean())), float(apart.max())


def least_with(errors, triangles):
    return min((error[1] for error in errors if error[0] <= triangles), default=None)


def frontier(errors):
    """The errors that are lower than all those with fewer triangles."""
    best = []
    for error in sorted(errors):
        if not best or error[1] < best[-1][1]:
            best.append(error)
    return best


def add_view_from_the_rim(section, height, ranks, bounds, papers):
    shown = ranks["per_point"][2]
    ranks = {view: [seen_errors(run, height) for run in runs] for view, runs in ranks.items()}
    bounds = {bound: seen_errors(run, height) for bound, run in bounds.items()}
    papers = frontier(seen_errors(run, height) for run in papers)
    series = {name: list(zip(*(error[:2] for error in errors))) for name, errors in (
        ("Rank Test, per point", ranks["per_point"]), ("Rank Test, per pixel", ranks["per_pixel"]), ("Bound Test", bounds.values()),
        ("the paper's tests, best of a sweep", papers))}
    section.charts.append(Chart(charts.lines(series, "triangles", "RMS error in the picture, pixels", True, True, ("Rank Test, per point",)),
                                "From the crater's rim: RMS distance in the picture between a grid point and the mesh"))
    parts = [least_with(ranks["per_point"], budget) / least_with(papers, budget) for budget in SEEN_BUDGETS]
    worst = max(largest / bound for bound, (*_, largest) in bounds.items())
    section.claims += [
        Claim("From the crater's rim the Rank Test's error in the picture is at most half of the error of the paper's tests.",
              "testbench/setup/README.md", ", ".join(f"{part:.2f} of that error with {budget:,} triangles" for part, budget in zip(parts, SEEN_BUDGETS)),
              reproduced_if(max(parts) <= 0.5)),
        Claim("No grid point in the picture appears farther from the mesh than the bound.", "golden/ALGORITHM.md 4.7",
              f"{len(bounds)} runs: at most {worst:.3f} of the bound", reproduced_if(worst <= 1))]
    section.pictures.append(Picture(shown.render("wireframe"), "From the rim, with the view-dependent Rank Test"))
    section.tables.append(Table(
        "rank_view", "From the crater's rim",
        [("test", ""), ("triangles", ""), ("RMS error", "pixel"), ("maximum error", "pixel"), ("promised", "pixel")],
        [*([f"Rank Test, {view}", *error, ""] for view, errors in ranks.items() for error in errors),
         *(["Bound Test", *error, bound] for bound, error in bounds.items()), *(["the paper's", *error, ""] for error in papers)]))


def measure(study):
    ranks = {(rank, bits): study.run(f"rank_{rank}_{bits}", JOB, {"tests.rank_threshold": rank, "formats.rank_bits": bits})
             for rank in RANKS for bits in BIT_WIDTHS}
    bounds = {(bound, bits): study.run(f"bound_{bound}_{bits}", JOB, with_bounds(bound, bits))
              for bound, bits in [*((bound, 16) for bound in BOUNDS), *((0.02, bits) for bits in BIT_WIDTHS if bits != 16)]}
    seen = from_the_rim(study)
    yield
    section, height = Section(), elevations(MAP)
    errors = {key: rms_and_largest(run.mesh, height) for key, run in bounds.items()}
    worst = max(largest / (bound * FULL_SCALE) for (bound, _), (_, largest) in errors.items())
    section.claims = [Claim("No grid point is farther from the mesh than the Bound Test's threshold.", "testbench/check/PROMISES.md",
                            f"{len(bounds)} runs: at most {worst:.3f} of the threshold", reproduced_if(worst <= 1))]
    section.pictures = [Picture(ranks[SHOWN].render("shaded"), f"Crater Lake, {ranks[SHOWN].triangles:,} triangles")]
    section.tables = [
        Table("rank_widths", "Ranks of several widths",
              [("threshold", "full scale texel^1/2"), ("bits", ""), ("triangles", ""), ("RMS error", "m"), ("maximum error", "m")],
              [[*key, run.triangles, *rms_and_largest(run.mesh, height)] for key, run in ranks.items()]),
        Table("bound_curve", "Bounds",
              [("promised", "m"), ("bits", ""), ("triangles", ""), ("RMS error", "m"), ("maximum error", "m")],
              [[bound * FULL_SCALE, bits, bounds[bound, bits].triangles, *error] for (bound, bits), error in errors.items()])]
    add_view_from_the_rim(section, height, *seen)
    return section


EXPERIMENT = Experiment("rank_test", "One table entry per edge", "beyond the paper",
                        "The Rank and Bound Tests: how many bits they need, a guaranteed bound, and view-dependent thresholds.", measure)
