# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The tube at some times, and the swing and the air beside those of a column in one dimension (points.txt, trace.txt):
air-spring.png; prints the period and the pressures of the air, over those of theory"""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Rectangle, Wedge

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "tools"))

from runge_kutta import runge_kutta

A, H, P, GAMMA, RHO, G = 0.1, 0.3, 1.0e4, 1.4, 1000.0, 9.81
LENGTH = 0.5 + 0.57811    # of the straight arms, and of the bend: that of a straight tube with its inertia in potential flow
RANGE = 9000.0


def column(times):
    """Its displacement by the Runge-Kutta scheme of order 4."""
    def slope(y):
        return np.array([y[1], -(2.0 * RHO * G * y[0] + P * ((H / (H - y[0])) ** GAMMA - 1.0)) / (RHO * LENGTH)])

    y, found = np.array([-A, 0.0]), [-A]
    for dt in np.diff(times):
        for _ in range(10):
            y = runge_kutta(slope, y, 0.1 * dt)
        found.append(y[0])
    return np.array(found)


def snapshots(name):
    """By step: columns id x y p."""
    found = {}
    for part in open(name).read().split("ITEM: TIMESTEP\n")[1:]:
        lines = part.split("\n")
        found[int(lines[0])] = np.array([line.split() for line in lines[8:] if line], dtype=float)
    return found


def zeros(t, x):
    k = np.flatnonzero(x[1:] * x[:-1] < 0.0)
    return t[k] - x[k] * (t[k + 1] - t[k]) / (x[k + 1] - x[k])


t, swing, air, room, kinetic, energy, volume = np.loadtxt("trace.txt", usecols=range(1, 8)).T
fine = np.linspace(0.0, t[-1], 2001)
theory = column(fine)
law = P * (H / (H - theory)) ** GAMMA
found, exact = zeros(t, swing), zeros(fine, theory)
n = 2 * ((len(found) - 1) // 2)
print("period %.4f s, over theory %.4f (open at both ends it is %.3f s)"
      % (2.0 * (found[n] - found[0]) / n, (found[n] - found[0]) / (exact[n] - exact[0]), 2.0 * np.pi * np.sqrt(0.5 * LENGTH / G)))
print("highest and lowest pressure of the air over theory: %.4f %.4f" % (air[1:].max() / law.max(), air[1:].min() / law.min()))
print("p V^1.4 between %.7f and %.7f of what it was" % tuple(f / (air[1] * room[1] ** GAMMA) for f in
                                                  ((air[1:] * room[1:] ** GAMMA).min(), (air[1:] * room[1:] ** GAMMA).max())))
print("energy that is lost, over the largest kinetic energy: %.3f" % ((energy[1] - energy[-1]) / kinetic.max()))
print("volume of the water between %.2f and %.2f %% of that of the points"
      % tuple(100.0 * f / (0.1 + 0.04 * np.pi) for f in (volume[1:].min(), volume[1:].max())))

shown = snapshots("points.txt")
steps = np.array(sorted(shown))[1:]
tops = [k for k in range(1, len(t) - 1) if swing[k - 1] < swing[k] >= swing[k + 1]]
last = [k for k in range(tops[0], len(t) - 1) if swing[k - 1] > swing[k] <= swing[k + 1]][0]
middle = [k for k in range(1, tops[0]) if swing[k - 1] < 0.0 <= swing[k]][0]
figure = plt.figure(figsize=(10.5, 3.7))
grid = figure.add_gridspec(2, 5, width_ratios=[1, 1, 1, 0.2, 2], wspace=0.08, hspace=0.15, left=0.01, right=0.985, bottom=0.12, top=0.92)
colors = plt.get_cmap("RdBu_r")
for place, k in enumerate((middle, tops[0], last)):
    step = steps[np.argmin(abs(steps - k))]
    points = shown[step]
    axis = figure.add_subplot(grid[:, place])
    axis.add_patch(Rectangle((-0.05, -0.05), 0.7, 1.05, color="0.45", lw=0))    # walls, and what they leave free
    inside = colors(0.5 + 0.5 * (air[step] - P) / RANGE)
    axis.add_patch(Rectangle((0.0, 0.3), 0.2, 0.25 + H, color=inside, lw=0))
    axis.add_patch(Rectangle((0.4, 0.3), 0.2, 0.7, color=colors(0.5), lw=0))
    axis.add_patch(Wedge((0.3, 0.3), 0.3, 180.0, 360.0, width=0.2, color=colors(0.5), lw=0))
    axis.scatter(points[:, 1], points[:, 2], s=3.2, lw=0, c=points[:, 3], cmap=colors, vmin=-RANGE, vmax=RANGE)
    for x, side in ((0.0, 0.2), (0.4, 0.6)):    # the surfaces
        arm = points[(points[:, 1] > x) & (points[:, 1] < side) & (points[:, 2] > 0.3)]
        bins = np.linspace(x, side, 11)
        top = [arm[(arm[:, 1] >= a) & (arm[:, 1] < b), 2].max() + 0.0025 for a, b in zip(bins, bins[1:])]
        axis.plot(0.5 * (bins[1:] + bins[:-1]), top, color="black", lw=0.8)
    axis.text(0.1, 0.75, "%+.1f kPa" % (1.0e-3 * (air[step] - P)), ha="center", fontsize=7)
    axis.set(xlim=(-0.05, 0.65), ylim=(-0.05, 1.0), aspect="equal", title="%.2f s" % t[step])
    axis.set_axis_off()
axis = figure.add_subplot(grid[0, 4])
axis.plot(t, 100.0 * swing, lw=1.4, label="points")
axis.plot(fine, 100.0 * theory, "--", lw=0.9, label="column on a spring of air")
axis.plot(fine, -100.0 * A * np.cos(np.sqrt(2.0 * G / LENGTH) * fine), ":", lw=0.9, color="gray", label="open at both ends")
axis.axhline(0.0, lw=0.4, color="gray")
axis.set(ylabel="swing [cm]", ylim=(-12, 19), xticklabels=[])
axis.legend(frameon=False, fontsize=7, loc="upper right", ncol=2)
axis = figure.add_subplot(grid[1, 4])
axis.plot(t[1:], 1.0e-3 * air[1:], lw=1.4)
axis.plot(fine, 1.0e-3 * law, "--", lw=0.9)
axis.axhline(1.0e-3 * P, lw=0.4, color="gray")
axis.set(xlabel="time [s]", ylabel="pressure of the air [kPa]")
figure.savefig("air-spring.png", dpi=100)
