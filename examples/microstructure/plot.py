# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The picture, the plastic strain in the end, and the curve of stress and strain with the bounds of both moduli and flow stress:
microstructure.png"""

import glob
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "tools"))
import picture

K, G, Y = np.array([68.6, 220.0]), np.array([26.3, 190.0]), 100.0    # GPa, MPa

with open(os.path.join(HERE, "microstructure.pgm"), "rb") as file:
    image = np.frombuffer(file.read()[-64 * 64:], np.uint8).reshape(64, 64)
share = np.array([(image == 0).mean(), (image > 0).mean()])


def young(k, g):
    return 4 * k * g / (k + g)


k = K + G / 3
voigt, reuss = young(share @ k, share @ G), 1 / (share @ (1 / young(k, G)))
strain, stress = np.loadtxt("curve.txt").T
print("E %.1f GPa, bounds %.1f and %.1f; stress in the end %.1f MPa, at least %.1f"
      % (1e-3 * stress[1] / strain[1], reuss, voigt, stress[-1], 2 / 3 ** 0.5 * Y))

figure, (left, middle, right) = plt.subplots(1, 3, figsize=(12, 3.6), constrained_layout=True)
left.imshow(image, cmap="gray", extent=(0, 64, 0, 64))
left.set(title="the picture", xlabel="mm", ylabel="mm")
last = picture.read_series(max(glob.glob("microstructure.*.vtp"), key=lambda name: int(name.split(".")[-2])))[0]
disks = picture.draw(middle, last, last.values("eplastic"), 8e-4, "xy", "magma", (0.0, 0.05))
middle.set(xlim=(0, 0.0645), ylim=(0, 0.064), xticks=[], yticks=[], title="plastic strain in the end")
middle.set_aspect("equal")
figure.colorbar(disks, ax=middle)
right.plot(100 * strain, stress, "k", label="simulation")
e = np.array([0.0, 2e-3])
right.plot(100 * e, np.minimum(1e3 * voigt * e, 400), "--", label="modulus of uniform strain (Voigt)")
right.plot(100 * e, 1e3 * reuss * e, ":", label="modulus of uniform stress (Reuss)")
right.axhline(2 / 3 ** 0.5 * Y, color="gray", lw=0.8, label="the matrix alone yields")
right.set(xlim=(0, None), ylim=(0, 1.25 * stress.max()), xlabel="strain (%)", ylabel="mean stress (MPa)")
right.legend(fontsize=8)
figure.savefig(os.path.join(HERE, "microstructure.png"), dpi=110)
