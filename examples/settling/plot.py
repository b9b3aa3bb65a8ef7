#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Grains and a layer of the water at three times, and the height of the cloud with that of one grain alone:
plot.py [folder], after the run."""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "tools"))

from picture import cut, draw, read_series, read_table, row, usual_distance

folder = sys.argv[1] if len(sys.argv) > 1 else "."
series = read_series(os.path.join(folder, "settling.pvd"), (0.1, 0.3, 0.5))
curve = read_table(os.path.join(folder, "cloud.txt"))
D, GRAIN, WATER, VISCOSITY, G = 0.0015, 2500.0, 1000.0, 1.0e-3, 9.81    # of the input


def alone(time):
    """Way of one grain in water at rest: weight, buoyancy, and the drag of Di Felice without other grains."""
    speed, way, out = 0.0, 0.0, []
    for step in np.diff(time, prepend=time[0]):
        for _ in range(20):
            reynolds = max(WATER * speed * D / VISCOSITY, 1e-9)
            drag = (0.63 + 4.8 / np.sqrt(reynolds))**2 * 0.125 * np.pi * D**2 * WATER * speed**2
            mass = GRAIN * np.pi / 6 * D**3
            speed += step / 20 * ((1 - WATER / GRAIN) * G - drag / mass)
            way += step / 20 * speed
        out.append(way)
    return np.array(out)


figure = plt.figure(figsize=(10, 7.4), layout="constrained")
grid = figure.add_gridspec(2, 3, height_ratios=(1.6, 1))
line = [figure.add_subplot(grid[0, k]) for k in range(3)]
water = [cut(snapshot, "type == 1").show_in("mm") for snapshot in series]
for snapshot in water:
    snapshot.fields["up"] = 100 * snapshot.fields["velocity_z"]
disks = row(line, water, "up", 2.0 * usual_distance(water[0].x), cmap="RdBu_r", limits=(-30.0, 30.0), box=((0, 0), (120, 140)))
for axes, snapshot in zip(line, series):
    grains = cut(snapshot, "type == 2").show_in("mm")
    draw(axes, grains, np.full(len(grains.x), 0.75), D, cmap="copper", limits=(0, 1))
figure.colorbar(disks, ax=line, label="velocity of the water, upwards (cm/s)", pad=0.01, shrink=0.8)

axes = figure.add_subplot(grid[1, :])
time, height = curve["v_t"], 1e3 * curve["v_z"]
axes.plot(time, height, "C5", lw=2, label="the cloud")
axes.plot(time, height[0] - 1e3 * alone(time), "k--", label="one grain in water at rest")
axes.set(xlim=(0, time[-1]), ylim=(0, None), xlabel="time (s)", ylabel="height of the center (mm)")
axes.legend()
figure.suptitle("A cloud of sand settles in water")
figure.savefig(os.path.join(folder, "settling.png"), dpi=85)
