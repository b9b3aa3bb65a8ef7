#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.

"""The bag and the head at six times (shape.dump), after the run: folded-airbag.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

shown = {0: "0", 1000: "2.4 ms", 2000: "4.9 ms", 6000: "15 ms", 14000: "35 ms", 34000: "84 ms"}

frames = {}
with open("shape.dump", encoding="ascii") as file:
    for part in file.read().split("ITEM: TIMESTEP\n")[1:]:
        lines = part.splitlines()
        frames[int(lines[0])] = np.array([line.split() for line in lines[8:]], dtype=float)

figure, axes = plt.subplots(1, 6, figsize=(12, 3.9), sharey=True, layout="constrained")
for ax, (step, time) in zip(axes, shown.items()):
    tag, kind, x, y = frames[step].T
    ax.fill(x[kind == 1], y[kind == 1], color="lightsteelblue")
    ax.plot(np.append(x[kind == 1], x[0]), np.append(y[kind == 1], y[0]), "-", color="navy", lw=1.2)
    ax.plot(x[kind == 2], y[kind == 2], ".", color="tab:orange", ms=2)
    ax.axhline(-0.0128, color="0.3", lw=1)
    ax.set(aspect="equal", xlim=(-0.26, 0.26), ylim=(-0.03, 0.85), title=time, xticks=(-0.2, 0, 0.2), xlabel="x (m)")
axes[0].set_ylabel("y (m)")
figure.savefig("folded-airbag.png", dpi=100)
