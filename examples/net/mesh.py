#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.

"""Writes net.msh: a square net of cables, 4 m wide with meshes of 2/7 m, three lines along the edge of each."""

N, PARTS, WIDTH = 14, 3, 4.0

nodes, place, lines = [], {}, []


def node(i, j):
    """The number of a node on the lattice of parts of meshes."""
    if (i, j) not in place:
        step = WIDTH / (N * PARTS)
        nodes.append((i * step - 0.5 * WIDTH, j * step - 0.5 * WIDTH))
        place[i, j] = len(nodes)
    return place[i, j]


for k in range(0, N * PARTS + 1, PARTS):
    for m in range(N * PARTS):
        lines.append((node(m, k), node(m + 1, k)))
        lines.append((node(k, m), node(k, m + 1)))
with open("net.msh", "w", encoding="ascii") as file:
    file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % len(nodes))
    for k, x in enumerate(nodes):
        file.write("%d %.9g %.9g 0\n" % ((k + 1,) + x))
    file.write("$EndNodes\n$Elements\n%d\n" % len(lines))
    for k, x in enumerate(lines):
        file.write("%d 1 2 1 1 %d %d\n" % ((k + 1,) + x))
    file.write("$EndElements\n")
