"""The tessellator of GPUs since 2009 (Direct3D 11): a triangle patch has an integer factor for each edge, and is uniform inside."""
import numpy as np

from emitted_mesh import on_screen

MOST = 64  # largest factor


def factor_of(length, pixels):
    """The factor of an edge, from its length on the screen, for parts of about `pixels`."""
    return min(MOST, max(1, round(length / pixels)))


def pattern(edges):
    """Barycentric coordinates and triangles of a patch with these factors on the edges 0-1, 1-2, 2-0, and the greatest of
    them inside: concentric triangles, each with two parts fewer per edge than the previous one."""
    inside = max(edges)

    def ring(k):
        corners = [[2 * k / (3 * inside)] * 3 for _ in range(3)]
        for corner in range(3):
            corners[corner][corner] = 1 - 4 * k / (3 * inside)
        sides = []
        for side in range(3):
            parts = edges[side] if k == 0 else inside - 2 * k
            a, b = corners[side], corners[(side + 1) % 3]
            sides.append([tuple(a)] if parts == 0 else
                         [tuple((a[c] * (parts - i) + b[c] * i) / parts for c in range(3)) for i in range(parts + 1)])
        return sides

    triangles = []
    outer = ring(0)
    for k in range(1, inside // 2 + 1):
        inner = ring(k)
        for side in range(3):
            triangles += strip(outer[side], inner[side])
        outer = inner
    if inside % 2 == 1:
        triangles.append(tuple(outer[side][0] for side in range(3)))
    numbers = {}
    faces = [[numbers.setdefault(tuple(round(c, 12) for c in point), len(numbers)) for point in triangle] for triangle in triangles]
    return list(numbers), faces


def strip(outer, inner):
    """Triangles between two sides with any numbers of parts."""
    i, j, triangles = 0, 0, []
    while i + 1 < len(outer) or j + 1 < len(inner):
        outer_next = (i + 1) / (len(outer) - 1) if i + 1 < len(outer) else 2
        inner_next = (j + 1) / (len(inner) - 1) if j + 1 < len(inner) else 2
        if outer_next <= inner_next:
            triangles.append((outer[i], outer[i + 1], inner[j]))
            i += 1
        else:
            triangles.append((outer[i], inner[j + 1], inner[j]))
            j += 1
    return triangles


def screen_lengths(positions, camera):
    """A function of two vertices that returns the distance between them in pixels."""
    seen, _ = on_screen(positions, camera)
    return lambda a, b: float(np.linalg.norm(seen[a] - seen[b]))


def write_obj(path, base, length, pixels):
    """A plane's triangles, undisplaced, cut according to their edges' lengths on the screen. Both patches of an edge cut it in the same way."""
    lines, faces, numbers, cut = ["vn 0 0 1\n"], [], {}, {}
    corners = np.hstack([base.positions[:, :2], base.texture])
    for a, b, c in base.triangles:
        edges = tuple(factor_of(length(*sorted(edge)), pixels) for edge in ((a, b), (b, c), (c, a)))
        if edges not in cut:
            cut[edges] = pattern(edges)
        points, triangles = cut[edges]
        order = sorted(range(3), key=lambda k: (a, b, c)[k])  # so that an edge's points are the same from both sides
        made = []
        for point in points:
            text = "v {:.12g} {:.12g} 0\nvt {:.12g} {:.12g}\n".format(*sum(point[k] * corners[(a, b, c)[k]] for k in order))
            if text not in numbers:
                numbers[text] = len(numbers) + 1
                lines.append(text)
            made.append(numbers[text])
        faces += ["f " + " ".join("{0}/{0}/1".format(made[k]) for k in face) + "\n" for face in triangles]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("".join(lines + faces))
