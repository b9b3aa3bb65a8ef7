# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""A sitting hare, in centimeters, as a scanner leaves it: no soles, single triangles missing, some turned: hare.obj

The shape is where the smooth minimum of the distances from ellipsoids is zero (marching tetrahedra); prints the volume of
the whole surface and of its parts."""

import numpy as np

SIZE = 0.6    # of a cell (cm)
# center, radii, and tilt (degrees about x and y) of ellipsoids
PARTS = [((0, 0.3, 4.0), (3.0, 3.8, 3.7), (-25, 0)),       # body
         ((0, -2.2, 7.6), (1.9, 2.4, 1.9), (15, 0)),       # head
         ((0, -0.9, 5.9), (1.6, 1.6, 2.0), (-20, 0)),      # neck
         ((1.0, -1.5, 11.0), (0.62, 0.85, 2.9), (-16, 12)),    # ears
         ((-1.0, -1.5, 11.0), (0.62, 0.85, 2.9), (-16, -12)),
         ((2.2, 1.2, 1.9), (1.6, 2.5, 2.1), (0, 0)),       # thighs
         ((-2.2, 1.2, 1.9), (1.6, 2.5, 2.1), (0, 0)),
         ((1.2, -3.0, 1.2), (0.9, 1.3, 1.4), (0, 0)),      # paws
         ((-1.2, -3.0, 1.2), (0.9, 1.3, 1.4), (0, 0)),
         ((0, 4.3, 2.6), (1.1, 1.1, 1.1), (0, 0))]         # tail
SMOOTH = 0.35    # cm


def distance(x):
    """Smooth minimum of the distances of the places x[..., 3] from the parts, about, and cut off at the floor."""
    total = 0.0
    for center, radii, (a, b) in PARTS:
        a, b = np.radians(a), np.radians(b)
        turn = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]]) @ np.array(
            [[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]])
        y = (x - np.array(center)) @ turn
        r = np.array(radii)
        k0, k1 = np.linalg.norm(y / r, axis=-1), np.linalg.norm(y / r ** 2, axis=-1)
        total = total + np.exp(-np.clip(k0 * (k0 - 1) / np.maximum(k1, 1e-9), -20, 20) / SMOOTH)
    return np.maximum(-SMOOTH * np.log(total), 0.15 - x[..., 2])


def surface():
    """Corners and triangles, outward, of the surface on a lattice, each cell of which is six tetrahedra."""
    lo, n = np.array([-5.5, -6.0, -0.6]), np.array([19, 21, 26])
    index = np.stack(np.meshgrid(*[np.arange(k) for k in n], indexing="ij"), -1)
    # off the symmetry of the lattice, so that no corner is on the surface
    value = distance(lo + SIZE * (index + [0.313, 0.271, 0.177]))
    corners, number, triangles = [], {}, []

    def cut(a, b):
        key = (min(a, b), max(a, b))
        if key not in number:
            va, vb = value[key[0]], value[key[1]]
            t = np.clip(va / (va - vb), 0.05, 0.95)    # no slivers
            number[key] = len(corners)
            corners.append(lo + SIZE * ((1 - t) * np.array(key[0]) + t * np.array(key[1]) + [0.313, 0.271, 0.177]))
        return number[key]

    steps = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    tetrahedra = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
    inside = value < 0
    some = inside[:-1, :-1, :-1].copy()
    every = some.copy()
    for s in steps[1:]:
        part = inside[s[0]:n[0] - 1 + s[0], s[1]:n[1] - 1 + s[1], s[2]:n[2] - 1 + s[2]]
        some |= part
        every &= part
    for cell in np.argwhere(some & ~every):
        place = [tuple(int(v) for v in cell + np.array(s)) for s in steps]
        for tet in tetrahedra:
            p = [place[k] for k in tet]
            within = [q for q in p if value[q] < 0]
            beyond = [q for q in p if value[q] >= 0]
            if len(within) == 1 or len(within) == 3:
                one, rest = (within[0], beyond) if len(within) == 1 else (beyond[0], within)
                faces = [[cut(one, q) for q in rest]]
            elif len(within) == 2:
                a, b = within
                c, d = beyond
                ring = [cut(a, c), cut(a, d), cut(b, d), cut(b, c)]
                faces = [[ring[0], ring[1], ring[2]], [ring[0], ring[2], ring[3]]]
            else:
                continue
            out = np.mean(beyond, axis=0) - np.mean(within, axis=0)
            for f in faces:
                x = [corners[k] for k in f]
                if np.dot(np.cross(x[1] - x[0], x[2] - x[0]), out) < 0:
                    f = [f[0], f[2], f[1]]
                triangles.append(f)
    return np.array(corners), np.array(triangles)


corners, triangles = surface()
x = corners[triangles]
volume = np.einsum("ij,ij->i", x[:, 0], np.cross(x[:, 1], x[:, 2])) / 6
middle = x.mean(axis=1)
center = (volume[:, None] * x.sum(axis=1) / 4).sum(axis=0) / volume.sum()
print("%d triangles, volume %.4f cm^3, center %.4f %.4f %.4f cm"
      % (len(triangles), volume.sum(), *center))

rng = np.random.default_rng(7)
kept = triangles[(middle[:, 2] > 0.2) & (rng.random(len(triangles)) > 0.004)]
turned = rng.random(len(kept)) < 0.03
kept[turned] = kept[turned][:, ::-1]
with open("hare.obj", "w", encoding="ascii") as file:
    file.write("# a hare, in centimeters\n")
    for corner in corners:
        file.write("v %.3f %.3f %.3f\n" % tuple(corner))
    for face in kept + 1:
        file.write("f %d %d %d\n" % tuple(face))
print("%d triangles without soles and others, %d turned" % (len(kept), turned.sum()))
