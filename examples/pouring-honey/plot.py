# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The ribbon at some times, and its speed on its way down beside that of Trouton's equation (points.txt, trace.txt):
pouring-honey.png; prints how far they are apart, and the times of folds"""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "tools"))

from runge_kutta import runge_kutta

H, NU, G = 0.125, 50.0 / 1400.0, 9.81


def snapshots(name):
    """By step: columns id x y vx vy."""
    found = {}
    for part in open(name).read().split("ITEM: TIMESTEP\n")[1:]:
        lines = part.split("\n")
        found[int(lines[0])] = np.array([line.split() for line in lines[8:] if line], dtype=float)
    return found


def trouton(length, u_first, u_last, viscosity=4.0 * NU):
    """Speed of a falling ribbon, 4 nu (u'' - u'^2/u) = u u' - g, between two places so far apart, where it is known: shooting."""
    n = 2000
    ds = length / n

    def slope(y):
        return np.array([y[1], y[1] ** 2 / y[0] + (y[0] * y[1] - G) / viscosity])

    def shoot(first):
        y = np.array([u_first, first])
        path = [u_first]
        for _ in range(n):
            y = runge_kutta(slope, y, ds)
            path.append(y[0])
            if not 0.0 < y[0] < 100.0:
                break
        return y[0], path

    low, high = -50.0, 50.0
    for _ in range(80):
        middle = 0.5 * (low + high)
        end, path = shoot(middle)
        low, high = (middle, high) if end < u_last else (low, middle)
    return np.linspace(0.0, length, n + 1), np.array(path)


stations = np.arange(0.0075, 0.06, 0.005)    # below the slit
shown = snapshots("points.txt")
speeds = np.mean([[-p[abs(H - p[:, 2] - at) < 0.0025, 4].mean() for at in stations]
                  for step, p in shown.items() if 450 <= step <= 700], axis=0)
place, theory = trouton(stations[-1] - stations[0], speeds[0], speeds[-1])
place += stations[0]
error = speeds / np.interp(stations, place, theory) - 1.0
print("speed of the ribbon over that of Trouton's equation: %+.1f to %+.1f %%" % (100 * error.min(), 100 * error.max()))
place2, soft = trouton(stations[-1] - stations[0], speeds[0], speeds[-1], 2.0 * NU)
print("with a resistance of 2 mu it would be %.1f %% off" % (100 * abs(np.interp(stations, place2 + stations[0], soft) / speeds - 1.0).max()))

t, swing = np.loadtxt("trace.txt", usecols=(1, 3)).T
during = (t > 0.65) & (t < 1.25)
around = swing[during] - swing[during].mean()
cross = t[during][np.flatnonzero(around[1:] * around[:-1] < 0.0)]
print("the ribbon crosses the middle at " + ", ".join("%.2f" % at for at in cross) + " s")

figure = plt.figure(figsize=(10.5, 3.2))
grid = figure.add_gridspec(1, 7, width_ratios=[1, 1, 1, 1, 1, 0.3, 1.6], wspace=0.15, left=0.06, right=0.99, bottom=0.15, top=0.9)
for k, step in enumerate((250, 350, 450, 550, 650)):
    axis = figure.add_subplot(grid[0, k])
    points = shown[step]
    axis.scatter(100 * points[:, 1], 100 * points[:, 2], s=1.4, lw=0, c=points[:, 0] // 320 % 2, cmap="YlOrBr", vmin=-0.8, vmax=1.6)
    axis.set(xlim=(-4.2, 4.2), ylim=(0, 14), xticks=(-2, 0, 2), aspect="equal", title="%.1f s" % (0.002 * step))
    if k:
        axis.set_yticklabels([])
    else:
        axis.set_ylabel("height [cm]")
axis = figure.add_subplot(grid[0, 6])
axis.plot(100 * stations, speeds, "o", ms=4, label="points")
axis.plot(100 * place, theory, lw=1, label="4 $\\mu$ (Trouton)")
axis.plot(100 * (place2 + stations[0]), soft, "--", lw=1, label="2 $\\mu$")
axis.set(xlabel="below the slit [cm]", ylabel="speed [m/s]")
axis.legend(frameon=False, fontsize=8)
figure.savefig("pouring-honey.png", dpi=100)
