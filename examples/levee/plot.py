# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Factors of safety of the slope with the water that the run has (levee.*.txt), and levee.png

Circles through the levee as it was at first, simplified method of Bishop with the friction of 34 degrees and no cohesion; water takes
the share (S - 0.1)/0.9 of its pressure p (A.W. Bishop, Geotechnique 5 (1955) 7)."""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from scipy.interpolate import NearestNDInterpolator, LinearNDInterpolator

TAN, G = np.tan(np.radians(34.0)), 9.81
THINNEST = 0.15    # of the slices at their deepest place (m)


def surface(x):
    return np.where(x < 1, 2.0, np.maximum(0.0, (7 - 2 * x) / 2.5))


def on_lattice(x, y, values, places):
    inside = LinearNDInterpolator(np.c_[x, y], values)(places)
    return np.where(np.isnan(inside), NearestNDInterpolator(np.c_[x, y], values)(places), inside)


def safety(x, y, S, p):
    """The smallest factor of all circles, and the circle: center and radius."""
    gx, gy = np.linspace(0, 3.5, 141), np.linspace(0, 2, 81)
    X, Y = np.meshgrid(gx, gy, indexing="ij")
    places = np.c_[X.ravel(), Y.ravel()]
    S, p = (on_lattice(x, y, values, places).reshape(X.shape) for values in (S, p))
    dx, dy = gx[1], gy[1]
    rho = np.where(Y < surface(X), 1600 + 400 * S, 0.0)
    weight = G * dy * np.cumsum(rho[:, ::-1], axis=1)[:, ::-1]

    def at(field, x, y):
        i, j = np.minimum(x / dx, 139.999), np.minimum(y / dy, 79.999)
        a, b = i.astype(int), j.astype(int)
        u, v = i - a, j - b
        return ((1 - u) * (1 - v) * field[a, b] + u * (1 - v) * field[a + 1, b] + (1 - u) * v * field[a, b + 1] +
                u * v * field[a + 1, b + 1])

    best = (np.inf, 0, 0, 0)
    xs = np.linspace(0, 3.5, 281)
    width = xs[1]
    for cx in np.arange(1.0, 6.0, 0.25):
        for cy in np.arange(1.5, 6.0, 0.25):
            for R in np.arange(0.5, cy + 1e-9, 0.1):
                bottom = cy - np.sqrt(np.maximum(R * R - (xs - cx)**2, 0))
                k = np.flatnonzero((R > abs(xs - cx)) & (bottom < surface(xs) - 1e-6))
                if len(k) < 12 or k[0] == 0 or k[-1] - k[0] + 1 != len(k):
                    continue
                x, y = xs[k], bottom[k]
                if (surface(x) - y).max() < THINNEST:
                    continue
                sine = (cx - x) / R
                cosine = np.sqrt(1 - sine**2)
                W = at(weight, x, y)
                hold = np.maximum(0, W - at((S - 0.1) / 0.9 * p, x, y)) * TAN
                drive = (W * sine).sum()
                F = 1.0
                for _ in range(60):
                    new = (hold / (cosine + sine * TAN / F)).sum() / drive
                    if abs(new - F) < 1e-5:
                        break
                    F = new
                if new < best[0]:
                    best = (new, cx, cy, R)
    return best


figure, axes = plt.subplots(3, 2, figsize=(9, 6.2), sharex=True, sharey=True)
for k, axis in enumerate(axes.T.flat):
    with open("levee.%d.txt" % (k + 1)) as file:
        head = [next(file) for _ in range(9)]
        x, y, S, p = np.loadtxt(file).T
    time = (1.5, 3.5, 4.0, 4.5, 5.0, 8.0)[k]
    dots = axis.scatter(x, y, c=S, s=4, cmap="YlGnBu", vmin=0, vmax=1)
    axis.set(aspect="equal", xlim=(0, 5), ylim=(0, 2.2))
    title = "%g s" % time
    if k < 4:
        F, cx, cy, R = safety(x, y, S, p)
        print("%g s: factor of safety %.2f, circle around (%.2f, %.2f) with the radius %.1f" % (time, F, cx, cy, R))
        title += ", factor of safety %.2f" % F
        a = np.linspace(0, 3.5, 400)
        bottom = cy - np.sqrt(np.maximum(R * R - (a - cx)**2, 0))
        cut = (R > abs(a - cx)) & (bottom < surface(a))
        axis.plot(a[cut], bottom[cut], "r-", lw=1)
    axis.set_title(title, fontsize=9)
figure.tight_layout()
figure.colorbar(dots, ax=axes, label="saturation", shrink=0.6)
figure.savefig("levee.png", dpi=90)
