# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Water in the tank, its swing, and its volume (trace.txt, slosh.*.png): sloshing.png; prints the period and the drift"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

t, swing, volume, kinetic = np.loadtxt("trace.txt", usecols=(1, 2, 3, 4)).T
swing = swing - swing.mean()
cross = np.flatnonzero(swing[1:] * swing[:-1] < 0.0)
zeros = t[cross] - swing[cross] * (t[cross + 1] - t[cross]) / (swing[cross + 1] - swing[cross])
period = 2.0 * (zeros[-1] - zeros[0]) / (len(zeros) - 1)
peaks = [k for k in range(1, len(t) - 1) if kinetic[k - 1] < kinetic[k] >= kinetic[k + 1]]
print("steps %d, period %.4f s (linear theory 1.1818 s)" % (len(t) - 1, period))
print("volume between %.3f and %+.3f %% of that of the points" % (200 * volume[1:].min() - 100, 200 * volume[1:].max() - 100))
print("kinetic energy of the last swing over that of the first: %.3f" % (kinetic[peaks[-1]] / kinetic[peaks[0]]))

figure = plt.figure(figsize=(9, 4.6))
grid = figure.add_gridspec(2, 6, hspace=0.35, wspace=1.2, left=0.08, right=0.98, bottom=0.11, top=0.93)
pictures = ["slosh.%05d.png" % step for step in (24, 48, 96)]
for k, name in enumerate(pictures):
    axis = figure.add_subplot(grid[0, 2 * k:2 * k + 2])
    axis.imshow(plt.imread(name))
    axis.set_axis_off()
    axis.set_title("step %d" % int(name.split(".")[-2]), fontsize=8)
axis = figure.add_subplot(grid[1, :3])
axis.plot(t, swing, lw=0.8)
axis.set(xlabel="time [s]", ylabel="swing [m]")
axis = figure.add_subplot(grid[1, 3:])
axis.plot(t[1:], 200 * volume[1:] - 100, lw=0.8)
axis.set(xlabel="time [s]", ylabel="volume [%]", ylim=(-1, 1))
figure.savefig("sloshing.png", dpi=100)
