# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The boat, its heave and roll beside linear theory (trace.txt, water.*.txt): boat.png; prints amplitudes and times of both"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import theory

t, heave, roll, volume = np.loadtxt("trace.txt", usecols=(1, 2, 3, 4)).T
coarse, fine = (theory.motion(h, -0.3, 1.5, t) for h in (0.04, 0.02))
exact = [b + (b - a) / 3.0 for a, b in zip(coarse, fine)]    # of second order


def zeros(x):
    k = np.flatnonzero(x[2:] * x[1:-1] < 0.0) + 1
    return t[k] - x[k] * (t[k + 1] - t[k]) / (x[k + 1] - x[k])


def peak(x):
    """the first extremum"""
    return x[np.flatnonzero((x[1:-1] - x[:-2]) * (x[2:] - x[1:-1]) <= 0.0)[0] + 1]


for name, measured, linear in (("heave", heave, exact[0]), ("roll", roll, exact[1])):
    print("%s: first swing %.4f, linear theory %.4f; its end at %.3f s, %.3f s" %
          (name, peak(measured), peak(linear), zeros(measured)[0], zeros(linear)[0]))
periods = [2.0 * (z[-1] - z[0]) / (len(z) - 1) for z in (zeros(roll), zeros(exact[1]))]
print("period of roll: %.3f s, %.3f s" % tuple(periods))
print("volume within %.2f %%" % (100 * max(abs(volume[1:] / 0.76 - 1.0))))

figure = plt.figure(figsize=(9, 4.6))
grid = figure.add_gridspec(2, 6, hspace=0.35, wspace=1.4, left=0.1, right=0.98, bottom=0.11, top=0.95)
for k, step in enumerate((0, 20, 80)):
    x, y, p = np.loadtxt("water.%d.txt" % step, skiprows=9, usecols=(1, 2, 3)).T
    axis = figure.add_subplot(grid[0, 2 * k:2 * k + 2])
    axis.scatter(x, y, s=1.5, c=p, cmap="viridis", vmin=0.0, vmax=4000.0, lw=0)
    c, s = np.cos(roll[step]), np.sin(roll[step])
    corners = np.array([(-0.2, -0.1), (0.2, -0.1), (0.2, 0.1), (-0.2, 0.1), (-0.2, -0.1)])
    axis.fill(1.0 + corners @ (c, -s), 0.4 + heave[step] + corners @ (s, c), "sienna")
    axis.set(xlim=(0.45, 1.55), ylim=(0.0, 0.62), aspect="equal", xticks=[], yticks=[])
    axis.set_title("%.2f s" % t[step], fontsize=8)
for k, (label, measured, linear) in enumerate((("heave [m]", heave, exact[0]), ("roll [rad]", roll, exact[1]))):
    axis = figure.add_subplot(grid[1, 3 * k:3 * k + 3])
    axis.plot(t, measured, lw=1.0, label="boat")
    axis.plot(t, linear, "k--", lw=0.7, label="linear theory")
    axis.set(xlabel="time [s]", ylabel=label)
    axis.legend(fontsize=7, frameon=False, ncol=2, loc="lower right", bbox_to_anchor=(1.0, 0.98))
figure.savefig("boat.png", dpi=100)
