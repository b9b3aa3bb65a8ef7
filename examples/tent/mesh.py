# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.

"""The canvas of a ridge tent, flat, of triangles with edges along its yarns: tent.msh"""

n, m = 16, 24            # squares in each half, from a rail to the ridge, and along the ridge
a = 0.15                 # their edge (m)
nodes, triangles = [], []
for i in range(2 * n + 1):
    s = a * (i - n)      # along the canvas, from the ridge
    for j in range(m + 1):
        nodes.append((0.5 * s * 3 ** 0.5, a * j, -0.5 * abs(s)))
for i in range(2 * n):
    for j in range(m):
        p = i * (m + 1) + j
        q = p + m + 1
        triangles += [(p, q, p + 1), (q, q + 1, p + 1)]
with open("tent.msh", "w") as out:
    out.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % len(nodes))
    for k, x in enumerate(nodes):
        out.write("%d %.10g %.10g %.10g\n" % ((k + 1,) + x))
    out.write("$EndNodes\n$Elements\n%d\n" % len(triangles))
    for k, t in enumerate(triangles):
        out.write("%d 2 2 1 1 %d %d %d\n" % ((k + 1,) + tuple(node + 1 for node in t)))
    out.write("$EndElements\n")
