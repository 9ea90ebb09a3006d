"""Section 5.1: the Highlight Test."""
from emitted_mesh import density_in
from matplotlib.tri import LinearTriInterpolator, Triangulation
import numpy as np
from section import Claim, Experiment, Picture, Section, Table, REPRODUCED, NOT_REPRODUCED

EXPONENT = 32
SETTINGS = {"off": {}, "on": {"tests.highlight": True}, "off, same number of triangles": {"tests.normal_threshold": 0.1033}}
# A vertex at the centre of each texel, with the displaced normal there; nothing splits.
TEXELS = {"mesh.source": "lattice", "mesh.spacing": 1, "displacement.scale": 0.25, "tests.normal_threshold": 2,
          "tests.summed_height_threshold": 1e6}


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def measure(study):
    texels = study.run("texels", settings=TEXELS)
    runs = [study.run(name, settings=settings) for name, settings in zip(("off", "on", "equal"), SETTINGS.values())]
    yield
    off, on, equal = runs
    job, map_size = on.job, [on.job["map"][side] for side in ("width", "height")]
    eye, target = (np.array(job["camera"][name]) for name in ("eye", "target"))
    half = unit(unit(np.array(job["hardware"]["light"])) + unit(eye - target))

    def cosines(mesh):
        return np.maximum(unit(mesh.normals) @ half, 0)

    s, t = texels.mesh.texture.T
    own = cosines(texels.mesh)
    in_highlight = own > np.cos(np.radians(job["tests"]["highlight_angle"]))
    region = np.zeros(map_size[::-1], bool)  # the map's top row first
    region[((1 - t) * map_size[1]).astype(int), (s * map_size[0]).astype(int)] = in_highlight

    def row_of(name, run):
        mesh = run.mesh
        lit = LinearTriInterpolator(Triangulation(*mesh.texture.T, mesh.triangles), cosines(mesh)**EXPONENT)(s, t)
        error = np.asarray(lit) - own**EXPONENT
        return [name, run.job["tests"]["normal_threshold"], run.triangles, float(np.sqrt((error**2).mean())),
                float(np.sqrt((error[in_highlight]**2).mean())), float(np.abs(error).max()),
                density_in(mesh, region) / region.size, density_in(mesh, ~region) / region.size]

    rows = [row_of(name, run) for name, run in zip(SETTINGS, runs)]
    errors = [row[4] for row in rows]
    return Section(
        claims=[Claim(
            "Tests on the normals could find the triangles near the Phong highlight and improve per-vertex lighting there.",
            "section 5.1",
            f"at {on.triangles:,} triangles the error of per-vertex light in the highlight is {errors[1]:.4f} of full scale RMS "
            f"with the Highlight Test, {errors[2]:.4f} with a finer Normal Test ({equal.triangles:,}), {errors[0]:.4f} with "
            f"neither ({off.triangles:,})",
            REPRODUCED if errors[1] < 0.8 * errors[2] else NOT_REPRODUCED)],
        pictures=[Picture(on.render("wireframe"), f"The half donut with the Highlight Test: {on.triangles:,} triangles"),
                  Picture(on.render("test"), "Triangles by the test that split their parent")],
        tables=[Table("highlight_test", f"Per-vertex compared with per-texel specular light, exponent {EXPONENT}",
                      [("Highlight Test", ""), ("Normal Test threshold", ""), ("triangles", ""), ("RMS error", "full scale"),
                       ("RMS error in the highlight", "full scale"), ("largest error", "full scale"),
                       ("density in the highlight", "triangles / texel"), ("density elsewhere", "triangles / texel")], rows)],
        notes=["The paper names the test without a formula; tessera's definition is in golden/ALGORITHM.md, 4.6."])


EXPERIMENT = Experiment("highlight_test", "The Highlight Test", "Section 5.1",
                        "With per-vertex lighting, a highlight needs more triangles than the shape.", measure)
