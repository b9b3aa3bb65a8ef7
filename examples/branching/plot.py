# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The plate at three times, and the tip of the crack and its energy over time: branching.png"""

import os

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
RAYLEIGH = 2125.21    # speed of surface waves, plane strain (m/s)

us, x, y, energy = np.loadtxt("curve.txt").T[1:]
begun = x > 50.2
figure, axes = plt.subplots(2, 2, figsize=(10, 5), constrained_layout=True)
for one, step in zip(axes.flat, (600, 1000, 1400)):
    one.imshow(plt.imread("branching.%05d.png" % step))
    one.axis("off")
last = axes[1, 1]
last.plot(us[begun], x[begun], "k", label="tip, x (mm)")
last.plot(us[begun], y[begun], "C1", label="distance of branches from the axis (mm)")
last.plot(us[begun], 100 * energy[begun], "C0--", label="energy of cracks (10 mJ per m)")
last.set(xlabel="time (us)")
last.legend(fontsize=8)
branches = us[begun][np.argmax(y[begun] > 1.0)]
before = begun & (us < branches)
speed = np.polyfit(us[before], x[before], 1)[0] * 1e3
print("starts at %.1f us, branches at %.1f us, speed until then %.0f m/s, %.2f of that of Rayleigh waves"
      % (us[begun][0], branches, speed, speed / RAYLEIGH))
figure.savefig(os.path.join(HERE, "branching.png"), dpi=80)
