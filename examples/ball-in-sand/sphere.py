#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Write sphere.stl: a triangulated sphere with the volume of a sphere of diameter 1.

The faces of an icosahedron are halved twice, which gives 320 triangles.
"""

import numpy as np


def icosahedron():
    g = 0.5 * (1.0 + 5.0**0.5)
    corners = [(s * a, t * b, 0.0) for a, b in [(1.0, g)] for s in (-1, 1) for t in (-1, 1)]
    corners = np.array([np.roll(c, k) for k in range(3) for c in corners])
    faces = [(i, j, k) for i in range(12) for j in range(i) for k in range(j)
             if all(abs(np.linalg.norm(corners[p] - corners[q]) - 2.0) < 1.0e-6
                    for p, q in [(i, j), (j, k), (k, i)])]
    triangles = corners[np.array(faces)]
    inward = np.linalg.det(triangles) < 0.0
    triangles[inward] = triangles[inward][:, ::-1]
    return triangles


def halved(triangles):
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
    parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.concatenate([np.stack(part, axis=1) for part in parts])


triangles = icosahedron()
for _ in range(2):
    triangles = halved(triangles)
    triangles /= np.linalg.norm(triangles, axis=2, keepdims=True)
volume = np.linalg.det(triangles).sum() / 6.0
triangles *= (np.pi / 6.0 / volume)**(1.0 / 3.0)

with open("sphere.stl", "w") as file:
    file.write("solid sphere\n")
    for triangle in triangles:
        file.write("facet normal 0 0 0\nouter loop\n")
        for corner in triangle:
            file.write("vertex %.7f %.7f %.7f\n" % tuple(corner))
        file.write("endloop\nendfacet\n")
    file.write("endsolid sphere\n")
