#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Writes valley.asc: the heights of a valley that bends and opens, as an ESRI ASCII grid of 10 m."""
import math

CELL, COLUMNS, ROWS = 10.0, 102, 42


def height(x, y):
    """Bed that falls by the same share in each meter, sides that become flatter, and humps."""
    aside = y - 200.0 - 60.0 * math.sin(x / 180.0)
    return (280.0 * math.exp(-x / 300.0) + (0.003 * math.exp(-x / 400.0) + 0.0003) * aside * aside
            + 2.0 * math.sin(x / 37.0) * math.cos(y / 29.0))


if __name__ == "__main__":
    with open("valley.asc", "w") as out:
        out.write("ncols %d\nnrows %d\nxllcenter -5\nyllcenter -5\ncellsize %g\n" % (COLUMNS, ROWS, CELL))
        for j in reversed(range(ROWS)):
            out.write(" ".join("%.2f" % height(-5.0 + i * CELL, -5.0 + j * CELL) for i in range(COLUMNS)) + "\n")
