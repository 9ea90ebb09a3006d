"""Figure 10: the Normal Test, the Summed Height Test, and both, at equal numbers of triangles."""
from emitted_mesh import density_in
from section import Claim, Experiment, Picture, Section, Table, REPRODUCED, PARTLY, NOT_REPRODUCED
import numpy as np

BUDGET = 3000
TESTS = {"Normal Test alone": "normal", "Summed Height Test alone": "summed_height", "both": "normal,summed_height"}


def on_the_donut(side=512):
    """The built-in map's ring: where the half donut is."""
    x, y = np.meshgrid((np.arange(side) + 0.5) / side * 2 - 1, (np.arange(side) + 0.5) / side * 2 - 1)
    return np.abs(np.hypot(x, y) - 0.55) < 0.25


def only(tests):
    return {f"tests.{name}": name in tests.split(",") for name in ("normal", "summed_height")}


def verdict(alone, both):
    if alone["maximum"] > both["maximum"] and alone["rms"] > both["rms"]:
        return REPRODUCED
    return PARTLY if alone["maximum"] > both["maximum"] or alone["rms"] > both["rms"] else NOT_REPRODUCED


def measure(study):
    section, rows, errors = Section(), [], {}
    ring = on_the_donut()
    runs = {}
    for title, tests in TESTS.items():
        run = runs[title] = study.tune(tests.replace(",", "_"), BUDGET, None, tests, {"tests.view": False, **only(tests)})
        errors[title] = {"rms": run.error["interpolated.reference_to_mesh_rms_texels"],
                         "maximum": run.error["interpolated.reference_to_mesh_max_texels"]}
        rows.append([title, run.triangles, *errors[title].values(), density_in(run.mesh, ring), density_in(run.mesh, ~ring)])
    scale = runs["both"].error["interpolated.reference_to_mesh_max"]
    for title, run in runs.items():
        section.pictures += [
            Picture(run.render("wireframe"), f"{title}: {run.triangles:,} triangles"),
            Picture(run.render("error", error_scale=scale),
                    f"{title}: distance from the exact surface, RMS {errors[title]['rms']:.2f} texels (one scale for all three)")]
    both, normal, height = (errors[title] for title in ("both", "Normal Test alone", "Summed Height Test alone"))

    def against(alone):
        return (f"at {BUDGET:,} triangles, each tuned: RMS {alone['rms']:.3f} texels against {both['rms']:.3f} with both, "
                f"maximum {alone['maximum']:.2f} against {both['maximum']:.2f}")

    section.claims = [
        Claim("The Normal Test alone shows aliasing errors.", "section 4, figure 10 (a)", against(normal),
              verdict(normal, both)),
        Claim("The Summed Height Test alone misses local changes of the surface's orientation.",
              "section 4, figure 10 (b)", against(height), verdict(height, both)),
        Claim("Detail appears where the map has it.", "section 4, figure 10 (c)",
              f"triangles per area of the map: {rows[2][4] / max(rows[2][5], 1):.1f} times as many on the donut as beside it",
              REPRODUCED if rows[2][4] > 2 * rows[2][5] else NOT_REPRODUCED)]
    section.tables.append(Table("two_tests", f"Thresholds tuned for {BUDGET:,} triangles",
                                [("tests", ""), ("triangles", ""), ("RMS error", "texel"), ("maximum error", "texel"),
                                 ("density on the donut", "triangles / map"), ("density beside it", "triangles / map")],
                                rows))
    return section


EXPERIMENT = Experiment("two_tests", "Normal Test, Summed Height Test, both", "Figures 5 and 10",
                        "Half a donut on 18 triangles: each test has its weakness, together they find the shape.", measure)
