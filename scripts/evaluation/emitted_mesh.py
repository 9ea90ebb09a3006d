"""A run's mesh.ply as arrays, and the positions of its triangles on the map and of points in the picture."""
import math
from dataclasses import dataclass

import numpy as np

TYPES = {"double": "<f8", "float": "<f4", "uchar": "u1", "ushort": "<u2", "int": "<i4", "uint": "<u4"}


@dataclass
class EmittedMesh:
    positions: np.ndarray  # n x 3, model units
    normals: np.ndarray  # n x 3, of the displaced surface
    texture: np.ndarray  # n x 2, 0..1 over the map, t from its bottom row
    triangles: np.ndarray  # m x 3 vertex indices
    generation: np.ndarray  # m
    stopped_by: np.ndarray  # m, bits as the file's header explains them

    def centres(self):
        return self.texture[self.triangles].mean(axis=1)

    def smallest_angles(self):
        """Smallest angles of the displaced triangles, in degrees."""
        corners = [self.positions[self.triangles[:, k]] for k in range(3)]
        angles = []
        for k in range(3):
            p = corners[(k + 1) % 3] - corners[k]
            q = corners[(k + 2) % 3] - corners[k]
            length = np.maximum(np.linalg.norm(p, axis=1) * np.linalg.norm(q, axis=1), 1e-300)
            angles.append(np.degrees(np.arccos(np.clip((p * q).sum(axis=1) / length, -1, 1))))
        return np.minimum.reduce(angles)


def read_mesh(path):
    content = path.read_bytes()
    header_end = content.index(b"end_header\n") + len(b"end_header\n")
    counts, fields, element = {}, {}, ""
    for line in content[:header_end].decode().splitlines():
        words = line.split()
        if words[0] == "element":
            element = words[1]
            counts[element], fields[element] = int(words[2]), []
        elif words[0] == "property" and words[1] != "list":
            fields[element].append((words[2], TYPES[words[1]]))
    vertices = np.frombuffer(content, np.dtype(fields["vertex"]), counts["vertex"], header_end)
    face = np.dtype([("corners", "u1"), ("vertices", "<i4", 3), *fields["face"]])
    faces = np.frombuffer(content, face, counts["face"], header_end + vertices.nbytes)
    return EmittedMesh(
        positions=np.stack([vertices[name] for name in "xyz"], axis=1),
        normals=np.stack([vertices["n" + name] for name in "xyz"], axis=1).astype(float),
        texture=np.stack([vertices[name] for name in "st"], axis=1).astype(float),
        triangles=faces["vertices"],
        generation=faces["generation"].astype(int),
        stopped_by=faces["stopped_by"].astype(int))


def values_at(mesh, image):
    """The values of an image of the map, top row first, at the triangles' centres."""
    rows, columns = image.shape
    centres = mesh.centres()
    column = np.clip((centres[:, 0] * columns).astype(int), 0, columns - 1)
    row = np.clip(((1 - centres[:, 1]) * rows).astype(int), 0, rows - 1)
    return image[row, column]


def density_in(mesh, region):
    """Triangles per unit of texture area where `region` (a boolean image of the map, top row first) is true, counted by
    their centres. Ratios between regions show where the detail is."""
    share = region.mean()
    return float(values_at(mesh, region).sum() / share) if share > 0 else 0.0


def on_screen(positions, camera):
    """Pixels from the picture's centre, and depths. camera: that of an effective job."""
    eye, target, up = (np.array(camera[name], float) for name in ("eye", "target", "up"))
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    focal = camera["viewport_height"] / 2 / math.tan(math.radians(camera["field_of_view"]) / 2)
    away = positions - eye
    depth = away @ forward
    return focal * np.stack([away @ right, away @ np.cross(right, forward)], axis=-1) / depth[..., None], depth
