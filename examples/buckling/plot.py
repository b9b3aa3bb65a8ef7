# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The column just before it buckles, after that, and with its ends 60 mm nearer, from *.txt: buckling.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

figure, axes = plt.subplots(3, 1, figsize=(7, 5), sharex=True, gridspec_kw={"height_ratios": [1, 1.4, 2.6]})
for axis, name, title, low in zip(axes, ("straight", "bowed", "folded"),
                                  ("8 mm nearer", "16 mm nearer", "60 mm nearer"), (-0.04, -0.08, -0.18)):
    x, y, stress = np.loadtxt(name + ".txt", skiprows=9).T
    dots = axis.scatter(x, y, c=1e-6 * stress, s=2, cmap="coolwarm", vmin=-12, vmax=12)
    axis.set(aspect="equal", xlim=(-0.02, 1.02), ylim=(low, 0.07), ylabel="y (m)", title="ends " + title)
    figure.colorbar(dots, ax=axis, label="stress (MPa)")
axes[-1].set_xlabel("x (m)")
figure.tight_layout()
figure.savefig("buckling.png", dpi=100)
