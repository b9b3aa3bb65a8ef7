# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The radius of the bore against the pressure (tube.dat), and the tube at the end (tube.txt): tube.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

# exact: the equation of equilibrium along the radius, and pressure on the area before deformation
PRESSURE = [0, 0.1, 0.2, 0.3, 0.4, 0.5]
FOLLOWING = [1, 1.081304, 1.183161, 1.316449, 1.502870, 1.795494]
DEAD = [1, 1.075051, 1.153545, 1.235483, 1.320856, 1.409639]

p, a, _ = np.loadtxt("tube.dat").T
x, y, stress = np.loadtxt("tube.txt", skiprows=9).T
figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4.2))
left.plot(PRESSURE, FOLLOWING, "-", color="0.6", label="exact")
left.plot(PRESSURE, DEAD, "--", color="0.6", label="exact, dead load")
left.plot(p, a, "o", label="fix mpm/traction")
left.set(xlabel="pressure over shear modulus", ylabel="radius of the bore (m)")
left.legend()
dots = right.scatter(x, y, c=1e-6 * stress, s=4, cmap="viridis")
for radius in (1, 2):
    angle = np.linspace(0, np.pi / 2)
    right.plot(radius * np.cos(angle), radius * np.sin(angle), "k:", lw=1)
right.set(aspect="equal", xlim=(0, 2.8), ylim=(0, 2.8), xlabel="x (m)", ylabel="y (m)",
          title="at the last pressure; dotted: before")
figure.colorbar(dots, ax=right, label="von Mises stress (MPa)")
figure.tight_layout()
figure.savefig("tube.png", dpi=100)
