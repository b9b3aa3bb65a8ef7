# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Steady seepage through the levee by finite volumes on squares, with the soil of in.levee, for README.md

Richards' equation in steps of time that become longer, each by Picard's iteration of the mixed form; heads in m.
"""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

k, alpha, n, level = 0.5, 3.0, 2.0, 1.6
m = 1 - 1 / n


def effective(h):
    return np.where(h < 0, (1 + (alpha * np.maximum(-h, 0))**n)**-m, 1.0)


def water(h):
    return 0.04 + 0.36 * effective(h) + 1e-3 * h


def storage(h):
    a = alpha * np.maximum(-h, 0)
    return 0.36 * (n - 1) * alpha * a**(n - 1) * (1 + a**n)**(-m - 1) + 1e-3


def mobility(h):
    S = effective(h)
    return k * np.sqrt(S) * (1 - (1 - S**(1 / m))**m)**2


def steady(dx):
    """Flow through the levee (m^2/s), and the heads at the centers x, y of the cells."""
    x, y = np.meshgrid(np.arange(0.5 * dx, 3.5, dx), np.arange(0.5 * dx, 2.0, dx), indexing="ij")
    soil = 2 * x + 2.5 * y < 7.0
    number = np.full((x.shape[0] + 2, x.shape[1] + 2), -1)
    cell = number[1:-1, 1:-1]
    cell[soil] = np.arange(soil.sum())
    x, y = x[soil], y[soil]
    pairs = [(a[(a >= 0) & (b >= 0)], b[(a >= 0) & (b >= 0)])
             for a, b in ((cell[:-1], cell[1:]), (cell[:, :-1], cell[:, 1:]))]
    wall = cell[0][cell[0] >= 0]
    wet = wall[y[wall] < level]
    air = np.concatenate([cell[soil & (number[2:, 1:-1] < 0)], cell[soil & (number[1:-1, 2:] < 0)], wall[y[wall] > level]])
    h, dt = -(y + 1.0), 1e-3
    while dt < 1e4:
        now = h.copy()
        for turn in range(60):
            K, C = mobility(now), storage(now) * dx * dx / dt
            diagonal, right = C.copy(), C * now - (water(now) - water(h)) * dx * dx / dt
            rows, columns, values = [], [], []
            for a, b in pairs:
                g = 0.5 * (K[a] + K[b])
                rows += [a, b]
                columns += [b, a]
                values += [-g, -g]
                for i, other in ((a, b), (b, a)):
                    np.add.at(diagonal, i, g)
                    np.add.at(right, i, g * (y[other] - y[i]))
            g = K[wet] + k
            np.add.at(diagonal, wet, g)
            np.add.at(right, wet, g * (level - y[wet]))
            np.add.at(diagonal, air, 2 * k * (now[air] > 0))
            every = np.arange(len(h))
            matrix = coo_matrix((np.concatenate(values + [diagonal]),
                                 (np.concatenate(rows + [every]), np.concatenate(columns + [every]))))
            new = spsolve(matrix.tocsc(), right)
            change = abs(new - now).max()
            now = new if turn < 20 else 0.5 * (now + new)
            if change < 1e-6:
                break
        if change < 1e-6:
            h, dt = now, 1.5 * dt
        else:
            dt *= 0.4
    return 2 * k * np.maximum(h[air], 0).sum(), x, y, h


if __name__ == "__main__":
    for dx in (0.1, 0.05):
        print("cells of %g m: %.4f m^2/s" % (dx, steady(dx)[0]))
