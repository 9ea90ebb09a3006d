"""One table entry an edge: Rank, Bound and Curvature Test on Crater Lake, beside the paper's."""
from experiments.crater_lake import BUDGETS, GRIDS, MAXIMUM, OTHER_METHODS, RMS, at_equal_triangles, reference_curves
from section import Chart, Claim, Experiment, Picture, Section, Table, reproduced_if
import charts

JOB = "crater_lake_rank"
FULL_SCALE = 945  # m, of the map's range
TEXELS = 336 * 459
# full scale times the root of a texel: about 600 to 20,000 triangles
RANKS = (0.28, 0.16, 0.0885, 0.0505, 0.0285, 0.0158, 0.0085)
BOUNDS = (0.08, 0.055, 0.04, 0.028, 0.02, 0.014, 0.01)  # full scale
SHOWN = 0.0285
MESH = {"mode": "functional"}  # where cycles are not asked for
CURVATURES = (0.58, 0.29, 0.14, 0.067, 0.032)  # full scale texels
BIT_WIDTHS = (6, 8, 12, 16)
# From the crater's northern rim, 30 m above the ground, across the lake; errors are those in the picture.
RIM = {"camera.eye": [4.262, 4.101, 2.463], "camera.target": [1.42, -1.766, 1.95], "camera.up": [0, 0, 1],
       "camera.field_of_view": 50, "camera.near_plane": 0.02}
SEEN_RANKS = {"per_point": (36, 22, 14, 7.6, 4.4, 2.7), "per_pixel": (1000, 400, 150, 60, 24, 10)}
SEEN_BOUNDS = (64, 32, 16, 8, 4, 2)  # pixels
PAPER_HEIGHTS, PAPER_LENGTHS = (0.005, 0.01, 0.02, 0.03, 0.0787), (12, 24, 48)
SEEN_RMS, SEEN_MAXIMUM = "vertical.rms_pixels", "vertical.max_pixels"
SEEN_BUDGETS = (2400, 9600)


def with_bounds(bound, bits=16):
    return {"formats.rank_bits": 0, "formats.bound_bits": bits, "tests.bound_threshold": bound}


def by_curvature(threshold):
    return {"hardware.height_test": "curvature", "hardware.triangulation": "shorter", "tests.curvature_threshold": threshold}


# One of each test, of about 5,000 triangles.
TIMED = {"Rank Test": (JOB, {"tests.rank_threshold": 0.038}, "rank_table"),
         "Bound Test": (JOB, with_bounds(0.028), "rank_table"),
         "Curvature Test": (JOB, by_curvature(0.14), "curvature_table"),
         "Summed Height Test": ("crater_lake_704", {"tests.view": False, "tests.normal": False, "tests.summed_height_threshold": 0.03},
                                "summed_height_table")}


def from_the_rim(study):
    """Runs by method; of a bound the pixels it promises."""
    def seen(view, settings):
        return {**MESH, **RIM, "hardware.test_order": "cheap_first", "tests.rank_view": view, **settings}

    # What is all behind the camera is left out: by the View Test, or by a bound's radius.
    ranks = {view: [study.run(f"seen_{view}_{rank}", JOB, seen(view, {"tests.rank_threshold": rank, "tests.view": True,
                                                                   "tests.view_threshold": 0}), error=True)
                    for rank in thresholds] for view, thresholds in SEEN_RANKS.items()}
    bounds = {bound: study.run(f"seen_bound_{bound}", JOB, seen("per_point", with_bounds(bound)), error=True)
              for bound in SEEN_BOUNDS}
    papers = [study.run(f"seen_paper_{job}_{height}_{length}", job, {
        **MESH, **RIM, "tests.normal": False, "tests.generation_limit": 14, "tests.summed_height_threshold": height,
        "tests.view_threshold": length}, error=True)
        for job in ("crater_lake_24", "crater_lake_704") for height in PAPER_HEIGHTS for length in PAPER_LENGTHS]
    return ranks, bounds, papers


