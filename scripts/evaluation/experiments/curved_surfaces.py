"""Section 2.7: curved surfaces as displacement maps."""
from section import Claim, Experiment, Picture, Section, Table, reproduced_if
from study import ROOT

EXAMPLES = ROOT / "testbench/examples/surfaces"
SURFACES = {"pillow": ("a bicubic Bezier patch over a plane", None),
            "hills": ("a rational B-spline patch over a plane", None),
            "barrel": ("a sphere over a cylinder, along its normals", "barrel_base")}


def measure(study):
    section, rows = Section(), []
    runs = {title: study.bake(name, EXAMPLES / f"{name}.toml", base and EXAMPLES / f"{base}.toml")
            for name, (title, base) in SURFACES.items()}
    yield
    for title, run in runs.items():
        rows.append([title, run.figures["host.base_triangles"], run.triangles,
                     run.error["interpolated.reference_to_mesh_rms_texels"],
                     run.error["interpolated.reference_to_mesh_max_texels"]])
        section.pictures += [Picture(run.render("shaded"), f"{title[0].upper()}{title[1:]}"),
                             Picture(run.render("wireframe"), f"{run.triangles:,} triangles")]
    section.claims.append(Claim(
        "Quadrics, Bezier surfaces and NURBS can be sampled by the host and rendered as displacement maps.", "section 2.7",
        "; ".join(f"{title}: {triangles:,} triangles, RMS {rms:.2f} texels from the baked map's surface" for title, _, triangles, rms, _ in rows),
        reproduced_if(all(row[3] < 1 for row in rows))))
    section.tables.append(Table("curved_surfaces", "Baked surfaces",
                                [("surface", ""), ("base triangles", ""), ("triangles", ""), ("RMS error", "texel"),
                                 ("maximum error", "texel")], rows))
    section.notes.append("As in the paper, a patch's control points contain only heights over the base mesh.")
    return section


EXPERIMENT = Experiment("curved_surfaces", "Curved surfaces as displacement maps", "Section 2.7",
                        "The host samples a surface into a map, which the hardware renders.", measure)
