# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The liquids at some times, and the growth of their kinetic energy beside theory (points.txt, trace.txt): rayleigh-taylor.png;
prints the rate of growth over that of theory"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

K, G = 2.0 * np.pi, 9.81
RHO, MU = (1000.0, 2000.0), (50.0, 100.0)    # below, above


def determinant(n):
    """Zero at the rate of growth n. Columns: velocities exp(-K |y|) and exp(-q |y|) below and above; rows: what is the same on both
    sides of the interface, which are both components of the velocity, and the shear stress and normal stress."""
    columns = []
    for side, rho, mu in zip((1.0, -1.0), RHO, MU):
        q = np.sqrt(K * K + n * rho / mu)
        columns.append((side, K, side * 2.0 * mu * K * K, rho * (n / K + side * G / n) + 2.0 * mu * K))
        columns.append((side, q, side * mu * (q * q + K * K), side * rho * G / n + 2.0 * mu * q))
    return np.linalg.det(np.array(columns).T / np.abs(columns).max(axis=0)[:, None])


def rate():
    """By bisection."""
    low, high = 1.0e-3, np.sqrt(G * K)
    for _ in range(60):
        middle = 0.5 * (low + high)
        if (determinant(middle) > 0.0) == (determinant(low) > 0.0):
            low = middle
        else:
            high = middle
    return low


def snapshots(name):
    """By step: columns id type x y."""
    found = {}
    for part in open(name).read().split("ITEM: TIMESTEP\n")[1:]:
        lines = part.split("\n")
        found[int(lines[0])] = np.array([line.split() for line in lines[8:] if line], dtype=float)
    return found


t, energy = np.loadtxt("trace.txt", usecols=(1, 2)).T
linear = (t >= 1.0) & (t <= 2.0)
slope = np.polyfit(t[linear], 0.5 * np.log(energy[linear]), 1)[0]
print("rate of growth %.4f 1/s, theory %.4f, ratio %.4f" % (slope, rate(), slope / rate()))

shown = snapshots("points.txt")
figure = plt.figure(figsize=(10.5, 4.2))
grid = figure.add_gridspec(1, 5, width_ratios=[1, 1, 1, 0.25, 2.2], wspace=0.15, left=0.05, right=0.99, bottom=0.13, top=0.92)
for k, step in enumerate((250, 350, 400)):
    axis = figure.add_subplot(grid[0, k])
    points = shown[step]
    colors = np.where(points[:, 1] == 1, "orange", "steelblue")
    axis.scatter(points[:, 2], points[:, 3], s=1.6, lw=0, c=colors)
    axis.set(xlim=(0, 1), ylim=(0, 2), xticks=(0, 1), yticks=(0, 1, 2), aspect="equal", xlabel="m", title="%.2f s" % t[step - 1])
    if k:
        axis.set_yticklabels([])
axis = figure.add_subplot(grid[0, 4])
axis.semilogy(t, energy, lw=1.2, label="points")
axis.semilogy(t, energy[99] * np.exp(2.0 * rate() * (t - t[99])), "--", lw=0.9, label="linear theory")
axis.set(xlabel="time [s]", ylabel="kinetic energy [J]", ylim=(1e-5, 1e4))
axis.legend(frameon=False, fontsize=8)
figure.savefig("rayleigh-taylor.png", dpi=100)
