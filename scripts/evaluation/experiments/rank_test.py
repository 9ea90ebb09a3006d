"""One table entry an edge: the Rank Test, and its bound on the largest error, on Crater Lake."""
from experiments.crater_lake import BUDGETS, GRIDS, MAXIMUM, OTHER_METHODS, RMS, at_equal_triangles, reference_curves
from section import Chart, Claim, Experiment, Picture, Section, Table, reproduced_if
import charts

JOB = "crater_lake_rank"
FULL_SCALE = 945  # m, of the map's range
# full scale times the root of a texel: about 600 to 20,000 triangles
RANKS = (0.28, 0.16, 0.0885, 0.0505, 0.0285, 0.0158, 0.0085)
BOUNDS = (0.08, 0.055, 0.04, 0.028, 0.02, 0.014, 0.01)  # full scale
SHOWN = 0.0285
BIT_WIDTHS = (6, 8, 12, 16)


def with_bounds(bound, bits=16):
    return {"formats.rank_bits": 0, "formats.bound_bits": bits, "tests.bound_threshold": bound}


def measure(study):
    ranks = {(rank, bits): study.run(f"rank_{rank}_{bits}", JOB, {"tests.rank_threshold": rank, "formats.rank_bits": bits}, error=True)
             for rank in RANKS for bits in BIT_WIDTHS}
    bounds = {bound: study.run(f"bound_{bound}", JOB, with_bounds(bound), error=True) for bound in BOUNDS}
    widths = {bits: study.run(f"bound_of_{bits}", JOB, with_bounds(0.02, bits), error=True) for bits in BIT_WIDTHS}
    timed = {(test, design): study.run(f"{test}_{design}", JOB, {
        "mode": "timed", "hardware.design": design, **({"tests.rank_threshold": SHOWN} if test == "rank" else with_bounds(0.02))})
        for test in ("rank", "bound") for design in ("paper", "modern")}
    papers = {budget: study.tune(f"budget_{budget}", budget, "crater_lake_704", settings={"tests.view": False}, grid=GRIDS)
              for budget in BUDGETS}
    yield
    section = Section()
    references = reference_curves(OTHER_METHODS)
    for column, figure, name in ((1, RMS, "RMS"), (2, MAXIMUM, "maximum")):
        series = {"Rank Test": curve([ranks[rank, 12] for rank in RANKS], figure),
                  "Bound Test": curve(bounds.values(), figure),
                  "the paper's tests, tuned": curve(papers.values(), figure)}
        series.update({method: ([point[0] for point in points if 600 <= point[0] <= 20000],
                                [point[column] for point in points if 600 <= point[0] <= 20000])
                       for method, points in references.items() if method in ("rtin", "terra")})
        section.charts.append(Chart(charts.lines(series, "triangles", f"{name} vertical error, m", True, True, ("Rank Test",)),
                                    f"{name} vertical error at every grid point; the Rank Test from 24 base triangles"))
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
        Table("rank_cycles", "Cycles and reads",
              [("test", ""), ("design", ""), ("triangles", ""), ("cycles per triangle", ""), ("table reads per triangle", "")],
              [[test, design, run.triangles, run.figures["timing.cycles"] / run.triangles,
                run.figures["rank_table.reads"] / run.triangles] for (test, design), run in timed.items()])]
    return section


def curve(runs, figure):
    runs = list(runs)
    return [run.triangles for run in runs], [run.error[figure] for run in runs]


EXPERIMENT = Experiment("rank_test", "One table entry an edge", "beyond the paper",
                        "The Rank Test in the Summed Height Test's place: the error at equal triangles, and a bound that holds.",
                        measure)
