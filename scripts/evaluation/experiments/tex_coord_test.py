"""Section 2.5: the triangles that the Tex Coord Test saves."""
from section import Claim, Experiment, Picture, Section, Table, NOT_REPRODUCED, PARTLY, REPRODUCED
from .view_distances import LICENCE, SOURCE

NOISE = {
    "map.source": "noise", "map.width": 64, "map.height": 64, "displacement.scale": 0.04,
    "mesh.columns": 6, "mesh.rows": 6, "tests.normal_threshold": 0.05, "tests.summed_height_threshold": 0.5,
}
VIEW_THRESHOLDS = (8, 12, 16)  # pixels; a texel of the noise is 16 to 24 pixels long
SHOWN = 12
HEAD = {"tests.view_threshold": 3}


def measure(study):
    section, rows, savings = Section(sources=[SOURCE]), [], {}
    cases = [("noise", None, {**NOISE, "tests.view_threshold": threshold}) for threshold in VIEW_THRESHOLDS]
    cases.append(("head", "head", HEAD))
    both = {(name, settings["tests.view_threshold"]): {
        state: study.run(f"{name}_{settings['tests.view_threshold']}_{state}", job,
                         {**settings, "tests.tex_coord": state == "on"}, error=True) for state in ("on", "off")}
            for name, job, settings in cases}
    yield
    for (name, threshold), runs in both.items():
        savings[name, threshold] = 1 - runs["on"].triangles / runs["off"].triangles
        for state, run in runs.items():
            rows.append([name, threshold, state, run.triangles, run.figures["run.edges_tested"],
                         run.error["interpolated.reference_to_mesh_rms_texels"],
                         run.error["nearest_texel.reference_to_mesh_rms_texels"],
                         run.figures["pass_or_tessellate.stopped_by_tex_coord"],
                         run.figures["pass_or_tessellate.stopped_by_generation"]])
            if threshold == SHOWN or name == "head":
                zoom, source = ((0.45, 0.4, 4), f". {LICENCE}") if name == "head" else ((0.5, 0.6, 3), "")
                section.pictures.append(Picture(
                    run.render("wireframe", zoom=zoom),
                    f"{name.capitalize()}, Tex Coord Test {state}: {run.triangles:,} triangles{source}"))
    of_noise = [saving for (name, _), saving in savings.items() if name == "noise"]
    section.claims.append(Claim(
        "On noisy maps such as hair the Tex Coord Test alone can halve the number of triangles.", "section 2.5",
        "; ".join(f"{name}, View Test threshold {threshold} pixels: {100 * saving:.0f} % fewer triangles"
                  for (name, threshold), saving in savings.items())
        + ". The finer the View Test, the more triangles the test saves; it omits the steps between texels. Without it, many edges "
        "are stopped by the Generation Test, which is not in the paper (see the table).",
        REPRODUCED if min(of_noise) >= 0.5 else PARTLY if max(of_noise) >= 0.5 else NOT_REPRODUCED))
    section.tables.append(Table(
        "tex_coord_test", "With and without the Tex Coord Test",
        [("map", ""), ("View Test threshold", "pixel"), ("Tex Coord Test", ""), ("triangles", ""), ("edges tested", ""),
         ("RMS, map interpolated", "texel"), ("RMS, nearest texel", "texel"), ("edges it stopped", ""),
         ("edges the Generation Test stopped", "")], rows))
    return section


EXPERIMENT = Experiment("tex_coord_test", "The Tex Coord Test on noise and on the head", "Section 2.5",
                        "No edge is split below the map's resolution, where only steps between texels remain.", measure)
