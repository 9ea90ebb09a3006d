"""Section 5.1: displacement scale changing from frame to frame."""
import csv

from section import NOT_REPRODUCED, PARTLY, REPRODUCED, Claim, Experiment, Picture, Section, Table, reproduced_if

FRAMES = 5
SCALE = 0.25  # of the last frame
FINE = {"tests.view_threshold": 1, "tests.normal_threshold": 0.05}
# Runs for comparing the host's traffic: name, and the difference from the first.
CASES = {
    "S grows from 0": {},
    "S constant, only the camera moves": {"frames.first_scale": SCALE},
    "S grows, finer thresholds": FINE,
    "S grows, map of 64 x 64": {"map.width": 64, "map.height": 64},
    "S grows, map of 64 x 64, finer thresholds": {"map.width": 64, "map.height": 64, **FINE},
}


def traffic(runs):
    """One row per case: bytes sent for the frames, and bytes of the tessellated meshes."""
    rows = []
    for title, run in runs.items():
        frames = read_frames(run)
        sent = [int(frame["sent_bytes"]) for frame in frames]
        meshes = [int(frame["tessellated_mesh_bytes"]) for frame in frames]
        texels = int(frames[0]["displacement_map_bytes"]) // 2
        rows.append([title, texels, int(frames[-1]["triangles"]), sent[0], sent[-1], meshes[-1], sum(sent), sum(meshes),
                     sum(sent) / sum(meshes)])
    return rows


def read_frames(run):
    run.finished()
    with open(run.folder / "frames.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def less(rows):
    return [row[0] for row in rows if row[-1] < 1]


def measure(study):
    section = Section()
    runs = {title: study.run(f"traffic_{number}", settings={
        "frames.count": FRAMES, "frames.first_scale": 0, "displacement.scale": SCALE, **settings})
            for number, (title, settings) in enumerate(CASES.items())}
    yield
    run = next(iter(runs.values()))
    frames = read_frames(run)
    rows = [[float(frame["displacement_scale"]),
             *(int(frame[name]) for name in ("triangles", "edges_tested", "base_mesh_bytes", "displacement_map_bytes",
                                             "normal_map_bytes", "summed_height_table_bytes", "register_bytes",
                                             "sent_bytes", "tessellated_mesh_bytes"))] for frame in frames]
    for frame in (frames[1], frames[-1]):
        section.pictures.append(Picture(run.render("wireframe", part=frame["frame"]),
                                        f"S = {float(frame['displacement_scale']):g}: {int(frame['triangles']):,} triangles"))
    first, later = rows[0], rows[-1]
    section.claims = [Claim(
        "The displacement can be scaled; the normal map is recomputed for each scale.", "section 5.1",
        f"the host sends {first[-2]:,} bytes for the first frame and {later[-2]:,} for a later one, {later[5]:,} of them the "
        f"normal map; the displacement map and the Summed Height Table are not sent again. The last frame's tessellated mesh would be "
        f"{later[-1]:,} bytes.",
        reproduced_if(later[4] == 0 and later[6] == 0 and later[5] > 0 and later[1] > first[1]))]
    cases = traffic(runs)
    section.claims.append(Claim(
        "Displacement mapping as a primitive can significantly reduce the bottleneck of sending triangle data.", "section 5",
        f"over {FRAMES} frames the host sends " + "; ".join(f"{row[-1]:.2f} times the tessellated meshes' bytes ({row[0]})"
                                                           for row in cases) + ".",
        REPRODUCED if len(less(cases)) == len(cases) else PARTLY if less(cases) else NOT_REPRODUCED))
    section.notes += [
        "Let B be the bytes of the base mesh, N of the normal map, T of all tables, M of an indexed tessellated mesh. With a "
        "constant S, n frames cost T + n B against n M: the host sends less for n > T / (M - B) frames. If S changes in every "
        "frame the normal map is sent each time, and n frames cost T - N + n (B + N): less only if M > B + N, for "
        "n > (T - N) / (M - B - N) frames. With 6 bytes of normal map per texel and about 24 bytes per triangle this requires "
        "more than one triangle per four texels, for any number of frames.",
        "The host sends less in these cases: " + "; ".join(less(cases)) + "." if less(cases) else
        "The host does not send less in any of these cases.",
        "The Summed Height Test compares heights of the map, independently of the scale: with S = 0 it still splits."]
    section.tables.append(Table(
        "host_traffic", f"Bytes that the host sends for {FRAMES} frames of the half donut, and bytes of the tessellated meshes",
        [("frames", ""), ("texels", ""), ("triangles, last frame", ""), ("first frame", "byte"), ("a later one", "byte"),
         ("its mesh, tessellated", "byte"), ("all frames", "byte"), ("all meshes", "byte"), ("sent / meshes", "")], cases))
    section.tables.append(Table(
        "displacement_scale", f"{FRAMES} frames of the half donut",
        [("scale S", "model units"), ("triangles", ""), ("edges tested", ""), ("base mesh", "byte"),
         ("displacement map", "byte"), ("normal map", "byte"), ("Summed Height Table", "byte"), ("registers", "byte"),
         ("sent", "byte"), ("tessellated mesh instead", "byte")], rows))
    return section


EXPERIMENT = Experiment("displacement_scale", "The displacement scale between frames", "Section 5.1",
                        "The host's traffic when S changes.", measure)
