# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Velocities and motion of the crest (slope.txt), and plastic strain at the end (slope.dump): earthquake-slope.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

H, C, RATIO, F = 20.0, 200.0, 0.25, 2.0    # of the layer: depth, speed of shear waves, impedance over that of rock; pulse


def layer(t, peak):
    """velocity of the top of level ground: echoes between rock and top, each -(1 - z)/(1 + z) of the one before"""
    v = np.zeros_like(t)
    for n in range(40):
        a = (np.pi * F * (t - (2 * n + 1) * (H - 0.5) / C - 0.7)) ** 2
        v += 2 / (1 + RATIO) * (-(1 - RATIO) / (1 + RATIO)) ** n * peak * (1 - 2 * a) * np.exp(-a)
    return v


_, t, rock, ground, crest, x, y, _ = np.loadtxt("slope.txt").T
px, py, strain = np.loadtxt("slope.dump", skiprows=9, usecols=(1, 2, 3)).T
exact = layer(t, rock.max())
print("ground, largest velocity: %.3f m/s, elastic layer %.3f m/s" % (abs(ground).max(), abs(exact).max()))
print("crest: %.3f m/s, moved by %.3f m outward and %.3f m down" % (abs(crest).max(), x[-1], -y[-1]))

figure = plt.figure(figsize=(9, 6))
top = figure.add_subplot(2, 2, 1)
top.plot(t, rock, color="0.7", label="rock without soil")
top.plot(t, exact, "k:", label="level ground, elastic layer")
top.plot(t, ground, label="level ground")
top.plot(t, crest, label="crest")
top.set(xlabel="time (s)", ylabel="velocity along x (m/s)", xlim=(0, 3))
top.legend(fontsize=8)
side = figure.add_subplot(2, 2, 2)
side.plot(t, 100 * x, label="outward")
side.plot(t, -100 * y, label="down")
side.set(xlabel="time (s)", ylabel="motion of the crest (cm)", xlim=(0, 3))
side.legend()
bottom = figure.add_subplot(2, 1, 2)
dots = bottom.scatter(px, py, c=100 * strain, s=1.5, vmax=np.quantile(100 * strain, 0.998), cmap="viridis")
bottom.set(aspect="equal", xlim=(-70, 70), xlabel="x (m)", ylabel="y (m)")
figure.colorbar(dots, ax=bottom, label="plastic strain (%)", shrink=0.8)
figure.tight_layout()
figure.savefig("earthquake-slope.png", dpi=100)
