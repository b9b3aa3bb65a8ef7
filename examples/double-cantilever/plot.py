# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The beam while it is peeled apart, and its load over the opening: double-cantilever.png"""

import os

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
# opening (mm) and load (N/mm): finite elements with the same law, and an elastic beam with a crack that needs .5 N/mm
ELEMENTS = np.array([[0.5, 3.4393], [1.0, 6.1175], [1.2, 6.665], [1.5, 5.9695], [2.0, 5.1699], [2.5, 4.6250]]).T
GRIFFITH = np.array([[0.0, 0.0], [0.9485, 7.5016], [1.5, 5.9652], [2.0, 5.1661], [2.5, 4.6207]]).T

opening, P, energy, front = np.loadtxt("curve.txt").T[1:]
figure, axes = plt.subplots(1, 2, figsize=(10, 3.4), constrained_layout=True)
left, right = axes
images = [plt.imread("double-cantilever.%06d.png" % step) for step in (24000, 32000, 40000)]
rows = [image[60:-60] for image in images]
left.imshow(np.vstack(rows))
left.axis("off")
right.plot(opening, P, "k", lw=1, label="material points")
right.plot(*ELEMENTS, "C1o", label="finite elements")
right.plot(*GRIFFITH, "C0--", lw=1, label="crack without a zone that softens")
right.set(xlabel="opening (mm)", ylabel="load (N/mm)")
right.legend(fontsize=8)
at = np.argmax(P)
print("largest load %.2f at %.2f, " % (P[at], opening[at]) +
      ", ".join("%.2f at %.1f" % (np.interp(x, opening, P), x) for x in (0.5, 1.0, 1.5, 2.0, 2.5)))
figure.savefig(os.path.join(HERE, "double-cantilever.png"), dpi=80)
