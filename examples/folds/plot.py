# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The strip at three times with sides of nodes, at one without, and the force on the plate: folds.png"""

import glob
import os

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))


def pictures(sides):
    return [plt.imread(name) for name in sorted(glob.glob("folds.%s.*.png" % sides))]


with_sides, without = pictures("yes"), pictures("no")
figure, axes = plt.subplots(1, 4, figsize=(13, 3.2), constrained_layout=True, width_ratios=[1, 1, 1, 1.2])
for one, picture, title in zip(axes, (with_sides[0], with_sides[3], without[3]),
                               ("before", "pressed", "pressed, without sides")):
    one.imshow(picture)
    one.set_title(title, fontsize=9)
    one.axis("off")
for sides, style in (("yes", "k"), ("no", "C1--")):
    travel, force = np.loadtxt("curve.%s.txt" % sides).T[1:]
    label = "folds that touch" if sides == "yes" else "without sides of nodes"
    axes[3].semilogy(travel, np.maximum(force, 1e-3), style, lw=1, label=label)
    down = travel[:np.argmax(travel)]
    print("%s: %.3g kN/m at 2 mm, %.3g kN/m at 5 mm, at most %.3g kN/m"
          % (label, np.interp(2, down, force[:len(down)]), np.interp(5, down, force[:len(down)]), force.max()))
axes[3].set(xlabel="travel of the plate (mm)", ylabel="force (kN per m of depth)", ylim=(1e-3, 20))
axes[3].legend(fontsize=8)
figure.savefig(os.path.join(HERE, "folds.png"), dpi=80)
