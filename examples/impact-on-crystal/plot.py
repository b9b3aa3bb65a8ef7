# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Atoms and material points at three times (rows.txt): impact-on-crystal.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

DT, WANTED = 0.004, (500, 1500, 3500)
frames = {}
with open("rows.txt") as file:
    for row in file:
        if row.startswith("ITEM: TIMESTEP"):
            number = int(next(file))
        elif row.startswith("ITEM: NUMBER"):
            count = int(next(file))
        elif row.startswith("ITEM: ATOMS"):
            frames[number] = np.array([next(file).split() for _ in range(count)], float)

figure, axes = plt.subplots(len(WANTED), 1, figsize=(6.6, 10), sharex=True, layout="constrained")
for panel, number in zip(axes, WANTED):
    rows = frames[number]
    atoms, points = rows[rows[:, 0] == 1], rows[rows[:, 0] == 2]
    left = panel.scatter(atoms[:, 1], atoms[:, 2], c=atoms[:, 3], s=5, cmap="viridis", vmin=-3.3, vmax=-2.0,
                         linewidths=0)
    right = panel.scatter(points[:, 1], points[:, 2], c=points[:, 4], s=3, cmap="magma_r", vmin=0, vmax=25,
                          linewidths=0)
    panel.set(aspect="equal", xlim=(5, 125), ylim=(0, 70), xticks=[], yticks=[])
    panel.text(8, 58, "t = %g" % (number * DT))
figure.colorbar(left, ax=axes, label="potential energy of the atoms", shrink=0.5, location="bottom")
figure.colorbar(right, ax=axes, label="von Mises stress of the disk", shrink=0.5, location="bottom")
figure.savefig("impact-on-crystal.png", dpi=100)
