# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The arch at rest under its weight (weight.txt) and with the load (load.txt): arch.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

LARGER = 20    # times the displacements

figure, axes = plt.subplots(2, 1, figsize=(7, 5), sharex=True)
for axis, name, title in zip(axes, ("weight", "load"), ("weight", "weight and 200 N/m at the arrow")):
    x, y, stress, ux, uy = np.loadtxt(name + ".txt", skiprows=9).T
    axis.plot((x - ux)[::3], (y - uy)[::3], ".", ms=1, color="0.85")
    dots = axis.scatter(x + (LARGER - 1) * ux, y + (LARGER - 1) * uy, c=1e-3 * stress, s=2, cmap="viridis",
                        vmin=0, vmax=60)
    axis.set(aspect="equal", xlim=(-1.15, 1.15), ylim=(0, 0.75), ylabel="y (m)",
             title="%s, displacements %d times larger" % (title, LARGER))
    figure.colorbar(dots, ax=axis, label="von Mises stress (kPa)")
axes[1].annotate("", xy=(-0.5, 0.48), xytext=(-0.5, 0.7), arrowprops={"arrowstyle": "-|>", "color": "r"})
axes[1].set_xlabel("x (m)")
figure.tight_layout()
figure.savefig("arch.png", dpi=100)
