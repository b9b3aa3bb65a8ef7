#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Draws landslide.png: thickness of the slide over the map of the valley, at the start and at the end."""
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.patches import Rectangle

from terrain import height

CELL = 8.0    # of the map of thickness, m


def points(path):
    return np.loadtxt(path, skiprows=9)


def main():
    x, y = np.meshgrid(np.linspace(0, 1000, 251), np.linspace(0, 400, 101))
    z = np.vectorize(height)(x, y)
    before, after = points("start.txt"), points("end.txt")
    volume = 385906.25 / len(before)
    figure, axes = plt.subplots(2, 1, figsize=(11, 8.6), sharex=True)
    for axis, place, title in ((axes[0], before, "start"), (axes[1], after, "deposit")):
        axis.contourf(x, y, z, 40, cmap="gist_earth", alpha=0.55)
        axis.contour(x, y, z, np.arange(0, 400, 20), colors="0.35", linewidths=0.5)
        sums, xs, ys = np.histogram2d(place[:, 0], place[:, 1], bins=(np.arange(0, 1001, CELL), np.arange(0, 401, CELL)))
        thick = np.ma.masked_less(sums.T * volume / CELL**2, 0.3)
        mesh = axis.pcolormesh(xs, ys, thick, cmap="inferno_r", vmin=0, vmax=25)
        axis.add_patch(Rectangle((400, 0), 300, 400, fill=False, hatch="..", edgecolor="#206020", lw=0))
        axis.set_aspect("equal")
        axis.set_ylabel("y [m]")
        axis.set_title(title)
        figure.colorbar(mesh, ax=axis, label="thickness [m]", shrink=0.8)
    axes[1].set_xlabel("x [m]; dots: forest")
    figure.tight_layout()
    figure.savefig("landslide.png", dpi=80)


if __name__ == "__main__":
    main()
