#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""The rocks on their way, seen from the side, and their speeds: plot.py [folder], after the run."""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

SIZES, COLORS = (0.7, 0.6, 0.5), ("tab:red", "tab:blue", "tab:green")
TURNS = ((20, (1, 2, 0)), (70, (0, 1, 1)), (40, (1, 0, 1)))    # as in the input
folder = sys.argv[1] if len(sys.argv) > 1 else "."
trace = np.loadtxt(os.path.join(folder, "trace.txt"))
time = trace[:, 1]
sand = np.loadtxt(os.path.join(folder, "sand.txt"), skiprows=9)
with open("rock.stl", encoding="ascii") as file:
    corners = np.array([line.split()[1:] for line in file if line.startswith("vertex")]).astype(float)


def rotation(angle, axis):
    axis = np.array(axis) / np.linalg.norm(axis)
    cross = np.cross(np.eye(3), -axis)
    return np.eye(3) + np.sin(np.radians(angle)) * cross + (1.0 - np.cos(np.radians(angle))) * cross @ cross


def light(color):
    return 0.65 + 0.35 * np.array(matplotlib.colors.to_rgb(color))


figure, (axes, below) = plt.subplots(2, 1, figsize=(9, 8), layout="constrained", height_ratios=(2.4, 1))
axes.fill_between((0, 4.8), (3.6, 0), color="0.8")
axes.scatter(sand[:, 1], sand[:, 2], s=2, c=np.clip(sand[:, 3], 0, 1), cmap="YlOrBr", vmin=-0.5, vmax=1.5)
for k, (size, color, turn) in enumerate(zip(SIZES, COLORS, TURNS)):
    body = trace[:, 2 + 31 * k:33 + 31 * k]
    axes.plot(body[:, 0], body[:, 2], color=color, lw=0.8)
    rows = list(body[::round(0.25 / (time[1] - time[0]))][:9]) + [body[-1]]
    for row in rows:
        place = row[:3] + size * corners @ (row[15:24].reshape(3, 3) @ rotation(*turn)).T
        for triangle in place.reshape(-1, 3, 3):
            axes.fill(triangle[:, 0], triangle[:, 2], color=color if row is rows[-1] else light(color), lw=0)
    below.plot(time, np.linalg.norm(body[:, 3:6], axis=1), color=color)
    # nothing is faster than a body that slides without friction
    below.plot(time, np.sqrt(2 * 9.81 * np.maximum(body[0, 2] - body[:, 2], 0)), color=color, lw=0.8, ls=":")
axes.set(aspect="equal", xlim=(0, 8), ylim=(0, 5), xlabel="x (m)", ylabel="z (m)")
below.set(xlabel="time (s)", ylabel="speed (m/s)", xlim=(0, time[-1]), ylim=(0, None),
          title="speed of the centers; dotted: from the height alone")
figure.savefig("rockfall.png", dpi=100)
