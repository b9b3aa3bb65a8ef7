# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The drop at some times, and its second moment beside linear theory with viscosity (points.txt, trace.txt): drop.png; prints
the times at which it is round, and the decay, over those of theory"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

ZEROS = (0.64661, 1.93824, 3.23103)    # without viscosity, amplitude 0.1: boundary integrals
OMEGA, DECAY = 2.4474832, 0.0381478    # for small amplitudes, Oh = 0.01
R = 1.0e-3


def snapshots(name):
    """By step: columns id x y vx vy."""
    found = {}
    for part in open(name).read().split("ITEM: TIMESTEP\n")[1:]:
        lines = part.split("\n")
        found[int(lines[0])] = np.array([line.split() for line in lines[8:] if line], dtype=float)
    return found


t, moment = np.loadtxt("trace.txt", usecols=(1, 2)).T
cross = np.flatnonzero(moment[1:] * moment[:-1] < 0.0)
zeros = t[cross] + (t[cross + 1] - t[cross]) * moment[cross] / (moment[cross] - moment[cross + 1])
print("round at " + ", ".join("%.4f" % at for at in zeros))
print("over theory: " + ", ".join("%.4f" % ratio for ratio in zeros / ZEROS[:len(zeros)]))
print("frequency between the first and the last of them over that of theory for small amplitudes: %.4f"
      % (np.pi * (len(zeros) - 1) / (zeros[-1] - zeros[0]) / OMEGA))
inner = np.arange(6, len(t) - 1)
peaks = inner[(moment[inner] - moment[inner - 1]) * (moment[inner + 1] - moment[inner]) < 0.0]
print("decay over theory: %.3f" % (np.log(-moment[peaks[0]] / moment[peaks[1]]) / (t[peaks[1]] - t[peaks[0]]) / DECAY))

shown = snapshots("points.txt")
figure = plt.figure(figsize=(10.5, 2.9))
grid = figure.add_gridspec(1, 5, width_ratios=[1, 1, 1, 0.25, 2.2], wspace=0.15, left=0.05, right=0.99, bottom=0.17, top=0.9)
for k, step in enumerate((0, 140, 280)):
    axis = figure.add_subplot(grid[0, k])
    points = shown[step]
    speed = np.hypot(points[:, 3], points[:, 4])
    axis.scatter(1e3 * points[:, 1], 1e3 * points[:, 2], s=1.2, lw=0, c=speed, cmap="viridis", vmin=0.0, vmax=0.06)
    angle = np.linspace(0.0, 2.0 * np.pi, 200)
    axis.plot(np.cos(angle), np.sin(angle), lw=0.6, color="gray")
    axis.set(xlim=(-1.25, 1.25), ylim=(-1.25, 1.25), xticks=(-1, 0, 1), yticks=(-1, 0, 1), aspect="equal", xlabel="mm",
             title="%.2f T" % t[max(0, step - 1)] if step else "0")
    if k:
        axis.set_yticklabels([])
axis = figure.add_subplot(grid[0, 4])
axis.plot(t, moment, lw=1.2, label="points")
axis.plot(t, moment[0] * np.exp(-DECAY * t) * np.cos(OMEGA * t), "--", lw=0.9, label="linear theory")
axis.plot(ZEROS, np.zeros(3), "k|", ms=10, label="round, amplitude 0.1")
axis.axhline(0.0, lw=0.4, color="gray")
axis.set(xlabel="time / T", ylabel="4 <x$^2$ - y$^2$> / R$^2$")
axis.legend(frameon=False, fontsize=8)
figure.savefig("drop.png", dpi=100)
