#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Quarter of a square plate with a hole, in Gmsh's format: cells that are fine at the hole and coarse far away.

usage: make_mesh.py FILE [--rows N] [--cells quads|triangles] [--width W]

N rows of cells between the hole, whose radius is 1, and the edge of the plate, at W (default 5); as many cells along the arc. Their
length grows from row to row such that they are about square.
"""
import argparse
import math


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("file")
    parser.add_argument("--rows", type=int, default=16)
    parser.add_argument("--cells", choices=["quads", "triangles"], default="quads")
    parser.add_argument("--width", type=float, default=5.0)
    given = parser.parse_args()
    n, width = given.rows, given.width
    arc = 2 * ((n + 1) // 2)    # even: a node is at the corner

    def place(i, j):
        angle = 0.5 * math.pi * j / arc
        x, y = (math.cos(angle) if j < arc else 0.0), math.sin(angle)
        edge = width / max(x, y)    # how far the edge is in this direction
        r = edge ** (i / n)
        return r * x, r * y

    def node(i, j):
        return i * (arc + 1) + j + 1

    cells, sides = [], []
    for i in range(n):
        for j in range(arc):
            a, b, c, d = node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)
            if given.cells == "quads":
                cells.append((3, 1, (a, b, c, d)))
            else:
                cells += [(2, 1, (a, b, c)), (2, 1, (a, c, d))] if (i + j) % 2 else [(2, 1, (a, b, d)), (2, 1, (b, c, d))]
    for j in range(arc):
        sides.append((1, 2, (node(0, j), node(0, j + 1))))
        sides.append((1, 3 if j < arc // 2 else 4, (node(n, j), node(n, j + 1))))
    for i in range(n):
        sides.append((1, 5, (node(i, 0), node(i + 1, 0))))
        sides.append((1, 6, (node(i, arc), node(i + 1, arc))))

    names = ["hole", "right", "top", "bottom", "left"]
    with open(given.file, "w", encoding="ascii") as file:
        file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n6\n2 1 \"plate\"\n")
        file.write("".join('1 %d "%s"\n' % (k + 2, name) for k, name in enumerate(names)))
        file.write("$EndPhysicalNames\n$Nodes\n%d\n" % ((n + 1) * (arc + 1)))
        for i in range(n + 1):
            for j in range(arc + 1):
                file.write("%d %.15g %.15g 0\n" % ((node(i, j),) + place(i, j)))
        file.write("$EndNodes\n$Elements\n%d\n" % (len(cells) + len(sides)))
        for k, (kind, tag, nodes) in enumerate(cells + sides):
            file.write("%d %d 2 %d %d %s\n" % (k + 1, kind, tag, tag, " ".join(map(str, nodes))))
        file.write("$EndElements\n")


if __name__ == "__main__":
    main()
