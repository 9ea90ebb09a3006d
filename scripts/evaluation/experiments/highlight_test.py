"""Section 5.1: the Highlight Test."""
from section import Claim, Experiment, Picture, Section, Table, REPRODUCED, NOT_REPRODUCED


def study_table(text):
    """The rows of the study's Markdown table, after its heading."""
    rows = [[cell.strip() for cell in line.strip("|\n ").split("|")] for line in text.splitlines() if line.startswith("|")]
    return [[name, *(int(cell) if cell.isdigit() else float(cell) for cell in cells)] for name, *cells in rows[2:]]


def measure(study):
    light = study.highlight_study()
    run = study.run("on", settings={"tests.highlight": True})
    yield
    rows = study_table(light.finished()["output"])
    off, on, equal = rows
    return Section(
        claims=[Claim(
            "Tests on the normals could find the triangles near the Phong highlight and improve per-vertex lighting there.",
            "section 5.1",
            f"at {on[2]:,} triangles the error of per-vertex light in the highlight is {on[4]:.4f} of full scale RMS with the "
            f"Highlight Test, {equal[4]:.4f} with a finer Normal Test ({equal[0]}: {equal[2]:,}), {off[4]:.4f} with "
            f"neither ({off[2]:,})",
            REPRODUCED if on[4] < 0.8 * equal[4] else NOT_REPRODUCED)],
        pictures=[Picture(run.render("wireframe"), f"The half donut with the Highlight Test: {run.triangles:,} triangles"),
                  Picture(run.render("test"), "Triangles by the test that split their parent")],
        tables=[Table("highlight_test", "Per-vertex compared with per-texel specular light, exponent 32",
                      [("Highlight Test", ""), ("Normal Test threshold", ""), ("triangles", ""), ("RMS error", "full scale"),
                       ("RMS error in the highlight", "full scale"), ("largest error", "full scale"),
                       ("density in the highlight", "triangles / texel"), ("density elsewhere", "triangles / texel")], rows)],
        notes=["The paper names the test without a formula; tessera's definition is in golden/ALGORITHM.md, 4.6."])


EXPERIMENT = Experiment("highlight_test", "The Highlight Test", "Section 5.1",
                        "With per-vertex lighting, a highlight needs more triangles than the shape.", measure)