def least_with(runs, triangles):
    return min((run.error[SEEN_RMS] for run in runs if run.triangles <= triangles), default=None)


def frontier(runs):
    """Those that no other beats with fewer triangles."""
    best = []
    for run in sorted(runs, key=lambda run: run.triangles):
        if not best or run.error[SEEN_RMS] < best[-1].error[SEEN_RMS]:
            best.append(run)
    return best


def add_view_from_the_rim(section, ranks, bounds, papers):
    papers = frontier(papers)
    series = {"Rank Test, per point": curve(ranks["per_point"], SEEN_RMS), "Rank Test, per pixel": curve(ranks["per_pixel"], SEEN_RMS),
              "Bound Test": curve(bounds.values(), SEEN_RMS), "the paper's tests, the best of a sweep": curve(papers, SEEN_RMS)}
    section.charts.append(Chart(charts.lines(series, "triangles", "RMS error in the picture, pixels", True, True, ("Rank Test, per point",)),
                                "From the crater's rim: RMS distance in the picture between a grid point and the mesh"))
    parts = [least_with(ranks["per_point"], budget) / least_with(papers, budget) for budget in SEEN_BUDGETS]
    worst = max(run.error[SEEN_MAXIMUM] / bound for bound, run in bounds.items())
    section.claims += [
        Claim("From the crater's rim the Rank Test's error in the picture is at most half of that of the paper's tests.",
              "modules/DECISIONS.md", ", ".join(f"{part:.2f} of it with {budget:,} triangles" for part, budget in zip(parts, SEEN_BUDGETS)),
              reproduced_if(max(parts) <= 0.5)),
        Claim("No grid point in the picture appears farther from the mesh than the bound.", "modules/DECISIONS.md",
              f"{len(bounds)} runs: at most {worst:.3f} of the bound", reproduced_if(worst <= 1))]
    section.pictures.append(Picture(ranks["per_point"][2].render("wireframe"), "From the rim, as the Rank Test sees it"))
    section.tables.append(Table(
        "rank_view", "From the crater's rim",
        [("test", ""), ("triangles", ""), ("RMS error", "pixel"), ("maximum error", "pixel"), ("promised", "pixel")],
        [*([f"Rank Test, {view}", run.triangles, run.error[SEEN_RMS], run.error[SEEN_MAXIMUM], ""]
           for view, runs in ranks.items() for run in runs),
         *(["Bound Test", run.triangles, run.error[SEEN_RMS], run.error[SEEN_MAXIMUM], bound] for bound, run in bounds.items()),
         *(["the paper's", run.triangles, run.error[SEEN_RMS], run.error[SEEN_MAXIMUM], ""] for run in papers)]))


