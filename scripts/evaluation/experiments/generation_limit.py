"""The fifth test, which is not in the paper: results without it."""
from section import Experiment, Claim, Section, Table, Chart, reproduced_if
import charts

LIMITS = (2, 4, 6, 8, 10, 12, 15)
TRIANGLES = 400_000
STOPPED = 4  # exit code
SETTINGS = {"tests.view": False, "tests.normal_threshold": 0.1, "tests.summed_height_threshold": 1}
UNLIMITED = {"tests.generation": False, "limits.triangles": TRIANGLES, "check.invariants": False, "check.golden": False}


def measure(study):
    section, rows = Section(), []
    runs = {limit: study.run(f"limit_{limit}", settings={**SETTINGS, "tests.generation_limit": limit}, error=True)
            for limit in LIMITS}
    unlimited = study.run("limit_none", settings={**SETTINGS, **UNLIMITED}, keep=False)
    yield
    for limit, run in runs.items():
        rows.append([str(limit), run.triangles, run.figures["run.edges_tested"],
                     run.error["interpolated.reference_to_mesh_rms_texels"],
                     run.error["interpolated.reference_to_mesh_max_texels"], int((run.mesh.smallest_angles() < 1).sum())])
    ended = unlimited.result["exit_code"] != STOPPED
    section.claims.append(Claim(
        "The Tex Coord Test stops the recursive subdivision at the map's resolution.", "section 2.5",
        (f"without the Generation Test the half donut ends with {unlimited.triangles:,} triangles" if ended else
         f"without the Generation Test the half donut exceeds {TRIANGLES:,} triangles and is stopped")
        + f"; with it, {rows[-2][1]:,} at the default limit of 12. Midpoints that advance along a long edge pass the Tex "
        "Coord Test long after the triangle is smaller than a texel. The fifth test also depends on the edge alone, and ends every recursion.",
        reproduced_if(ended and unlimited.triangles < 2 * rows[-2][1])))
    section.charts.append(Chart(
        charts.lines({"half donut": ([row[1] for row in rows], [row[3] for row in rows])},
                     "triangles", "RMS error, texels", log_x=True, log_y=True),
        "Error against triangles for generation limits from 2 to 15"))
    section.tables.append(Table("generation_limit", "Generation limits, without the View Test",
                                [("limit", ""), ("triangles", ""), ("edges tested", ""), ("RMS error", "texel"),
                                 ("maximum error", "texel"), ("triangles with an angle below 1 degree", "")], rows))
    return section


EXPERIMENT = Experiment("generation_limit", "The Generation Test", "tessera's addition",
                        "A fifth test, which depends on the edge alone, bounds the depth of the recursion.", measure)
