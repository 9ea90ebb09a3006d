"""Section 5.1: displacement scale changing from frame to frame."""
from section import NOT_REPRODUCED, PARTLY, REPRODUCED, Claim, Experiment, Picture, Section, Table, reproduced_if

SCALES = [0, 0.0625, 0.125, 0.1875, 0.25]  # of the frames
CAMERA = {"camera.eye": [1.06953, -2.9385, 2.56815], "camera.target": [0, 0, 0.125]}  # the last frame's own
FINE = {"tests.view_threshold": 1, "tests.normal_threshold": 0.05}
# Frames for comparing the host's traffic: name, scales, other settings.
CASES = {
    "S grows from 0": (SCALES, {}),
    "S constant, only the camera moves": (SCALES[-1:] * len(SCALES), {}),
    "S grows, finer thresholds": (SCALES, FINE),
    "S grows, map of 64 x 64": (SCALES, {"map.width": 64, "map.height": 64}),
    "S grows, map of 64 x 64, finer thresholds": (SCALES, {"map.width": 64, "map.height": 64, **FINE}),
}


class Frame:
    """What the host sends for a run's frame after another, in bytes. The machine keeps the tables; a normal map is for one S.
    Registers are counted whole, though few change."""
    def __init__(self, scale, run, before):
        self.scale, self.run, figures = scale, run, run.figures
        self.triangles, self.edges = figures["run.triangles_finished"], figures["run.edges_tested"]
        self.base, self.registers = figures["host.mesh_bytes"], figures["host.register_bytes"]
        self.texels = figures["displacement_map.size"] // figures["displacement_map.entry"]
        self.displacement_map, self.summed_height_table = (
            0 if before else figures[f"{table}.size"] for table in ("displacement_map", "summed_height_table"))
        self.normal_map = 0 if before and before.scale == scale else figures["normal_map.size"]
        self.mesh = figures["host.tessellated_mesh_bytes"]

    @property
    def sent(self):
        return self.base + self.registers + self.displacement_map + self.normal_map + self.summed_height_table


def frames_of(scales, runs):
    frames = []
    for scale in scales:
        frames.append(Frame(scale, runs[scale], frames[-1] if frames else None))
    return frames


def less(rows):
    return [row[0] for row in rows if row[-1] < 1]


def measure(study):
    section = Section()
    runs = {title: {scale: study.run(f"traffic_{number}_{scale:g}", settings={"displacement.scale": scale, **CAMERA, **settings})
                    for scale in dict.fromkeys(scales)}
            for number, (title, (scales, settings)) in enumerate(CASES.items())}
    yield
    cases = []
    for title, (scales, _) in CASES.items():
        frames = frames_of(scales, runs[title])
        sent, meshes = sum(frame.sent for frame in frames), sum(frame.mesh for frame in frames)
        cases.append([title, frames[0].texels, frames[-1].triangles, frames[0].sent, frames[-1].sent, frames[-1].mesh, sent,
                      meshes, sent / meshes])
    frames = frames_of(SCALES, next(iter(runs.values())))
    rows = [[frame.scale, frame.triangles, frame.edges, frame.base, frame.displacement_map, frame.normal_map,
             frame.summed_height_table, frame.registers, frame.sent, frame.mesh] for frame in frames]
    for frame in (frames[1], frames[-1]):
        section.pictures.append(Picture(frame.run.render("wireframe"), f"S = {frame.scale:g}: {frame.triangles:,} triangles"))
    first, later = rows[0], rows[-1]
    section.claims = [Claim(
        "The displacement can be scaled; the normal map is recomputed for each scale.", "section 5.1",
        f"the host sends {first[-2]:,} bytes for the first frame and {later[-2]:,} for a later one, {later[5]:,} of them the "
        f"normal map; the displacement map and the Summed Height Table are not sent again (a test compares them between scales). The "
        f"last frame's tessellated mesh would be {later[-1]:,} bytes.",
        reproduced_if(later[-2] < first[-2] and later[1] > first[1]))]
    section.claims.append(Claim(
        "Displacement mapping as a primitive can significantly reduce the bottleneck of sending triangle data.", "section 5",
        f"over {len(SCALES)} frames the host sends " + "; ".join(f"{row[-1]:.2f} times the tessellated meshes' bytes ({row[0]})"
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
        "host_traffic", f"Bytes that the host sends for {len(SCALES)} frames of the half donut, and bytes of the tessellated meshes",
        [("frames", ""), ("texels", ""), ("triangles, last frame", ""), ("first frame", "byte"), ("a later one", "byte"),
         ("its mesh, tessellated", "byte"), ("all frames", "byte"), ("all meshes", "byte"), ("sent / meshes", "")], cases))
    section.tables.append(Table(
        "displacement_scale", f"{len(SCALES)} frames of the half donut",
        [("scale S", "model units"), ("triangles", ""), ("edges tested", ""), ("base mesh", "byte"),
         ("displacement map", "byte"), ("normal map", "byte"), ("Summed Height Table", "byte"), ("registers", "byte"),
         ("sent", "byte"), ("tessellated mesh instead", "byte")], rows))
    return section


EXPERIMENT = Experiment("displacement_scale", "The displacement scale between frames", "Section 5.1",
                        "The host's traffic when S changes.", measure)
