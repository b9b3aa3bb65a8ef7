# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Stress in time (history.txt) and by depth in the end (profile.txt), beside a solution in one dimension: quench.png

That solution is independent of the package: a plate without edges, whose layers y have the temperature T(y, t) of conduction
(implicit finite volumes) and, with the same strain e(t) of all of them, the stress of a perfectly plastic solid,
E/(1 - nu) (e - ALPHA (T - T0) - plastic strain), not beyond the flow stress at T; e is where the force along the plate is zero.
"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

K, G, RHO, CP, COND, H, ALPHA = 170e9, 80e9, 7850.0, 600.0, 30.0, 1e4, 12e-6
T0, OUTSIDE, R = 850.0, 20.0, 0.01
BIAXIAL = 9 * K * G / (3 * K + G) / (1 - (3 * K - 2 * G) / (6 * K + 2 * G))


def flow_stress(T):
    return 400e6 * np.interp(T, [20.0, 850.0], [1.0, 0.1])


def reference(end, n=200, steps=4000):
    """Depths, stress in the end, and the history: time, stress at the surface and in the core (sixths of R); times in
    units of that in which heat crosses R."""
    h, dt = R / n, end * RHO * CP * R * R / COND / steps
    y = (np.arange(n) + 0.5) * h
    A = np.diag(np.full(n, RHO * CP * h / dt))
    for i in range(n - 1):
        A[i:i + 2, i:i + 2] += COND / h * np.array([[1, -1], [-1, 1]])
    through = 1.0 / (1.0 / H + 0.5 * h / COND)
    A[-1, -1] += through
    inverse = np.linalg.inv(A)
    T, stress, history = np.full(n, T0), np.zeros(n), []
    for k in range(1, steps + 1):
        source = RHO * CP * h / dt * T
        source[-1] += through * OUTSIDE
        new = inverse @ source
        trial = stress - BIAXIAL * ALPHA * (new - T)
        T, limit = new, flow_stress(new)
        low, high = -0.02, 0.02                     # strain of the step, by bisection
        for _ in range(50):
            e = 0.5 * (low + high)
            if np.clip(trial + BIAXIAL * e, -limit, limit).sum() > 0.0:
                high = e
            else:
                low = e
        stress = np.clip(trial + BIAXIAL * e, -limit, limit)
        history.append((k * end / steps, stress[y > R * 5 / 6].mean(), stress[y < R / 6].mean()))
    return y, stress, np.array(history).T


y, stress, history = reference(2.0)
t, surface, core = np.loadtxt("history.txt", usecols=(0, 1, 2)).T
depth, along = np.loadtxt("profile.txt", skiprows=9, usecols=(0, 1)).T

figure, axes = plt.subplots(1, 2, figsize=(8, 3.4))
for values, exact, name, color in ((surface, history[1], "surface", "C0"), (core, history[2], "core", "C1")):
    axes[0].plot(t, values, color=color, lw=1, label=name)
    axes[0].plot(history[0], 1e-6 * exact, "k--", lw=1)
axes[0].set(xlabel="time (time in which heat crosses half of the thickness)", ylabel="stress along the plate (MPa)")
axes[0].xaxis.label.set_size(8)
axes[0].legend(fontsize=8)
axes[1].plot(1e3 * depth, 1e-6 * along, ".", ms=4, color="C1", label="points")
axes[1].plot(1e3 * y, 1e-6 * stress, "k--", lw=1, label="one dimension")
axes[1].set(xlabel="depth from the middle (mm)", ylabel="stress in the end (MPa)")
axes[1].legend(fontsize=8)
for axis in axes:
    axis.axhline(0.0, color="gray", lw=0.5)
figure.tight_layout()
figure.savefig("quench.png", dpi=100)
print("surface %.1f, reference %.1f MPa; core %.1f, reference %.1f MPa" %
      (surface[-1], 1e-6 * history[1][-1], core[-1], 1e-6 * history[2][-1]))
