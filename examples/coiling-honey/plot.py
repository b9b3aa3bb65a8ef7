# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The thread at some times, and how far it has turned beside the theory of thin threads (points.txt, trace.txt): coiling-honey.png;
prints the frequency over that of theory"""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "tools"))

from runge_kutta import runge_kutta

K = float(sys.argv[1]) if len(sys.argv) > 1 else 6.0    # height of the needle over the diameter
D, U, NU, G = 0.0005, 0.1, 50.0 / 1400.0, 9.81
A = 0.5 * D
FIRST, LAST = 2.5, 5.0    # after the push, and before the pile is as high as one half of the height


def unit_coil(unknown, weight, inertia, steps=200):
    """What is left of the conditions at the plate.

    A thread of constant radius whose shape turns around z with Omega (Ribe 2004, without stretching), with lengths in H and velocities in U: the
    section of the thread has the angular velocity w = Omega + t x t' + s t, bending and twisting moments are w' times 3 pi mu a^4/4 and two thirds of that.
    It comes straight down and does not turn at the needle, s = 0; on the plate it is at rest.
    unknown: moment and force at the needle, Omega, length. By the method of Runge and Kutta."""
    omega, length = unknown[6:]
    turn = np.array([0.0, 0.0, omega])
    cross = lambda a, b: np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])

    def slope(y):
        x, t, bend, spin, moment, force = y[:3], y[3:6], y[6:9], y[9], y[10:13], y[13:]
        along = moment @ t
        around = moment - along * t - spin * bend
        acceleration = cross(turn, cross(turn, x)) + 2.0 * cross(turn, t) + bend
        return length * np.concatenate([t, bend, cross(around, t) - bend @ bend * t, [1.5 * along], -cross(t, force),
                                        inertia * acceleration + [0.0, 0.0, weight]])

    y = np.concatenate([[0, 0, 0, 0, 0, -1, 0, 0, 0, omega], unknown[:6]])
    ds = 1.0 / steps
    for _ in range(steps):
        y = runge_kutta(slope, y, ds)
    x, t, bend, spin = y[:3], y[3:6], y[6:9], y[9]
    return np.concatenate([[x[2] + 1.0, x[1]], cross(turn, x) + t, turn + cross(t, bend) + spin * t])


def frequency(height, start=(-1.979, 5.139, 0.363, -9.510, -11.56, 52.40, 4.0, 1.4006)):
    """Omega H/U of a thread of this height, and that without weight and inertia."""
    found, unknown = [], np.array(start)
    for part in (0.0, 0.5, 1.0):
        weight, inertia = part * 4 / 3 * G * height ** 4 / (NU * A ** 2 * U), part * 4 / 3 * U * height ** 3 / (NU * A ** 2)
        for _ in range(20):
            left = unit_coil(unknown, weight, inertia)
            if abs(left).max() < 1e-9:
                break
            change = [(unit_coil(unknown + 1e-6 * e, weight, inertia) - left) / 1e-6 for e in np.eye(8)]
            unknown = unknown - np.linalg.solve(np.transpose(change), left)
        found.append(unknown[6])
    return found[-1], found[0]


t, x, y, pile = np.loadtxt("trace.txt").T
turns = np.unwrap(np.arctan2(y, x)) / (2.0 * np.pi)
free = np.maximum(0.1, 1.0 - pile + 0.5 / K)    # height of the needle above the axis of what has come to rest
during = (t > FIRST) & (t <= LAST)
mean = free[during].mean()
with_all, viscous = frequency(mean * K * D)
theory = np.cumsum(np.append(0.0, np.diff(t) * with_all / free[1:])) / (2.0 * np.pi)
begin, end = np.flatnonzero(during)[[0, -1]]
measured = turns[end] - turns[begin]
print("Omega H/U of theory: %.2f, without weight and inertia %.2f, which is %.3f Q/(a^2 H)" % (with_all, viscous, viscous / np.pi))
print("%.2f turns from %.1f to %.1f H/U, %.3f of theory with the height above the pile (%.2f H in the mean)"
      % (measured, FIRST, LAST, measured / (theory[end] - theory[begin]), mean))
print("frequency %.2f times Q/(a^2 H) of this height" % (measured / (theory[end] - theory[begin]) * with_all / np.pi))

shown = {}
for part in open("points.txt").read().split("ITEM: TIMESTEP\n")[1:]:
    lines = part.split("\n")
    shown[int(lines[0])] = np.array([line.split() for line in lines[8:] if line], dtype=float)
steps = sorted(shown)
figure = plt.figure(figsize=(10.5, 3.3))
grid = figure.add_gridspec(1, 7, width_ratios=[1, 1, 1, 1, 1.15, 0.3, 1.7], wspace=0.12, left=0.05, right=0.99, bottom=0.15, top=0.9)


def draw(axis, points, first, second, depth):
    order = np.argsort(points[:, depth])
    points = points[order]
    near = (points[:, depth] - points[0, depth]) / (points[-1, depth] - points[0, depth] + 1e-12)
    band = points[:, 0] // 416 % 2    # which came together
    axis.scatter(1000 * points[:, first], 1000 * points[:, second], s=6.0, lw=0, c=0.25 + 0.35 * near + 0.35 * band, cmap="YlOrBr_r", vmin=0, vmax=1.15)


for k, step in enumerate((3, 5, 7, 9)):
    axis = figure.add_subplot(grid[0, k])
    points = shown[steps[step]].copy()
    points[:, 2] *= -1.0    # near is in front
    draw(axis, points, 1, 3, 2)
    axis.set(xlim=(-1.35, 1.35), ylim=(0, 3.25), aspect="equal", title="%.0f ms" % (1000 * step * 0.5 * K * D / U))
    if k:
        axis.set_yticklabels([])
    else:
        axis.set_ylabel("height [mm]")
axis = figure.add_subplot(grid[0, 4])
low = shown[steps[10]]
draw(axis, low[low[:, 3] < 0.5 * K * D], 1, 2, 3)
axis.set(xlim=(-1.3, 1.3), ylim=(-1.3, 1.3), aspect="equal", title="from above")
axis.set_yticklabels([])
axis = figure.add_subplot(grid[0, 6])
axis.plot(t[t > 1.2], turns[t > 1.2] - turns[begin], label="axis of the thread")
axis.plot(t[begin:], theory[begin:] - theory[begin], "--", lw=1.5, label="theory of thin threads")
axis.set(xlabel="time [H/U]", ylabel="turns", xlim=(1.0, t[-1]))
axis.legend(frameon=False, fontsize=8)
figure.savefig("coiling-honey.png", dpi=100)
