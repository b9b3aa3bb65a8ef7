# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.

"""The roof (tent.txt), and its section beside that of a cylinder: tent.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

n, m, a = 16, 24, 1.2
ident, x, y, z, stress = np.loadtxt("tent.txt", skiprows=9).T
grid = [v.reshape(2 * n + 1, m + 1) for v in (x, y, z, stress)]
x, y, z, stress = grid
figure = plt.figure(figsize=(10, 3.4))
left = figure.add_axes((0.0, 0.0, 0.5, 1.0), projection="3d")
right = figure.add_axes((0.58, 0.16, 0.4, 0.7))
faces, color = [], []
for i in range(2 * n):
    for j in range(m):
        four = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
        faces.append([(x[k], y[k], z[k]) for k in four])
        color.append(1e-6 * np.mean([stress[k] for k in four]))
normalize = plt.Normalize(2.8, 3.5)
roof = Poly3DCollection(faces, facecolors=plt.cm.viridis(normalize(color)), edgecolors="k", linewidths=0.15)
left.add_collection3d(roof)
left.set(xlim=(-2.1, 2.1), ylim=(-0.3, 3.9), zlim=(-1.4, 0.6))
left.set_box_aspect((4.2, 4.2, 2.0), zoom=1.15)
left.view_init(24, -72)
left.set_axis_off()
left.set_title("stress %.2f MPa along the warp" % (1e-6 * np.median(stress)), y=0.92, fontsize=10)

middle = m // 2
up, out = z[n:, middle], x[n:, middle]
along = 0.866025404 * out - 0.5 * up          # from the ridge down the flat panel, and across it
across = 0.5 * out + 0.866025404 * up
right.plot(along / a, across / a, "o", ms=4, label="canvas")
t = 0.392493                                  # half of the angle of the arc: sag 0.198805
R = 1.0 / np.sin(t)
s = np.linspace(-t, t, 100)
right.plot(1.0 + R * np.sin(s), R * (np.cos(s) - np.cos(t)), "k-", lw=1, label="cylinder, exact")
right.axhline(0.198805, color="k", ls=":", lw=1)
right.set(xlabel="along the panel / a", ylabel="off its plane / a", ylim=(-0.02, 0.23))
right.legend(loc="lower center", fontsize=8)
figure.savefig("tent.png", dpi=100)
