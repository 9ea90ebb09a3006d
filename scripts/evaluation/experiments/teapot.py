"""Figures 11b and 11c: the Utah teapot, and a second map on the result."""
from section import Claim, Experiment, Picture, Section, Table, NOT_REPRODUCED, PARTLY, REPRODUCED

FIRST = {"tests.normal_threshold": 0.2, "tests.view_threshold": 8}
SECOND = {
    "mesh.source": "run", "map.source": "text", "map.text": "tessera", "map.width": 128, "map.height": 64,
    "displacement.scale": 0.05, "tests.normal_threshold": 0.25, "tests.view_threshold": 6,
}


def figures_of(run):
    return [run.figures["host.base_triangles"], run.triangles, run.figures["run.edges_tested"],
            run.figures["host.mesh_bytes"]]


def measure(study):
    section = Section()
    first = study.run("donuts", "teapot", FIRST)
    yield
    second = study.run("second_map", "teapot", {**SECOND, "mesh.file": first.folder})
    yield
    section.pictures = [
        Picture(first.render("shaded"), f"The half donut on every patch: {first.triangles:,} triangles from 992"),
        Picture(first.render("wireframe"), "Its triangles"),
        Picture(second.render("shaded"), f"A second map on the result: {second.triangles:,} triangles"),
        Picture(second.render("wireframe", zoom=(0.45, 0.5, 3)), "Close up"),
    ]
    seams = {run: run.figures["invariants.open_texture_seam_edges"] for run in (first, second)}
    cracks = {run: run.figures["invariants.cracks"] + run.figures["invariants.t_vertices"] for run in (first, second)}
    section.claims = [
        Claim("Any base mesh can be displaced: the half donut on the well-known Utah teapot.", "section 4, figure 11 (b)",
              f"{first.figures['host.base_triangles']} triangles of 32 Bezier patches became {first.triangles:,}: {cracks[first]} cracks and T-vertices. "
              f"{seams[first]} emitted edges are open where the texture coordinates jump between two patches, so that the map is not "
              "continuous across their border",
              NOT_REPRODUCED if cracks[first] else PARTLY if seams[first] else REPRODUCED),
        Claim("The mesh's state can be saved and another displacement added to it.", "section 4, figure 11 (c)",
              f"the {first.triangles:,} displaced triangles, with their normals and texture coordinates, became the base "
              f"mesh of a second map: {second.triangles:,} triangles, {cracks[second]} cracks and T-vertices, "
              f"{seams[second]} open texture seams",
              REPRODUCED if not cracks[second] and second.triangles > first.triangles else NOT_REPRODUCED)]
    section.tables.append(Table("teapot", "Two maps, one on top of the other",
                                [("map", ""), ("base triangles", ""), ("triangles", ""), ("edges tested", ""),
                                 ("base mesh", "byte")],
                                [["half donut", *figures_of(first)], ["text on the result", *figures_of(second)]]))
    section.sources.append("Teapot: M. Newell, 1975")
    return section


EXPERIMENT = Experiment("teapot", "The Utah teapot, twice displaced", "Figures 11b and 11c",
                        "A base mesh of curved patches, and the mesh of one run as the base of the next.", measure)
