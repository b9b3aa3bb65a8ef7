# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Deflection of the middle against time (plate.txt), and the plate at the end (plate.dump): blast-on-plate.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

H, L, RHO, Y, B, LENGTH = 0.01, 0.1, 7800.0, 3.0e8 * 2 / np.sqrt(3), 1.2, 1.0e-4


def rigid_plastic(impulse, share):
    """deflection of a clamped strip of a rigid plastic body of this share of the strength in plane strain, see README.md"""
    size = 4 * RHO * (impulse / (RHO * H)) ** 2 * L**2 / (share * Y * H**2)
    return 500 * H * (np.sqrt(1 + 0.75 * size) - 1)


_, t, p, force, w, clamp, kinetic, plastic = np.loadtxt("plate.txt").T
x, y, stress, strain = np.loadtxt("plate.dump", skiprows=9)[:, 1:].T
impulse = p[0] * LENGTH * (1 / B - (1 - np.exp(-B)) / B**2)
late = t > 1.0
mean = 0.5 * (w[late].max() + w[late].min())
low, high = rigid_plastic(impulse, 1.0), rigid_plastic(impulse, 0.618)
print("deflection %.2f mm at most, %.2f mm in the end; rigid plastic %.2f to %.2f mm" % (w.max(), mean, low, high))

figure, (left, right) = plt.subplots(1, 2, figsize=(9.5, 4), width_ratios=(1, 1.2))
left.axhspan(low, high, color="0.9", label="rigid plastic, bounds")
left.plot(t, w, label="middle of the plate")
left.set(xlabel="time (ms)", ylabel="deflection (mm)", xlim=(0, t[-1]), ylim=(0, None))
left.legend(loc="lower right")
scale = left.twinx()
scale.plot(t, 1e-6 * p, color="C3", lw=1)
scale.set(ylim=(0, 160), yticks=(0, 35, 70))
scale.set_ylabel("pressure (MPa)", color="C3", loc="bottom")
for sign in (1, -1):
    dots = right.scatter(sign * 1000 * x, 1000 * y, c=100 * strain, s=3, cmap="viridis", vmax=8)
right.set(aspect="equal", xlabel="x (mm)", ylabel="y (mm)", title="in the end")
figure.colorbar(dots, ax=right, label="plastic strain (%)", orientation="horizontal", pad=0.25)
figure.tight_layout()
figure.savefig("blast-on-plate.png", dpi=100)
