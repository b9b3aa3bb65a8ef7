#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.

"""Writes folded.msh, a bag in 2d whose sides are folded twice each: mesh.py [largest length of a line]"""

import sys

import numpy as np

a = float(sys.argv[1]) if len(sys.argv) > 1 else 0.008    # length of a line (m)
gap = 1.1 * a        # distance of layers
width = 0.2          # of the packed bag


def arc(center, angles, r):
    return [(center[0] + r * np.cos(t), center[1] + r * np.sin(t)) for t in np.linspace(*angles, 200)]


def side(offset):
    """The right half of a sheet, so far to the left of the middle of the bag: out along the bottom, back, and out again."""
    out, back, g = width / 2 - 1.5 * gap, 2.0 * gap, gap
    return ([(0.0, offset)] + arc((out, g), (-np.pi / 2, np.pi / 2), g - offset)
            + arc((back, 3 * g), (-np.pi / 2, -3 * np.pi / 2), g + offset) + [(width / 2, 4 * g + offset)])


lower, upper = side(-0.5 * gap), side(0.5 * gap)
half = np.array(lower + upper[::-1])
s = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(half, axis=0).T))])
n = int(round(s[-1] / a))
at = np.linspace(0.0, s[-1], n + 1)
right = np.stack([np.interp(at, s, half[:, 0]), np.interp(at, s, half[:, 1])], axis=1)
folded = np.concatenate([right, (right * [-1, 1])[-2:0:-1]])
with open("folded.msh", "w", encoding="ascii") as file:
    file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % len(folded))
    for k, p in enumerate(folded):
        file.write("%d %.8g %.8g 0\n" % (k + 1, p[0], p[1]))
    file.write("$EndNodes\n$Elements\n%d\n" % len(folded))
    for k in range(len(folded)):
        file.write("%d 1 2 1 1 %d %d\n" % (k + 1, k + 1, (k + 1) % len(folded) + 1))
    file.write("$EndElements\n")
