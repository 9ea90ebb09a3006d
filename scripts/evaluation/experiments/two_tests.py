"""Figure 10: the Normal Test, the Summed Height Test, and both, at equal numbers of triangles."""
from emitted_mesh import density_in
from section import Claim, Experiment, Picture, Section, Table, REPRODUCED, PARTLY, NOT_REPRODUCED
import numpy as np

BUDGETS = (1000, 3000, 10000)
SHOWN = 1000
TESTS = {"Normal Test alone": "normal", "Summed Height Test alone": "summed_height", "both": "normal,summed_height"}
RMS, MAXIMUM = "vertical.rms", "vertical.max"


def on_the_donut(side=512):
    """The half donut's region of the built-in map: the ring and its foot."""
    x, y = np.meshgrid((np.arange(side) + 0.5) / side * 2 - 1, (np.arange(side) + 0.5) / side * 2 - 1)
    return np.abs(np.hypot(x, y) - 0.55) < 0.30


def only(tests):
    return {f"tests.{name}": name in tests.split(",") for name in ("normal", "summed_height")}


def verdict(runs, alone):
    """Whether the RMS is worse than with both tests at every budget, at some budgets or at none, by more than the
    search's tolerance."""
    worse = sum(runs[alone, budget].error[RMS] > 1.05 * runs["both", budget].error[RMS] for budget in BUDGETS)
    return REPRODUCED if worse == len(BUDGETS) else PARTLY if worse else NOT_REPRODUCED


def row_of(title, run, ring):
    texel = run.error["measurement.texel"]
    return [title, run.triangles, run.error[RMS] / texel, run.error[MAXIMUM] / texel,
            run.error["interpolated.reference_to_mesh_rms_texels"], density_in(run.mesh, ring), density_in(run.mesh, ~ring)]


def thresholds_of(run):
    tests = run.tuned["tests"]
    return [tests["normal_threshold"] if tests["normal"] else "off",
            tests["summed_height_threshold"] if tests["summed_height"] else "off", tests["generation_limit"]]


COLUMNS = [("tests", ""), ("triangles", ""), ("RMS vertical error", "texel"), ("maximum vertical error", "texel"),
           ("RMS distance", "texel"), ("density on the donut", "triangles / map"), ("density beside it", "triangles / map")]


def measure(study):
    section, ring = Section(), on_the_donut()
    runs = {(title, budget): study.tune(f"{tests.replace(',', '_')}_{budget}", budget, None, tests,
                                        {"tests.view": False, **only(tests)})
            for budget in BUDGETS for title, tests in TESTS.items()}
    switched = {title: study.run(f"switched_{tests.replace(',', '_')}", settings={"tests.view": False, **only(tests)}, error=True)
                for title, tests in TESTS.items()}
    yield
    scale = runs["both", SHOWN].error["interpolated.reference_to_mesh_max"]
    for title in TESTS:
        run = runs[title, SHOWN]
        section.pictures += [
            Picture(run.render("wireframe"), f"{title}: {run.triangles:,} triangles"),
            Picture(run.render("error", error_scale=scale), f"{title}: distance from the exact surface, same scale for all three")]
    both = runs["both", SHOWN]
    meshes = {f"{budget:,} triangles": runs["both", budget].mesh for budget in BUDGETS}
    meshes["the default thresholds"] = switched["both"].mesh
    quotients = {name: density_in(mesh, ring) / max(density_in(mesh, ~ring), 1) for name, mesh in meshes.items()}

    def against(title):
        texel = both.error["measurement.texel"]
        return ("vertical error at equal triangles, each tuned, in texels: " + "; ".join(
            f"{runs[title, budget].triangles:,} and {runs['both', budget].triangles:,} triangles: RMS {runs[title, budget].error[RMS] / texel:.3f} alone, "
            f"{runs['both', budget].error[RMS] / texel:.3f} with both, "
            f"maximum {runs[title, budget].error[MAXIMUM] / texel:.2f} and {runs['both', budget].error[MAXIMUM] / texel:.2f}"
            for budget in BUDGETS))

    section.claims = [
        Claim("The Normal Test alone shows aliasing errors.", "section 4, figure 10 (a)", against("Normal Test alone"),
              verdict(runs, "Normal Test alone")),
        Claim("The Summed Height Test alone misses local changes of the surface's orientation.",
              "section 4, figure 10 (b)", against("Summed Height Test alone"), verdict(runs, "Summed Height Test alone")),
        Claim("Detail appears where the map has it.", "section 4, figure 10 (c)",
              "triangles per area of the map, on the donut relative to beside it: "
              + "; ".join(f"{quotient:.1f} with {name}" for name, quotient in quotients.items()),
              REPRODUCED if min(quotients.values()) > 2 else PARTLY if max(quotients.values()) > 2 else NOT_REPRODUCED)]
    section.notes.append("A test with a threshold that is never exceeded is switched off: after tuning, both tests together are at least as "
                         "good as the better one alone. If the errors are equal, one test made all splits. RMS differences below 5 % are ignored.")
    section.tables = [
        Table("two_tests", "Thresholds tuned for a number of triangles, least RMS vertical error",
              [*COLUMNS, ("Normal Test threshold", ""), ("Summed Height Test threshold", ""), ("generation limit", "")],
              [[*row_of(title, runs[title, budget], ring), *thresholds_of(runs[title, budget])]
               for budget in BUDGETS for title in TESTS]),
        Table("two_tests_switched", "The default job's thresholds, one test switched off, without the View Test",
              COLUMNS, [row_of(title, run, ring) for title, run in switched.items()])]
    return section


EXPERIMENT = Experiment("two_tests", "Normal Test, Summed Height Test, both", "Figures 5 and 10",
                        "Half a donut on 18 triangles: the meshes of each test alone, and of both together.", measure)
