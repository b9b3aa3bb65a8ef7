#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Cross-section of a pipe with fins along it, in quadrangles, in Gmsh's format.

usage: make_mesh.py FILE [--cells N]

N cells across a fin (default 2); lengths are in meters. Groups of sides: inside (of the pipe), bare (its outer side between
the fins), and fins (their sides and tips).
"""
import argparse
import math

FINS, INNER, OUTER, LENGTH, THICKNESS = 12, 0.010, 0.013, 0.020, 0.002


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("file")
    parser.add_argument("--cells", type=int, default=2)
    given = parser.parse_args()
    n = given.cells
    wall, along, bare = round(1.5 * n), 8 * n, 2 * n    # cells through the wall, along a fin, between two fins
    half = math.asin(0.5 * THICKNESS / OUTER)    # angle of half a fin

    nodes, numbers, cells, sides = [], {}, [], []

    def node(x, y):
        key = (round(x, 9), round(y, 9))
        if key not in numbers:
            nodes.append((x, y))
            numbers[key] = len(nodes)
        return numbers[key]

    for fin in range(FINS):
        turn = 2.0 * math.pi * fin / FINS
        c, s = math.cos(turn), math.sin(turn)

        def at(x, y):
            return node(c * x - s * y, s * x + c * y)

        # sines are equally spaced below the fin, so that its rows go on in the wall; angles beside it
        angles = [math.asin(math.sin(half) * (2.0 * j / n - 1.0)) for j in range(n + 1)]
        gap = 2.0 * math.pi / FINS - 2.0 * half
        angles += [half + gap * j / bare for j in range(1, bare + 1)]
        radii = [INNER + (OUTER - INNER) * i / wall for i in range(wall + 1)]
        ring = [[at(r * math.cos(a), r * math.sin(a)) for a in angles] for r in radii]
        for j in range(len(angles) - 1):
            for i in range(wall):
                cells.append((ring[i][j], ring[i + 1][j], ring[i + 1][j + 1], ring[i][j + 1]))
            sides.append((2, ring[0][j], ring[0][j + 1]))
            if j >= n:
                sides.append((3, ring[wall][j], ring[wall][j + 1]))
        rows = []
        for i in range(along + 1):
            row = []
            for j in range(n + 1):
                y = THICKNESS * (j / n - 0.5)
                base = math.sqrt(OUTER ** 2 - y ** 2)
                row.append(at(base + (OUTER + LENGTH - base) * i / along, y))
            rows.append(row)
        for i in range(along):
            for j in range(n):
                cells.append((rows[i][j], rows[i + 1][j], rows[i + 1][j + 1], rows[i][j + 1]))
            for j in (0, n):
                sides.append((4, rows[i][j], rows[i + 1][j]))
        for j in range(n):
            sides.append((4, rows[along][j], rows[along][j + 1]))

    with open(given.file, "w", encoding="ascii") as file:
        file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n")
        file.write('2 1 "pipe"\n1 2 "inside"\n1 3 "bare"\n1 4 "fins"\n$EndPhysicalNames\n')
        file.write("$Nodes\n%d\n" % len(nodes))
        for k, (x, y) in enumerate(nodes):
            file.write("%d %.12g %.12g 0\n" % (k + 1, x, y))
        file.write("$EndNodes\n$Elements\n%d\n" % (len(cells) + len(sides)))
        for k, cell in enumerate(cells):
            file.write("%d 3 2 1 1 %d %d %d %d\n" % ((k + 1,) + cell))
        for k, (tag, a, b) in enumerate(sides):
            file.write("%d 1 2 %d %d %d %d\n" % (len(cells) + k + 1, tag, tag, a, b))
        file.write("$EndElements\n")


if __name__ == "__main__":
    main()
