# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Taylor bar: a copper cylinder of 25.4 mm x 7.6 mm hits a rigid wall without friction at 190 m/s.

Error: mean of the errors of the final length, the largest diameter, and the width at 0.2 of the first length, against
the experiment (16.2, 13.5, 10.1 mm: G. R. Johnson, T. J. Holmquist, J. Appl. Phys. 64, 3901 (1988), as used by
D. Sulsky, S.-J. Zhou, H. L. Schreyer, Comput. Phys. Commun. 87, 236 (1995)).  Finite elements with the same material
give 16.27, 13.48, 10.16 mm, a mean error of 0.4 %: see examples/taylor-bar.  Both methods are measured in the same way:
a particle stands for a cube that has deformed with it.
"""
import os

import numpy as np

from common import Case, Found, dump, here, lammps, steps_and_atoms

L0 = 25.4
EXPERIMENT = {"length": 16.2, "diameter": 13.5, "width": 10.1}


def shape(x, y, z, F, volume, d):
    """length, diameter of the foot, width at 0.2 L0 (mm) of particles at the distance d"""
    half = 0.5 * d * np.linalg.norm(F, axis=1)                # of the three edges, along x, y, and z
    bottom = min(0.0, np.min(z - half[2]))
    length = np.max(z + half[2]) - bottom
    r = np.hypot(x, y)
    radial = np.array([x, y, 0 * x]) / np.maximum(r, 1e-12)
    outer = r + 0.5 * d * np.linalg.norm(np.einsum("ia,ija->ja", radial, F), axis=0)
    # mean over sectors: a lattice in a circle has corners.  Each has to have some particles of the rim
    count = int(min(48, 2 * np.pi * 3.8 / d / 1.5))
    sector = np.floor((np.arctan2(y, x) + np.pi) / (2 * np.pi) * count).astype(int) % count
    diameter = 2 * np.mean([outer[sector == k].max() for k in range(count)])
    # a smooth window of four distances to each side
    w = 4 * d
    distance = np.minimum(np.abs(z - bottom - 0.2 * L0) / w, 1.0)
    area = (volume * 0.5 * (1 + np.cos(np.pi * distance)) / w).sum()
    return {"length": length, "diameter": diameter, "width": np.sqrt(4 * area / np.pi)}


def found(values, output):
    errors = [abs(values[key] / EXPERIMENT[key] - 1) for key in EXPERIMENT]
    steps, atoms = steps_and_atoms(output)
    return Found({"mean error of the shape": 100 * float(np.mean(errors))}, atoms, steps,
                 "length %.2f, diameter %.2f, width %.2f mm" % tuple(values[k] for k in EXPERIMENT))


def mpm(h):
    def measure(folder, output):
        p = dump(os.path.join(folder, "final.dump"))
        F = np.array([p["c_F[%d]" % (k + 2)] for k in range(9)]).reshape(3, 3, -1)
        return found(shape(1e3 * p["x"], 1e3 * p["y"], 1e3 * p["z"], F, 1e9 * p["c_F[1]"], 500.0 * h), output)
    return measure


def tlsph(d):
    def measure(folder, output):
        p = dump(os.path.join(folder, "final.dump"))
        F = np.array([p["c_F[%d]" % (k + 1)] for k in range(9)]).reshape(3, 3, -1)
        return found(shape(p["x"], p["y"], p["z"], F, p["c_vol"] * p["c_F[10]"], d), output)
    return measure


def cases():
    for h in 0.001, 0.00076:
        for transfer in "aflip 1.0", "apic":
            yield Case("MPM", "h = %.3g mm, %s" % (1e3 * h, transfer),
                       [lammps("MPM", here(__file__, "in.mpm"), h=h, transfer=transfer)], mpm(h))
    for hg in 1, 10:
        yield Case("MACHDYN TLSPH", "d = 0.5 mm, hourglass %d" % hg,
                   [lammps("PEERS", here(__file__, "in.tlsph"), hg=hg)], tlsph(0.5), long=True)
