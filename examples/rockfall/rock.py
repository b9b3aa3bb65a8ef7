#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Write rock.stl: an icosahedron with axes of 1, 0.85, and 0.7, its center at the origin."""

import itertools

import numpy as np

golden = 0.5 * (1.0 + 5.0**0.5)
corners = np.array([np.roll((0.0, a, b), k) for k in range(3) for a in (-1.0, 1.0) for b in (-golden, golden)])
size = 0.5 / np.linalg.norm(corners[0])
edge = 2.0 + 1e-6

with open("rock.stl", "w") as file:
    file.write("solid rock\n")
    for triangle in itertools.combinations(corners, 3):
        if max(np.linalg.norm(a - b) for a, b in itertools.combinations(triangle, 2)) > edge:
            continue
        a, b, c = triangle
        if np.dot(np.cross(b - a, c - a), a) < 0.0:
            b, c = c, b
        file.write("facet normal 0 0 0\nouter loop\n")
        for corner in (a, b, c):
            file.write("vertex %.6f %.6f %.6f\n" % tuple(size * corner * (1.0, 0.85, 0.7)))
        file.write("endloop\nendfacet\n")
    file.write("endsolid rock\n")
