"""Section 5.1: the displacement scaled from frame to frame."""
import csv

from section import Claim, Experiment, Picture, Section, Table, reproduced_if
from study import Run

FRAMES = 5


def measure(study):
    section = Section()
    study.run("frames", settings={"frames.count": FRAMES, "frames.first_scale": 0})
    with open(study.folder / "frames/frames.csv", encoding="utf-8", newline="") as file:
        frames = list(csv.DictReader(file))
    rows = [[float(frame["displacement_scale"]),
             *(int(frame[name]) for name in ("triangles", "edges_tested", "base_mesh_bytes", "displacement_map_bytes",
                                             "normal_map_bytes", "summed_height_table_bytes", "register_bytes",
                                             "sent_bytes", "tessellated_mesh_bytes"))] for frame in frames]
    for frame in (frames[1], frames[-1]):
        run = Run(study, study.folder / "frames" / frame["frame"])
        section.pictures.append(Picture(run.render("wireframe"),
                                        f"S = {float(frame['displacement_scale']):g}: {run.triangles:,} triangles"))
    first, later = rows[0], rows[-1]
    section.claims = [Claim(
        "The displacement can be scaled; the normal map is computed anew for each scale.", "section 5.1",
        f"the host sends {first[-2]:,} bytes for the first frame and {later[-2]:,} for a later one, {later[5]:,} of them the "
        f"normal map; the displacement map and the Summed Height Table stay. Sent whole, the last frame's mesh would be "
        f"{later[-1]:,} bytes.",
        reproduced_if(later[4] == 0 and later[6] == 0 and later[5] > 0 and later[1] > first[1]))]
    if later[-2] > later[-1]:
        section.notes.append("A new scale every frame costs more bytes than the tessellated mesh itself: the normal map is what "
                             "an animated scale pays for. The Summed Height Test compares heights of the map, whatever the scale: "
                             "with S = 0 it still splits.")
    section.tables.append(Table(
        "displacement_scale", f"{FRAMES} frames of the half donut",
        [("scale S", "model units"), ("triangles", ""), ("edges tested", ""), ("base mesh", "byte"),
         ("displacement map", "byte"), ("normal map", "byte"), ("Summed Height Table", "byte"), ("registers", "byte"),
         ("sent", "byte"), ("tessellated mesh instead", "byte")], rows))
    return section


EXPERIMENT = Experiment("displacement_scale", "The displacement's scale between frames", "Section 5.1",
                        "What changes for the host when S does.", measure)
