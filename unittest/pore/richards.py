#!/usr/bin/python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Flow in partly saturated columns by finite volumes: where numbers in test_pore_suction.cpp come from.

dtheta/dt = d/dz [K (dh/dz + 1)], the mixed form, backward Euler and Newton's method, the mean of the permeabilities on the
faces of cells (M.A. Celia, E.T. Bouloutas, R.L. Zarba, Water Resour. Res. 26 (1990) 1483). Heads in m, z upwards.
"""

import numpy as np


class VanGenuchten:
    def __init__(self, alpha, n, residual, full, K):
        self.alpha, self.n, self.m, self.residual, self.full, self.K = alpha, n, 1 - 1 / n, residual, full, K

    def effective(self, h):
        return np.where(h < 0, (1 + (self.alpha * np.maximum(-h, 0)) ** self.n) ** -self.m, 1.0)

    def content(self, h):
        return self.residual + (self.full - self.residual) * self.effective(h)

    def permeability(self, h):
        S = self.effective(h)
        return self.K * np.sqrt(S) * (1 - (1 - S ** (1 / self.m)) ** self.m) ** 2


class Gardner(VanGenuchten):
    def __init__(self, alpha, residual, full, K):
        self.alpha, self.residual, self.full, self.K = alpha, residual, full, K

    def effective(self, h):
        return np.exp(self.alpha * np.minimum(h, 0))

    def permeability(self, h):
        return self.K * self.effective(h)


def column(soil, L, cells, start, bottom, top, times, steps, flux=None):
    """Heads in cells at these times. bottom, top: heads at the ends, or flux: what comes in at the top."""
    dz = L / cells
    z = (np.arange(cells) + 0.5) * dz
    h = start(z)
    results, now, came = [], 0.0, 0.0

    def flows(h):    # upwards, on the faces
        K = soil.permeability(h)
        inner = -0.5 * (K[1:] + K[:-1]) * ((h[1:] - h[:-1]) / dz + 1)
        low = -0.5 * (soil.permeability(np.array(bottom)) + K[0]) * ((h[0] - bottom) / (0.5 * dz) + 1)
        if flux is not None:
            high = -flux
        else:
            high = -0.5 * (soil.permeability(np.array(top)) + K[-1]) * ((top - h[-1]) / (0.5 * dz) + 1)
        return np.concatenate([[low], inner, [high]])

    for end in times:
        dt = (end - now) / steps
        for _ in range(steps):
            before = soil.content(h)
            for _ in range(50):
                def rest(h):
                    return (soil.content(h) - before) / dt + np.diff(flows(h)) / dz
                r = rest(h)
                # three colors of a matrix with three diagonals
                J = np.zeros((3, cells))
                e = 1e-7 * np.maximum(np.abs(h), 1e-2)
                for color in range(3):
                    d = np.zeros(cells)
                    d[color::3] = e[color::3]
                    change = rest(h + d) - r
                    for k in range(color, cells, 3):
                        for row in (k - 1, k, k + 1):
                            if 0 <= row < cells:
                                J[1 + row - k, k] = change[row] / e[k]
                from scipy.linalg import solve_banded
                step = solve_banded((1, 1), J, -r)
                h = h + np.clip(step, -2.0, 2.0)
                if np.max(np.abs(step)) < 1e-9:
                    break
            came -= dt * flows(h)[-1]
        now = end
        results.append((end, z, h.copy(), came))
    return results


if __name__ == "__main__":
    soil = VanGenuchten(3.35, 2.0, 0.102, 0.368, 9.22e-5)
    for cells, steps in ((200, 500), (400, 1000), (800, 2000)):
        end, z, h, came = column(soil, 1.0, cells, lambda z: -10 + 0 * z, -10.0, -0.75, [86400.0], steps)[0]
        front = np.interp(-5.0, h, z)
        print(f"Celia, {cells} cells: front (-5 m) at depth {1 - front:.5f}, infiltration {came:.6f} m,",
              "heads at depths .1 .2 .3 .4 .5:", np.round(np.interp([.9, .8, .7, .6, .5], z, h), 4))

    soil = Gardner(4.0, 0.06, 0.4, 0.1)
    at = np.array([0.1, 0.25, 0.5, 0.75, 0.9])
    for cells, steps in ((100, 400), (400, 1600)):
        for end, z, h, came in column(soil, 1.0, cells, lambda z: np.log(0.1 + 0.9 * np.exp(-4 * z)) / 4, 0.0, None,
                                      [0.2, 0.5, 1.0, 4.0], steps, flux=0.09):
            print(f"Gardner, {cells} cells, t = {end}: heads at {at}:", np.round(np.interp(at, z, h), 5))
