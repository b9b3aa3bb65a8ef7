# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Sand column, 1.5 times as high as wide or a little more, in a channel: how far does it run out, how high is the heap?

Errors: of the run-out and of the final height against the laws of experiments with several kinds of grains in a channel
(G. Lube, H. E. Huppert, R. S. J. Sparks, A. Freundt, Phys. Rev. E 72, 041301 (2005)): for columns a times as high as
wide (width L), the run-out is 1.2 a L for a < 2.3 and 1.9 a^(2/3) L above; the height is a L for a < 1.15 and
0.65 a^0.4 L above.  Each run is compared with the laws for the height that it begins with.

The material law of the points has the angle of repose of the experiments, 30 degrees (see examples/sand-column).
Spheres have a friction of 0.5 and a rolling friction that stands for the shape of real grains; neither is fitted.
The front is where the heap is less than a quarter of a grain (cell) deep, in strips of two grains (cells); the height
is that of the highest grain or point at x < L/10.
"""
import os

import numpy as np

from common import Case, Found, dump, here, lammps, result, steps_and_atoms

L = 0.1


def laws(a):
    return (1.2 * a if a < 2.3 else 1.9 * a**(2.0 / 3.0)), (a if a < 1.15 else 0.65 * a**0.4)


def heap(up, n):
    """up: name of the vertical coordinate; n: grains or cells in the width"""
    def measure(folder, output):
        p = dump(os.path.join(folder, "final.dump"))
        d = L / n
        strip = np.floor(p["x"] / (2 * d)).astype(int)
        depth = np.bincount(strip, weights=p["v_volume"]) / (2 * d)
        low = np.nonzero(depth < 0.25 * d)[0]
        end = low[0] if len(low) else len(depth)
        # between the middles of two strips
        before, after = depth[end - 1], (depth[end] if end < len(depth) else 0.0)
        front = 2 * d * (end - 0.5 + (before - 0.25 * d) / (before - after))
        high = p[up][p["x"] < 0.1 * L].max() + 0.25 * d * (2 if up == "z" else 1)
        a = result(output)["H"]
        run, height = laws(a)
        steps, atoms = steps_and_atoms(output)
        X, H = front / L - 1, high / L
        return Found({"run-out": 100 * abs(X / run - 1), "height": 100 * abs(H / height - 1)}, atoms, steps,
                     "a %.2f: run-out %.2f (law %.2f), height %.2f (law %.2f)" % (a, X, run, H, height))
    return measure


def cases():
    for transfer in "apic", "aflip 1.0":
        yield Case("MPM", "L/20, " + transfer,
                   [lammps("MPM", here(__file__, "in.mpm"), a=1.5, transfer=transfer)], heap("y", 20))
    for roll in 0, 0.2:
        yield Case("DEM", "d = L/20, rolling friction %g" % roll,
                   [lammps("PEERS", here(__file__, "in.dem"), a=1.5, roll=roll)], heap("z", 20), long=True)
