#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.

"""Writes bag.msh: two square sheets of edge 0.84 that are joined along their edges, in crossed triangles."""

N = 20    # squares along an edge

nodes, place = [], {}


def node(i, j, side):
    """The number of a node; those of the edge belong to both sheets."""
    edge = min(i, j) == 0 or max(i, j) == 2 * N
    key = (i, j, 0 if edge else side)
    if key not in place:
        nodes.append(((i - N) * 0.42 / N, (j - N) * 0.42 / N, 1e-6 * key[2]))
        place[key] = len(nodes)
    return place[key]


triangles = []
for side in (1, -1):
    for i in range(0, 2 * N, 2):
        for j in range(0, 2 * N, 2):
            c = [node(i, j, side), node(i + 2, j, side), node(i + 2, j + 2, side), node(i, j + 2, side)]
            middle = node(i + 1, j + 1, side)
            for k in range(4):
                t = (c[k], c[(k + 1) % 4], middle)
                triangles.append(t if side > 0 else t[::-1])
with open("bag.msh", "w", encoding="ascii") as file:
    file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % len(nodes))
    for k, x in enumerate(nodes):
        file.write("%d %.6g %.6g %g\n" % ((k + 1,) + x))
    file.write("$EndNodes\n$Elements\n%d\n" % len(triangles))
    for k, t in enumerate(triangles):
        file.write("%d 2 2 1 1 %d %d %d\n" % ((k + 1,) + t))
    file.write("$EndElements\n")
