#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Atoms and material points at three times, and their energies: plot.py [folder], after the run."""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "tools"))

from picture import cut, draw, read_series, read_table, row

folder = sys.argv[1] if len(sys.argv) > 1 else "."
series = read_series(os.path.join(folder, "rows.txt"), (2.0, 6.0, 14.0))
curve = read_table(os.path.join(folder, "energy.txt"))

figure = plt.figure(figsize=(10, 8.2), layout="constrained")
grid = figure.add_gridspec(3, 2, width_ratios=(1.25, 1))
line = [figure.add_subplot(grid[k, 0]) for k in range(3)]
atoms = row(line, [cut(snapshot, "type == 1") for snapshot in series], "c_pe", 1.15, "xy", limits=(-3.3, -2.0),
            box=((0.0, 0.0), (134.0, 72.0)))
for axes, snapshot in zip(line, series):
    disk = cut(snapshot, "type == 2")
    points = draw(axes, disk, disk.fields["c_s"], 0.75, "xy", "magma_r", (0.0, 25.0))
    axes.set_ylabel("y")
    axes.label_outer()
figure.colorbar(atoms, ax=line, label="potential energy of an atom", location="bottom", aspect=45, pad=0.01)
figure.colorbar(points, ax=line, label="von Mises stress in the disk", location="bottom", aspect=45, pad=0.01, extend="max")

axes = figure.add_subplot(grid[:, 1])
start = curve["v_crystal"][0]
for name, label, color, shift in (("v_disk", "disk, kinetic and stored", "C1", 0.0), ("c_kd", "disk, kinetic", "C1--", 0.0),
                                  ("v_crystal", "crystal, above its start", "C0", start),
                                  ("v_total", "all", "k", start)):
    axes.plot(curve["v_t"], curve[name] - shift, color, label=label)
for snapshot in series:
    axes.axvline(snapshot.time, color="gray", lw=0.8, ls=":")
axes.set(xlabel="time", ylabel="energy (units of the Lennard-Jones potential)", xlim=(0, curve["v_t"][-1]), ylim=(0, None))
axes.legend(loc="upper right", bbox_to_anchor=(1.0, 0.84))
figure.suptitle("A soft disk hits a crystal (Lennard-Jones units)")
figure.savefig(os.path.join(folder, "impact-on-crystal.png"), dpi=80)
