"""Figure 9: the head from three distances."""
import numpy as np

from emitted_mesh import density_in
from section import Claim, Experiment, Picture, Section, Table, reproduced_if

LICENCE = "'Infinite, 3D Head Scan by Lee Perry-Smith, based on a work at www.triplegangers.com', CC BY 3.0"
CHANGED = "ray-cast to a cylinder as a map of radii; licence: creativecommons.org/licenses/by/3.0"
SOURCE = f"{LICENCE}; {CHANGED}"
EYE, TARGET = np.array([2.57, -10.38, 0.69]), np.array([0.0, 0.0, -0.06])
DISTANCES = (1, 2, 4)
# Positions on the map, as fractions of its width and of its height from the top.
REGIONS = {
    "eyes": ((0.40, 0.47, 0.36, 0.43), (0.525, 0.60, 0.36, 0.43)),
    "nose": ((0.465, 0.53, 0.46, 0.57),),
    "mouth": ((0.45, 0.55, 0.63, 0.70),),
    "cheeks": ((0.365, 0.44, 0.47, 0.57), (0.56, 0.635, 0.47, 0.57)),
    "back of the head": ((0.0, 0.1, 0.2, 0.5), (0.9, 1.0, 0.2, 0.5)),
}


def region(boxes, side=512):
    mask = np.zeros((side, side), bool)
    for left, right, top, bottom in boxes:
        mask[round(top * side):round(bottom * side), round(left * side):round(right * side)] = True
    return mask


def measure(study):
    section = Section(sources=[SOURCE])
    rows, density_rows, triangles = [], [], []
    eyes = {distance: TARGET + distance * (EYE - TARGET) for distance in DISTANCES}
    runs = {distance: study.run(f"distance_{distance}", "head", {"camera.eye": [round(float(x), 4) for x in eye]}, error=True)
            for distance, eye in eyes.items()}
    yield
    for distance, run in runs.items():
        triangles.append(run.triangles)
        rows.append([distance, float(np.linalg.norm(eyes[distance] - TARGET)), run.triangles, run.figures["run.edges_tested"],
                     run.error["interpolated.reference_to_mesh_rms_texels"],
                     run.error["interpolated.reference_to_mesh_max_texels"]])
        density_rows.append([distance, *(density_in(run.mesh, region(boxes)) for boxes in REGIONS.values())])
        section.pictures += [
            Picture(run.render("shaded", f"seen_{distance}", whole_viewport=True),
                    f"From {distance} times the distance, as seen by the camera: {run.triangles:,} triangles. {LICENCE}"),
            Picture(run.render("wireframe", f"close_{distance}", eye=list(EYE), target=list(TARGET),
                               zoom=(0.42, 0.54, 2.0)),
                    "The same mesh close up: eyes, nose and mouth, tessellated for "
                    f"{distance} times the distance. {LICENCE}")]
    section.pictures.append(Picture(runs[DISTANCES[0]].render("generation"),
                                    f"From the first distance, coloured by generation, the number of splits. {LICENCE}"))
    densities = [dict(zip(REGIONS, row[1:])) for row in density_rows]
    features = ("eyes", "nose", "mouth")
    section.claims = [
        Claim("The triangle count falls with the distance from the view plane.", "section 4, figure 9 (a) to (c)",
              "; ".join(f"{n:,} triangles at {d} times the distance" for d, n in zip(DISTANCES, triangles)),
              reproduced_if(triangles[0] > triangles[1] > triangles[2])),
        Claim("There is more detail around the nose, eyes and mouth.", "section 4, figure 9 (d) to (f)",
              "triangles per area of the map, relative to the cheeks: " + "; ".join(
                  f"at {distance} times the distance " + ", ".join(f"{name} {found[name] / found['cheeks']:.1f}" for name in features)
                  for distance, found in zip(DISTANCES, densities)),
              reproduced_if(all(found[name] > 1.5 * found["cheeks"] for found in densities for name in features))),
    ]
    section.tables = [
        Table("view_distances", "Three distances", [("distance", "times"), ("eye to target", "model units"),
                                                    ("triangles", ""), ("edges tested", ""), ("RMS error", "texel"),
                                                    ("maximum error", "texel")], rows),
        Table("head_density", "Triangles per area of the map (the whole map = 1)",
              [("distance", "times"), *((name, "") for name in REGIONS)], density_rows)]
    section.notes.append("The paper's head is not public; this is a different head, "
                         "on 32 x 32 quads, which divide its map's 512 texels, instead of 30 x 30.")
    return section


EXPERIMENT = Experiment("view_distances", "A head from three distances", "Figure 9",
                        "The farther the viewer, the fewer triangles; they are concentrated where the face has detail.",
                        measure)
