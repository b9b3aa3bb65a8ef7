#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Makes microstructure.pgm: hard particles (white) in a matrix (black), 64 x 64 pixels. Disks of several sizes are dropped at
random, and kept where they are apart."""

import numpy as np

N, SHARE, GAP = 64, 0.35, 1.5    # pixels, share of particles, smallest distance of two particles

random = np.random.default_rng(7)
rows, columns = np.mgrid[0:N, 0:N] + 0.5
image = np.zeros((N, N), dtype=np.uint8)
disks = []
while (image > 0).mean() < SHARE:
    r = random.uniform(3.5, 8.0)
    x, y = random.uniform(0, N, 2)
    if all(np.hypot(x - a, y - b) > r + c + GAP for a, b, c in disks):
        disks.append((x, y, r))
        image[np.hypot(columns - x, rows - y) < r] = 255

with open("microstructure.pgm", "wb") as file:
    file.write(b"P5\n%d %d\n255\n" % (N, N) + image.tobytes())
print("%d particles, share %.4f" % (len(disks), (image > 0).mean()))
