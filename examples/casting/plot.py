# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Share that is liquid and stress in time (history.txt), and stress by depth in the end (profile.txt), beside a solution
in one dimension: casting.png

That solution is independent of the package: a plate without edges, whose layers y get their temperature and their solid share by
the enthalpy (explicit finite volumes) and, with the same strain e(t) of all of them, the stress of a perfectly plastic solid,
E/(1 - nu) (e - ALPHA (T - T0) - plastic strain) times the solid share, not beyond that share of the flow stress at T. What
melts has no stress, what freezes begins without any; e is where the force along the plate is zero.
"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

K, G, RHO, CP, COND, H, ALPHA = 170e9, 80e9, 7850.0, 600.0, 30.0, 1e4, 12e-6
T0, OUTSIDE, R, MELT, OVER, LATENT = 1500.0, 20.0, 0.01, 1400.0, 60.0, 2.7e5
BIAXIAL = 9 * K * G / (3 * K + G) / (1 - (3 * K - 2 * G) / (6 * K + 2 * G))
TEMPERATURES = np.array([0.0, MELT, MELT + OVER, 3000.0])
ENTHALPIES = CP * TEMPERATURES + LATENT * (TEMPERATURES > MELT)


def flow_stress(T):
    return 400e6 * np.interp(T, [20.0, 1400.0], [1.0, 0.02])


def solid_share(T):
    return np.clip(1.0 - (T - MELT) / OVER, 0.0, 1.0)


def reference(end, n=100, every=10):
    """Depths, stress in the end, and the history: time, stress at the surface and in the core (sixths of R), share that is
    liquid; times in units of that in which heat crosses R. Stress is found in each tenth step."""
    h, unit = R / n, RHO * CP * R * R / COND
    steps = every * int(np.ceil(end * unit / (0.4 * h * h * RHO * CP / COND) / every))
    dt = end * unit / steps
    y = (np.arange(n) + 0.5) * h
    T, stress, flux, history = np.full(n, T0), np.zeros(n), np.zeros(n + 1), []
    enthalpy, through = np.interp(T, TEMPERATURES, ENTHALPIES), 1.0 / (1.0 / H + 0.5 * h / COND)
    old, before = T, solid_share(T)
    for k in range(1, steps + 1):
        flux[1:-1] = COND * (T[:-1] - T[1:]) / h
        flux[-1] = through * (T[-1] - OUTSIDE)
        enthalpy = enthalpy - dt / (RHO * h) * np.diff(flux)
        T = np.interp(enthalpy, ENTHALPIES, TEMPERATURES)
        if k % every:
            continue
        solid = solid_share(T)
        kept = np.where(before > 0.0, np.minimum(solid / np.maximum(before, 1e-30), 1.0), 0.0)
        stiff, limit = solid * BIAXIAL, solid * flow_stress(T)
        trial = kept * stress - stiff * ALPHA * (T - old)
        low, high = -0.02, 0.02                     # strain of these steps, by bisection
        for _ in range(45):
            e = 0.5 * (low + high)
            if np.clip(trial + stiff * e, -limit, limit).sum() > 0.0:
                high = e
            else:
                low = e
        stress, old, before = np.clip(trial + stiff * e, -limit, limit), T, solid
        history.append((k * dt / unit, stress[y > R * 5 / 6].mean(), stress[y < R / 6].mean(), 1.0 - solid.mean()))
    return y, stress, np.array(history).T


y, stress, history = reference(2.0)
t, surface, core, liquid = np.loadtxt("history.txt", usecols=(0, 1, 2, 3)).T
depth, along = np.loadtxt("profile.txt", skiprows=9, usecols=(0, 1)).T

figure, axes = plt.subplots(1, 3, figsize=(11, 3.4))
axes[0].plot(t, liquid, color="C2", lw=1, label="points")
axes[0].plot(history[0], history[3], "k--", lw=1, label="one dimension")
axes[0].set(ylabel="share that is liquid", xlim=(0, 0.6))
for values, exact, name, color in ((surface, history[1], "surface", "C0"), (core, history[2], "core", "C1")):
    axes[1].plot(t, values, color=color, lw=1, label=name)
    axes[1].plot(history[0], 1e-6 * exact, "k--", lw=1)
axes[1].set(ylabel="stress along the plate (MPa)")
for axis in axes[:2]:
    axis.set_xlabel("time (time in which heat crosses half of the thickness)", fontsize=8)
axes[2].plot(1e3 * depth, 1e-6 * along, ".", ms=4, color="C1", label="points")
axes[2].plot(1e3 * y, 1e-6 * stress, "k--", lw=1, label="one dimension")
axes[2].set(xlabel="depth from the middle (mm)", ylabel="stress in the end (MPa)")
for axis in axes:
    axis.axhline(0.0, color="gray", lw=0.5)
    axis.legend(fontsize=8)
figure.tight_layout()
figure.savefig("casting.png", dpi=100)
print("surface %.1f, reference %.1f MPa; core %.1f, reference %.1f MPa" %
      (surface[-1], 1e-6 * history[1][-1], core[-1], 1e-6 * history[2][-1]))
for share in (0.5, 0.25, 0.01):
    print("liquid %.2f at %.4f, reference %.4f" % (share, np.interp(-share, -liquid, t), np.interp(-share, -history[3], history[0])))
