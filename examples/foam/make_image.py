#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Makes foam.nrrd, gray values of 40 x 40 x 40 voxels as a scanner would give them: an open foam, whose struts are near the edges of
Voronoi's cells of seeds that are apart from each other. The foam is periodic, and its share of the volume that which is asked for."""

import numpy as np

N, CELLS, SHARE = 40, 16, 0.22    # voxels along an edge, cells, relative density

random = np.random.default_rng(3)
seeds = []
while len(seeds) < CELLS:
    x = random.uniform(0, N, 3)
    if all(np.linalg.norm((x - s + N / 2) % N - N / 2) > 0.75 * N / CELLS ** (1 / 3) for s in seeds):
        seeds.append(x)

grid = np.stack(np.meshgrid(*3 * [np.arange(N) + 0.5], indexing="ij"), -1)
distances = np.sort([np.linalg.norm((grid - s + N / 2) % N - N / 2, axis=-1) for s in seeds], axis=0)
edge = distances[2] - distances[0]    # zero on edges, where three cells meet
level = np.quantile(edge, SHARE)
gray = np.clip(np.round(127.5 + 60 * (level - edge)), 0, 255).astype(np.uint8)

with open("foam.nrrd", "wb") as file:
    file.write(b"NRRD0004\ntype: uchar\ndimension: 3\nsizes: %d %d %d\nspacings: 1e-4 1e-4 1e-4\nencoding: raw\n\n" % (N, N, N))
    file.write(gray.transpose(2, 1, 0).tobytes())
print("relative density %.4f" % (gray > 127.5).mean())
