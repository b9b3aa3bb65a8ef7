# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Temperature in the pipe, and along a fin beside theory (pipe.txt): finned-pipe.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

H, K, THICKNESS, LENGTH, OUTER, AIR = 60.0, 16.0, 0.002, 0.020, 0.013, 293.0

_, x, y, T = np.loadtxt("pipe.txt", skiprows=9).T
m = np.sqrt(2 * H / (K * THICKNESS))
tip = H / (m * K)
denominator = np.cosh(m * LENGTH) + tip * np.sinh(m * LENGTH)
theory = (np.sinh(m * LENGTH) + tip * np.cosh(m * LENGTH)) / denominator
theory *= np.sqrt(2 * H * K * THICKNESS) / (H * (2 * LENGTH + THICKNESS))
print("efficiency of a fin by theory: %.5f" % theory)

fin = (x > OUTER) & (abs(y) < THICKNESS / 2)
root = (abs(x - OUTER) < 5e-4) & (abs(y) < THICKNESS / 2)
base = T[root].mean()
figure, (left, right) = plt.subplots(1, 2, figsize=(9.5, 4.2))
dots = left.scatter(1000 * x, 1000 * y, c=T, s=5, cmap="inferno", vmin=AIR, vmax=353)
left.set(aspect="equal", xlabel="x [mm]", ylabel="y [mm]", title="temperature [K]")
figure.colorbar(dots, ax=left)
s = np.linspace(0, LENGTH)
along = (np.cosh(m * (LENGTH - s)) + tip * np.sinh(m * (LENGTH - s))) / denominator
right.plot(1000 * (x[fin] - OUTER), T[fin], ".", label="points of the fin along x")
right.plot(1000 * s, AIR + (base - AIR) * along, "0.5", label="theory of fins, from the temperature at the base")
right.set(xlabel="distance from the base [mm]", ylabel="temperature [K]")
right.legend(fontsize=8)
figure.tight_layout()
figure.savefig("finned-pipe.png", dpi=100)
