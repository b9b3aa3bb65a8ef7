#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Forces, pile-up and hardness over friction, depth and resolution: study.py lmp [folder]

Runs that are there already in the folder (default: the present one) are not repeated.  The table of README.md."""

import os
import subprocess
import sys

import numpy as np

TAN = 1.0 / np.tan(np.radians(19.7))    # tangent of the angle between axis and side
CASES = [(mu, d, h) for d, h in ((0.15, 0.1), (0.15, 0.0667), (0.225, 0.1)) for mu in (0.0, 0.1, 0.3)]


def half_width(folder, depth):
    """Distance of the ridges from the middle (mm), 2 to 5 depths behind the tip, from the last heights."""
    with open(os.path.join(folder, "heights.txt")) as file:
        rows = [row.split() for row in file if not row.startswith("#")]
    last = max(k for k, row in enumerate(rows) if len(row) == 3)
    columns = np.array(rows[last + 1:], float)
    x, y = 1e3 * columns[:, 1], 1e3 * columns[:, 2]
    front = x[columns[:, 3].argmax()]
    behind = (x > front - 8.0 * depth) & (x < front - 5.0 * depth)
    middles = np.unique(y)
    mean = np.array([columns[behind & (y == m), 3].mean() for m in middles])
    k = int(np.clip(mean.argmax(), 1, len(mean) - 2))
    left, at, right = mean[k - 1:k + 2]
    return middles[k] + 0.5 * (middles[1] - middles[0]) * (left - right) / (left - 2.0 * at + right)


def measure(folder, mu):
    """Mean normal and tangential force (N) over the last 40 % of the way."""
    path, normal, tangential = np.loadtxt(os.path.join(folder, "forces.%g.txt" % mu), usecols=(1, 2, 3)).T
    steady = path > 0.6 * path[-1]
    return normal[steady].mean(), tangential[steady].mean()


def main():
    lmp, folder = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "."
    print("mu    d/mm  h/mm   Fn/N    Ft/N   Ft/Fn  nominal/GPa  width/d  hardness/GPa")
    for mu, depth, h in CASES:
        out = os.path.join(folder, "study.%g.%g.%g" % (mu, depth, h))
        if not os.path.exists(os.path.join(out, "done")):
            os.makedirs(out, exist_ok=True)
            here = os.path.dirname(os.path.abspath(__file__))
            with open(os.path.join(out, "screen"), "w") as screen:
                subprocess.run([lmp, "-in", os.path.join(here, "in.scratch"), "-log", os.path.join(out, "log"), "-v", "mu",
                                str(mu), "-v", "d", str(depth), "-v", "h", str(h), "-v", "outdir", out],
                               stdout=screen, check=True)
            open(os.path.join(out, "done"), "w").close()
        fn, ft = measure(out, mu)
        nominal = 0.5 * np.pi * (depth * TAN)**2    # mm^2: the front half of the cone, without pile-up
        width = half_width(out, depth)
        print("%.1f %6.3f %6.4f %7.0f %7.0f %7.3f %7.2f %11.2f %9.2f" % (
            mu, depth, h, fn, ft, ft / fn, 1e-3 * fn / nominal, width / depth, 1e-3 * fn / (0.5 * np.pi * width**2)))


main()
