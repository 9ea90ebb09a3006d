"""Figure 1: text on a plane."""
import numpy as np

from section import Claim, Experiment, Picture, Section, Table, reproduced_if

SETTINGS = {
    "mesh.width": 4, "mesh.depth": 1, "mesh.columns": 32, "mesh.rows": 8,
    "map.source": "text", "map.text": "tessera", "map.width": 1024, "map.height": 256,
    "displacement.scale": 0.18,
    "camera.eye": [0.7, -3.1, 2.3], "camera.target": [0, 0.02, 0.05], "camera.field_of_view": 50,
    "tests.normal_threshold": 0.3, "tests.summed_height_threshold": 1, "tests.view_threshold": 5,
}


def seen(points):
    """Projects onto the image plane of SETTINGS' camera, up to scale."""
    eye, target = np.array(SETTINGS["camera.eye"]), np.array(SETTINGS["camera.target"])
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, (0, 0, 1))
    right /= np.linalg.norm(right)
    relative = points - eye
    depth = relative @ forward
    return np.stack([relative @ right / depth, relative @ np.cross(right, forward) / depth], axis=1)


def beyond_the_plane(positions):
    """Fraction of vertices that appear outside the outline of the flat plane."""
    x, y = SETTINGS["mesh.width"] / 2, SETTINGS["mesh.depth"] / 2
    outline = seen(np.array([(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)], float))
    points = seen(positions)
    inside = np.ones(len(points), bool)
    for a, b in zip(outline, np.roll(outline, -1, axis=0)):
        inside &= (b - a)[0] * (points - a)[:, 1] - (b - a)[1] * (points - a)[:, 0] >= -1e-6
    return float((~inside).mean())


def measure(study):
    run = study.run("text", settings=SETTINGS, error=True)
    yield
    size = f"{study.picture_width}x{study.picture_width * 46 // 100}"
    outside = beyond_the_plane(run.mesh.positions)
    rms = run.error["interpolated.reference_to_mesh_rms_texels"]
    return Section(
        claims=[Claim(
            "Displaced triangles are geometry: they rise above the plane and change its silhouette, which bump mapping cannot do.",
            "section 1, figure 1",
            f"{run.figures['host.base_triangles']} flat triangles became {run.triangles:,}; {100 * outside:.1f} % "
            f"of the vertices appear outside the flat plane's outline; the RMS distance from the exact surface is {rms:.2f} texels.",
            reproduced_if(outside > 0.005 and rms < 1))],
        pictures=[Picture(run.render("shaded", size=size), "The displaced surface"),
                  Picture(run.render("wireframe", size=size), "Its triangles: the letters' flat tops and the plane stay coarse")],
        tables=[Table("text_plane", "The run", [("base triangles", ""), ("triangles", ""), ("edges tested", ""),
                                                ("RMS error", "texel"), ("maximum error", "texel")],
                      [[run.figures["host.base_triangles"], run.triangles, run.figures["run.edges_tested"], rms,
                        run.error["interpolated.reference_to_mesh_max_texels"]]])])


EXPERIMENT = Experiment("text_plane", "Text on a plane", "Figure 1",
                        "A height map of letters on a plane of 512 triangles becomes real geometry.", measure)
