# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.

"""The cushion from the side and from above (bag.txt), with the stress of the fabric: airbag.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

x, y, z, stress = np.loadtxt("bag.txt", skiprows=9).T
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.4), gridspec_kw={"width_ratios": (1.3, 1)})
middle = np.abs(y) < 0.012
order = np.argsort(np.arctan2(z[middle], x[middle]))
left.plot(np.append(x[middle][order], x[middle][order][0]), np.append(z[middle][order], z[middle][order][0]), "-", label="middle")
rim = np.abs(z) < 0.02
left.plot(x[rim], z[rim], ".", color="0.6", ms=2, label="seam")
left.axhline(0.215, color="k", ls=":", lw=1, label="finite elements, 0.215 m")
left.set(aspect="equal", xlabel="x (m)", ylabel="z (m)", ylim=(-0.25, 0.32))
left.legend(loc="upper right", fontsize=8)
up = z > -0.005
dots = right.scatter(x[up], y[up], c=1e-6 * stress[up], s=9, cmap="viridis")
right.plot([-0.42, 0.42, 0.42, -0.42, -0.42], [-0.42, -0.42, 0.42, 0.42, -0.42], "k:", lw=1)
right.set(aspect="equal", xlabel="x (m)", ylabel="y (m)", title="from above; dotted: flat")
figure.colorbar(dots, ax=right, label="largest stress (MPa)")
figure.tight_layout()
figure.savefig("airbag.png", dpi=100)
