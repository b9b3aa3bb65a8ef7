# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The stress in the plate, and above the hole beside that in an infinite plate (refined.txt): refined-plate.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

RIM = 3.3602    # of a plate with a half width of 5 radii, by finite elements that were refined

_, kind, x, y, s = np.loadtxt("refined.txt", skiprows=9).T
r, angle = np.hypot(x, y), np.arctan2(x, y)    # from the y axis

# at the axis: even in the angle, and falling with powers of the radius
near = (r < 2.0) & (r > 1.03) & (abs(angle) < 0.25)
terms = np.stack([r[near] ** -k * angle[near] ** m for k in (0, 2, 4, 6) for m in (0, 2)], 1)
fit = np.linalg.lstsq(terms, s[near], rcond=None)[0]
rim = sum(fit[::2])
print("stress at the rim: %.3f, reference %.4f" % (rim, RIM))

figure, (left, right) = plt.subplots(1, 2, figsize=(9.5, 4.2))
dots = left.scatter(x, y, c=s, s=0.25 * 4.0 ** (4 - kind), cmap="turbo", vmin=0, vmax=3.4)
left.set(aspect="equal", xlabel="x/a", ylabel="y/a", title="stress along x over the pull")
figure.colorbar(dots, ax=left)
axis = angle < 0.12
right.plot(r[axis], s[axis], ".", label="points within 7 degrees of the axis")
radius = np.linspace(1, 5)
right.plot(radius, 1 + 0.5 * radius ** -2 + 1.5 * radius ** -4, "0.6", label="Kirsch, infinite plate")
right.plot(1, RIM, "k*", ms=10, label="rim of a plate of this width")
right.set(xlabel="distance from the middle of the hole, over its radius", ylabel="stress along x", ylim=(0.8, 3.6))
right.legend(fontsize=8)
figure.tight_layout()
figure.savefig("refined-plate.png", dpi=100)
