#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""The body at the end of the run, and the profile of the scalar with the exact one: plot.py [folder], after the run."""

import math
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "tools"))
from picture import read_series, row, usual_distance

folder = sys.argv[1] if len(sys.argv) > 1 else "."
DIFFUSIVITY = 1.0    # D of the input
end = read_series(os.path.join(folder, "own-physics.pvd"))[-1]
x, c = end.x[:, 0], end.fields["f_scalar[1]"]

figure, (body, profile) = plt.subplots(2, 1, figsize=(8, 6), layout="constrained",
                                       gridspec_kw={"height_ratios": (1, 1.3)})
disks = row([body], [end], "f_scalar[1]", 1.35 * usual_distance(end.x), "xy", limits=(0.0, 1.0))
figure.colorbar(disks, ax=body, label="scalar c", pad=0.01)
line = np.linspace(0, 20, 400)
profile.plot(x, c, "C0.", ms=4, label="points")
profile.plot(line, [math.erfc(at / math.sqrt(4 * DIFFUSIVITY * end.time)) for at in line], "k", lw=1,
             label="erfc(x / sqrt(4 D t))")
profile.set(xlabel="x", ylabel="scalar c", xlim=(0, 20), ylim=(0, 1))
profile.legend()
figure.suptitle("A scalar diffuses into a body that moves upwards")
figure.savefig(os.path.join(folder, "own-physics.png"), dpi=80)
