#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Writes ring.msh, a ring of quadrangles around the origin, in the format of Gmsh:
make_mesh.py [elements across [elements around]]"""

import sys
from math import cos, pi, sin

across = int(sys.argv[1]) if len(sys.argv) > 1 else 3
around = int(sys.argv[2]) if len(sys.argv) > 2 else 120
inner, outer = 0.068, 0.080

with open("ring.msh", "w") as file:
    file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % (around * (across + 1)))
    for j in range(around):
        for i in range(across + 1):
            r, a = inner + (outer - inner) * i / across, 2 * pi * j / around
            file.write("%d %.9f %.9f 0\n" % (j * (across + 1) + i + 1, r * cos(a), r * sin(a)))
    file.write("$EndNodes\n$Elements\n%d\n" % (around * across))
    for j in range(around):
        for i in range(across):
            a, b = j * (across + 1) + i + 1, (j + 1) % around * (across + 1) + i + 1
            file.write("%d 3 2 1 1 %d %d %d %d\n" % (j * across + i + 1, a, a + 1, b + 1, b))
    file.write("$EndElements\n")