def measure(study):
    ranks = {(rank, bits): study.run(f"rank_{rank}_{bits}", JOB, {**MESH, "tests.rank_threshold": rank, "formats.rank_bits": bits}, error=True)
             for rank in RANKS for bits in BIT_WIDTHS}
    bounds = {bound: study.run(f"bound_{bound}", JOB, {**MESH, **with_bounds(bound)}, error=True) for bound in BOUNDS}
    widths = {bits: study.run(f"bound_of_{bits}", JOB, {**MESH, **with_bounds(0.02, bits)}, error=True) for bits in BIT_WIDTHS}
    curvatures = [study.run(f"curvature_{threshold}", JOB, {**MESH, **by_curvature(threshold)}, error=True) for threshold in CURVATURES]
    timed = {(test, design): study.run(f"{test.lower().replace(' ', '_')}_{design}", job, {
        "mode": "timed", "hardware.design": design, **settings}, error=True)
        for test, (job, settings, _) in TIMED.items() for design in ("paper", "modern")}
    papers = {budget: study.tune(f"budget_{budget}", budget, "crater_lake_704", settings={"tests.view": False}, grid=GRIDS)
              for budget in BUDGETS}
    seen = from_the_rim(study)
    yield
    section = Section()
    references = reference_curves(OTHER_METHODS)
    for column, figure, name in ((1, RMS, "RMS"), (2, MAXIMUM, "maximum")):
        series = {"Rank Test": curve([ranks[rank, 12] for rank in RANKS], figure),
                  "Bound Test": curve(bounds.values(), figure),
                  "Curvature Test": curve(curvatures, figure),
                  "the paper's tests, tuned": curve(papers.values(), figure)}
        series.update({method: ([point[0] for point in points if 600 <= point[0] <= 20000],
                                [point[column] for point in points if 600 <= point[0] <= 20000])
                       for method, points in references.items() if method in ("rtin", "terra")})
        section.charts.append(Chart(charts.lines(series, "triangles", f"{name} vertical error, m", True, True, ("Rank Test",)),
                                    f"{name} vertical error at every grid point; Rank, Bound and Curvature Test from 24 base triangles"))
    against = [run.error[RMS] / at_equal_triangles(references["rtin"], run.triangles)
               for run in (ranks[rank, 12] for rank in RANKS) if at_equal_triangles(references["rtin"], run.triangles)]
    worst = max(run.error[MAXIMUM] / (bound * FULL_SCALE) for bound, run in [*bounds.items(), *((0.02, run) for run in widths.values())])
    section.claims = [
        Claim("The Rank Test's error is below RTIN's at every number of triangles.", "modules/DECISIONS.md",
              f"{min(against):.2f} to {max(against):.2f} times its RMS error", reproduced_if(max(against) < 1)),
        Claim("No grid point is farther from the mesh than the Bound Test's threshold.", "modules/DECISIONS.md",
              f"{len(bounds) + len(widths)} runs: at most {worst:.3f} of the threshold", reproduced_if(worst <= 1))]
    shown = ranks[SHOWN, 12]
    section.pictures = [Picture(shown.render("shaded"), f"Crater Lake, {shown.triangles:,} triangles"),
                        Picture(shown.render("wireframe"), "Its triangles")]
    section.tables = [
        Table("rank_curve", "Ranks of several widths",
              [("threshold", "full scale texel^1/2"), ("bits", ""), ("triangles", ""), ("RMS error", "m"), ("maximum error", "m")],
              [[rank, bits, run.triangles, run.error[RMS], run.error[MAXIMUM]] for (rank, bits), run in ranks.items()]),
        Table("bound_curve", "Bounds",
              [("promised", "m"), ("bits", ""), ("triangles", ""), ("maximum error", "m"), ("RMS error", "m")],
              [[bound * FULL_SCALE, bits, run.triangles, run.error[MAXIMUM], run.error[RMS]]
               for bound, bits, run in [*((bound, 16, run) for bound, run in bounds.items()),
                                        *((0.02, bits, run) for bits, run in widths.items())]]),
        Table("curvature_curve", "Curvatures", [("threshold", "full scale texel"), ("triangles", ""), ("RMS error", "m"), ("maximum error", "m")],
              [[threshold, run.triangles, run.error[RMS], run.error[MAXIMUM]] for threshold, run in zip(CURVATURES, curvatures)]),
        Table("height_tests", "Cycles, reads and tables of each test",
              [("test", ""), ("design", ""), ("triangles", ""), ("RMS error", "m"), ("cycles per triangle", ""), ("edges tested per triangle", ""),
               ("table reads per triangle", ""), ("table", "bit/texel")],
              [[test, design, run.triangles, run.error[RMS], run.figures["timing.cycles"] / run.triangles,
                run.figures["run.edges_tested"] / run.triangles, run.figures[f"{TIMED[test][2]}.reads"] / run.triangles,
                8 * run.figures[f"{TIMED[test][2]}.size"] / TEXELS] for (test, design), run in timed.items()])]
    add_view_from_the_rim(section, *seen)
    return section


def curve(runs, figure):
    runs = list(runs)
    return [run.triangles for run in runs], [run.error[figure] for run in runs]


EXPERIMENT = Experiment("rank_test", "One table entry an edge", "beyond the paper",
                        "The Rank Test in the Summed Height Test's place: the error at equal triangles, and a bound that holds.",
                        measure)
