#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Write rim.stl: a cylinder of radius 1 and length 1.4 around the y axis, with 64 sides and its center at the origin."""

import numpy as np

N = 64
angles = 2.0 * np.pi * np.arange(N) / N
r = 1.0 / np.sqrt(np.sin(angles[1]) / angles[1])    # the volume of a round cylinder
low = np.stack([r * np.cos(angles), np.full(N, -0.7), r * np.sin(angles)], axis=1)
high = low + [0.0, 1.4, 0.0]
triangles = []
for i in range(N):
    j = (i + 1) % N
    triangles += [(low[i], high[i], high[j]), (low[i], high[j], low[j]),
                  ((0.0, -0.7, 0.0), low[i], low[j]), ((0.0, 0.7, 0.0), high[j], high[i])]

with open("rim.stl", "w") as file:
    file.write("solid rim\n")
    for triangle in triangles:
        file.write("facet normal 0 0 0\nouter loop\n")
        for corner in triangle:
            file.write("vertex %.6f %.6f %.6f\n" % tuple(corner))
        file.write("endloop\nendfacet\n")
    file.write("endsolid rim\n")
