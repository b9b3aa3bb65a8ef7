#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Parameters of a continuum from molecular dynamics.

Runs LAMMPS on a crystal or a fluid of one kind of atom and writes a parameter file for fix
mpm/material: density, elastic constants or viscosity, a shock equation of state from the Hugoniot,
Grueneisen parameter, specific heat, and the strength of the perfect crystal, all with error bars.
See doc/src/Howto_mpm_from_md.rst for what is done, and --help for the options.
"""

import argparse
import datetime
import math
import os
import subprocess
import sys
import tempfile

import numpy as np

BASIS = {"sc": 1, "bcc": 2, "fcc": 4, "diamond": 8}
STEP = {"lj": 0.005, "metal": 0.001, "real": 1.0}
STRESS = ("pxx", "pyy", "pzz", "pxy", "pxz", "pyz")
COLUMNS = ("step", "temp", "etotal", "press") + STRESS + ("vol", "v_m")

# pressure * volume / energy, and mass * velocity^2 / energy, as LAMMPS has them (nktv2p, mvv2e)
PRESSURE_VOLUME = {"lj": 1.0, "metal": 1.6021765e6, "real": 68568.415}
MASS_VELOCITY2 = {"lj": 1.0, "metal": 1.0364269e-4, "real": 2390.05735}

# to SI: density, pressure, velocity, energy/(mass temperature), time
TO_SI = {"metal": (1.66053907e3, 1.0e5, 1.0e2, 9.6485332e7, 1.0e-12),
         "real": (1.66053907e3, 101325.0, 1.0e5, 4.184e6, 1.0e-15)}


class Value:
    """A number with its standard error."""

    def __init__(self, value, error=0.0):
        self.value, self.error = float(value), float(abs(error))

    def __mul__(self, factor):
        return Value(self.value * factor, self.error * factor)

    def __format__(self, spec):
        return "%.5g +- %.1g" % (self.value, self.error)


def mean(samples, blocks=8):
    """Mean of a series, with the standard error of the means of blocks of it."""
    samples = np.asarray(samples, dtype=float)
    parts = [part.mean() for part in np.array_split(samples, blocks)]
    return Value(samples.mean(), np.std(parts, ddof=1) / math.sqrt(blocks))


class System:
    """What is simulated, and LAMMPS to do it."""

    def __init__(self, options):
        self.o = options
        self.dt = options.timestep or STEP[options.units]
        self.seed = options.seed
        self.pv = PRESSURE_VOLUME[options.units]

    def say(self, text):
        if not self.o.quiet:
            print(text, flush=True)

    def lammps(self, text):
        """Runs an input; the thermo output of its last run as one array for each column."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "in.md")
            with open(path, "w") as out:
                out.write(text)
            done = subprocess.run(self.o.lmp.split() + ["-in", path, "-log", "none", "-nocite"],
                                  cwd=os.path.dirname(os.path.abspath(self.o.potential)),
                                  stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True)
        if done.returncode:
            errors = [line for line in done.stdout.splitlines() if "ERROR" in line]
            sys.exit("LAMMPS has failed: " + "\n".join(errors or done.stdout.splitlines()[-5:]))
        rows = []
        for line in done.stdout.splitlines():
            words = line.split()
            if words[:1] == ["Step"]:
                rows = []
            elif len(words) == len(COLUMNS):
                try:
                    rows.append([float(word) for word in words])
                except ValueError:
                    pass
        table = np.array(rows)
        if not np.all(np.isfinite(table)):
            sys.exit("LAMMPS gave numbers that are not finite: check the potential and the time step")
        return {name: table[:, k] for k, name in enumerate(COLUMNS)}

    def weigh(self):
        """Mass of an atom; needs no forces."""
        t = self.lammps(self.head(10.0) + "pair_style none\natom_modify sort 0 0\nrun 0\n")
        self.atom_mass = t["v_m"][-1] / (BASIS[self.o.lattice] * self.o.cells**3)

    def head(self, a, every=10):
        """Crystal with the constant a; all that the runs have in common."""
        o, n = self.o, self.o.cells
        scale = BASIS[o.lattice] / a**3 if o.units == "lj" else a
        return """units %s
atom_style atomic
lattice %s %.15g
region box prism 0 %d 0 %d 0 %d 0 0 0
create_box 1 box
create_atoms 1 box
include %s
timestep %.15g
variable m equal mass(all)
thermo %d
thermo_style custom %s
thermo_modify norm no format float %%.12g
""" % (o.units, o.lattice, scale, n, n, n, os.path.abspath(o.potential), self.dt, every,
       " ".join(COLUMNS))

    def constant(self, density):
        """Lattice constant of a density (mass/distance^3)."""
        return (BASIS[self.o.lattice] * self.atom_mass / density) ** (1.0 / 3.0)

    # ---------------------------------------------------------------- crystal at rest

    def static(self, a, change=""):
        """Energy and stresses of the crystal without motion, positions relaxed when it is strained
        and has more than one atom at places that symmetry does not fix."""
        relax = "minimize 0 1.0e-10 1000 10000\n" if change and self.o.lattice == "diamond" else ""
        t = self.lammps(self.head(a) + change + relax + "run 0\n")
        return {name: column[-1] for name, column in t.items()}

    def ground_state(self):
        """Lattice constant without pressure, by the secant rule."""
        a, b = self.o.constant, 1.002 * self.o.constant
        pa, pb = self.static(a)["press"], self.static(b)["press"]
        for _ in range(40):
            if pa == pb or abs(b - a) < 1.0e-10 * b:
                break
            c = b - pb * (b - a) / (pb - pa)
            c = min(max(c, 0.95 * b), 1.05 * b)
            a, pa, b, pb = b, pb, c, self.static(c)["press"]
        else:
            sys.exit("no lattice constant without pressure near %g: check --constant" % self.o.constant)
        return b

    def stiffness(self, a):
        """Matrix C_ij with strains xx yy zz xy xz yz (shear: angles), and the change when the
        strains are twice as large."""
        def matrix(e):
            C = np.zeros((6, 6))
            for j in range(6):
                if j < 3:
                    change = "change_box all %s scale %%.15g remap\n" % "xyz"[j]
                    arguments = 1.0 + e, 1.0 - e
                else:
                    change = "change_box all %s delta %%.15g remap units box\n" % STRESS[j][1:]
                    length = self.o.cells * a
                    arguments = e * length, -e * length
                up, low = (self.static(a, change % x) for x in arguments)
                for i in range(6):
                    C[i, j] = -(up[STRESS[i]] - low[STRESS[i]]) / (2.0 * e)
            return 0.5 * (C + C.T)
        C = matrix(5.0e-4)
        return C, np.abs(matrix(1.0e-3) - C).max()

    # ---------------------------------------------------------------- states in motion

    def state(self, density, temperature, steps=None, extra="", liquid=None):
        """Means of energy, pressure, temperature of the whole system after equilibration."""
        o, steps = self.o, steps or self.o.steps
        liquid = o.phase == "fluid" if liquid is None else liquid
        damp = 100.0 * self.dt
        text = self.head(self.constant(density))
        self.seed += 1
        if liquid:    # out of the crystal's order first
            hot = max(4.0 * temperature, 4.0 * o.temperature)
            text += """velocity all create %.10g %d mom yes dist gaussian
fix move all nvt temp %.10g %.10g %.10g
run %d
unfix move
""" % (2.0 * hot, self.seed, hot, hot, damp, max(500, steps // 4))
            text += "velocity all scale %.10g\n" % temperature
        else:
            text += "velocity all create %.10g %d mom yes dist gaussian\n" % (2.0 * temperature,
                                                                             self.seed)
        text += "fix move all nvt temp %.10g %.10g %.10g\nrun %d\n%srun %d\n" % (
            temperature, temperature, damp, max(500, steps // 3), extra, steps)
        t = self.lammps(text)
        return {name: mean(column[1:]) for name, column in t.items()}

    def rest_density(self, start):
        """Density of the solid at the temperature and pressure asked for."""
        o = self.o
        self.seed += 1
        t = self.lammps(self.head(self.constant(start)) + """velocity all create %.10g %d mom yes
fix move all npt temp %.10g %.10g %.10g iso %.10g %.10g %.10g
run %d
run %d
""" % (2.0 * o.temperature, self.seed, o.temperature, o.temperature, 100 * self.dt, o.pressure,
            o.pressure, 1000 * self.dt, o.steps, 2 * o.steps))
        volume = mean(t["vol"][1:])
        density = t["v_m"][-1] / volume.value
        return Value(density, density * volume.error / volume.value)

    def hugoniot(self, density):
        """Shocked states: rows (up, Us, pressure, density, temperature) and errors of Us, by the
        energy equation E - E0 = (P + P0)/2 (V0 - V), solved for the temperature."""
        o = self.o
        start = self.state(density, o.temperature)
        mass = self.atom_mass * BASIS[o.lattice] * o.cells**3
        V0 = mass / density
        rows, errors = [], []
        hot = o.temperature
        for ratio in o.compressions:
            V = ratio * V0

            def mismatch(T):
                s = self.state(density / ratio, T)
                work = 0.5 * (s["press"].value + start["press"].value) * (V0 - V) / self.pv
                return s["etotal"].value - start["etotal"].value - work, s
            Ta = hot
            fa, state = mismatch(Ta)
            slope = 3.0 * self.boltzmann() * BASIS[o.lattice] * o.cells**3
            Tb = max(0.2 * o.temperature, Ta - fa / slope)
            for _ in range(3):
                fb, state = mismatch(Tb)
                if Tb != Ta and (fb - fa) / (Tb - Ta) > 0.2 * slope:
                    slope = (fb - fa) / (Tb - Ta)
                Ta, fa, Tb = Tb, fb, max(0.2 * o.temperature, Tb - fb / slope)
                if abs(Tb - Ta) < 0.01 * Ta:
                    break
            hot = Tb
            # the pressure at the root, along the line between the last two temperatures
            P = state["press"].value + self.gruneisen.value * slope * (Tb - Ta) * self.pv / V
            dP = P - start["press"].value
            if dP <= 0.0:
                sys.exit("no pressure rises at V/V0 = %g: the crystal is not stable there" % ratio)
            unit = 1.0 / (self.pv * mass * MASS_VELOCITY2[o.units])    # pressure * volume to velocity^2
            up = math.sqrt(dP * (V0 - V) * unit)
            Us = V0 * math.sqrt(dP / (V0 - V) * unit)
            error = math.hypot(state["press"].error, start["press"].error) / dP
            rows.append((up, Us, P, density / ratio, Tb))
            errors.append(0.5 * Us * error + 1.0e-6 * Us)
            self.say("  V/V0 %.3f  up %.5g  Us %.5g  P %.5g  T %.5g" % (ratio, up, Us, P, Tb))
        return np.array(rows), np.array(errors)

    def boltzmann(self):
        return {"lj": 1.0, "metal": 8.617343e-5, "real": 0.0019872067}[self.o.units]

    def heat(self, density):
        """Grueneisen parameter V (dP/dE)_V and specific heat, from two temperatures."""
        T = self.o.temperature
        mass = self.atom_mass * BASIS[self.o.lattice] * self.o.cells**3
        low, high = self.state(density, 0.85 * T), self.state(density, 1.15 * T)
        dE = high["etotal"].value - low["etotal"].value
        dP = high["press"].value - low["press"].value
        sE = math.hypot(high["etotal"].error, low["etotal"].error) / abs(dE)
        sP = math.hypot(high["press"].error, low["press"].error) / abs(dP)
        gamma = mass / density * dP / self.pv / dE
        cv = dE / (0.3 * T) / mass
        return Value(gamma, gamma * math.hypot(sE, sP)), Value(cv, cv * sE)

    def bulk_modulus(self, density):
        """Isothermal, by central differences of the pressure."""
        e = 0.01
        low = self.state(density * (1.0 - e), self.o.temperature)["press"]
        high = self.state(density * (1.0 + e), self.o.temperature)["press"]
        return Value((high.value - low.value) / (2.0 * e),
                     math.hypot(high.error, low.error) / (2.0 * e))

    def shear(self, density, rate, steps, liquid):
        """Series of the shear stress under simple shear in x along y at a constant rate."""
        o, T, damp = self.o, self.o.temperature, 100.0 * self.dt
        self.seed += 1
        text = self.head(self.constant(density))
        hot = 4.0 * T if liquid else T
        text += """velocity all create %.10g %d mom yes dist gaussian
fix move all nvt temp %.10g %.10g %.10g
run %d
unfix move
velocity all scale %.10g
velocity all ramp vx 0 %.15g y 0 %.15g sum yes units box
fix flow all deform 1 xy erate %.10g remap v
fix move all nvt/sllod temp %.10g %.10g %.10g
run %d
run %d
""" % (hot if liquid else 2.0 * T, self.seed, hot, hot, damp, o.steps // 2, T,
            rate * o.cells * self.constant(density), o.cells * self.constant(density), rate, T, T,
            damp, steps // 4 if liquid else 0, steps)
        return -self.lammps(text)["pxy"][1:]

    def strength(self, density):
        """Largest shear stress that the perfect crystal bears, over seeds."""
        steps = 4 * self.o.steps
        rate = self.o.rate or 0.25 / (steps * self.dt)
        steps = int(round(0.25 / (rate * self.dt)))
        peaks = []
        for _ in range(3):
            stress = self.shear(density, rate, steps, False)
            width = max(1, len(stress) // 40)
            smooth = np.convolve(stress, np.ones(width) / width, "valid")
            peaks.append(smooth.max())
        return Value(np.mean(peaks), np.std(peaks, ddof=1) / math.sqrt(3.0)), rate

    def viscosity(self, density):
        """Stress over rate, at three rates, extrapolated in the rate to none."""
        rate = self.o.rate or 5.0e-4 / self.dt
        rates = np.array([0.5, 1.0, 2.0]) * rate
        values = []
        for r, factor in zip(rates, (8, 4, 2)):
            stress = mean(self.shear(density, r, factor * self.o.steps, True))
            values.append(stress * (1.0 / r))
            self.say("  rate %.4g  viscosity %s" % (r, format(values[-1])))
        weight = 1.0 / np.array([v.error for v in values])
        fit, covariance = np.polyfit(rates, [v.value for v in values], 1, w=weight,
                                     cov="unscaled")
        error = math.hypot(math.sqrt(covariance[1, 1]), 0.5 * (fit[1] - values[0].value))
        return Value(fit[1], error), rates


def averages(C):
    """Bulk and shear modulus of the polycrystal: Hill's means, half the distance of the bounds of
    Voigt and Reuss as error (R. Hill, Proc. Phys. Soc. A 65 (1952) 349)."""
    S = np.linalg.inv(C)
    KV = (C[:3, :3].sum()) / 9.0
    KR = 1.0 / S[:3, :3].sum()
    GV = (np.trace(C[:3, :3]) - (C[0, 1] + C[0, 2] + C[1, 2])) / 15.0 + np.trace(C[3:, 3:]) / 5.0
    GR = 15.0 / (4.0 * np.trace(S[:3, :3]) - 4.0 * (S[0, 1] + S[0, 2] + S[1, 2])
                 + 3.0 * np.trace(S[3:, 3:]))
    return Value(0.5 * (KV + KR), 0.5 * (KV - KR)), Value(0.5 * (GV + GR), 0.5 * (GV - GR))


def line_fit(rows, errors):
    """Us = c0 + s up, weighted; the errors include the scatter about the line."""
    fit, covariance = np.polyfit(rows[:, 0], rows[:, 1], 1, w=1.0 / errors, cov="unscaled")
    rest = (rows[:, 1] - np.polyval(fit, rows[:, 0])) / errors
    scale = max(1.0, math.sqrt((rest**2).sum() / max(1, len(rest) - 2)))
    return (Value(fit[1], scale * math.sqrt(covariance[1, 1])),
            Value(fit[0], scale * math.sqrt(covariance[0, 0])))


def parse():
    p = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    p.add_argument("phase", choices=["solid", "fluid"])
    p.add_argument("potential", help="file of LAMMPS commands: mass, pair_style, pair_coeff")
    p.add_argument("-o", "--output", required=True, help="parameter file to write (.mpm)")
    p.add_argument("--units", choices=sorted(STEP), required=True)
    p.add_argument("--lattice", choices=sorted(BASIS), default="fcc",
                   help="crystal, and the start of a fluid")
    p.add_argument("--constant", type=float, help="lattice constant to begin with (solid)")
    p.add_argument("--density", type=float, help="mass/distance^3 (fluid)")
    p.add_argument("--temperature", type=float, required=True)
    p.add_argument("--pressure", type=float, default=0.0, help="of the solid at rest")
    p.add_argument("--cells", type=int, default=5, help="unit cells along each axis")
    p.add_argument("--steps", type=int, default=2000, help="steps of each mean value")
    p.add_argument("--compressions", type=float, nargs="+", metavar="V/V0",
                   default=[0.95, 0.90, 0.85, 0.80, 0.75])
    p.add_argument("--rate", type=float, help="of shear, for strength or viscosity")
    p.add_argument("--timestep", type=float)
    p.add_argument("--seed", type=int, default=4711)
    p.add_argument("--si", action="store_true", help="write the file in SI units")
    p.add_argument("--citation", default="computed by tools/mpm_from_md.py")
    p.add_argument("--lmp", default=os.environ.get("MPM_LMP", "lmp"), help="LAMMPS executable")
    p.add_argument("--quiet", action="store_true")
    o = p.parse_args()
    if o.phase == "solid" and not o.constant:
        p.error("a solid needs --constant")
    if o.phase == "fluid" and not o.density:
        p.error("a fluid needs --density")
    if not o.temperature > 0.0:
        p.error("--temperature must be positive")
    if o.cells < 2 or o.steps < 200:
        p.error("--cells must be at least 2, --steps at least 200")
    if not all(0.3 < r < 1.0 for r in o.compressions) or len(o.compressions) < 2:
        p.error("--compressions must be at least two values of V/V0 between 0.3 and 1")
    o.compressions = sorted(o.compressions, reverse=True)
    if o.si and o.units == "lj":
        p.error("--si is not possible with units lj")
    if not os.path.exists(o.potential):
        p.error("cannot read " + o.potential)
    return o


def main():
    o = parse()
    md = System(o)
    md.weigh()
    unit = TO_SI[o.units] if o.si else (1.0,) * 5
    lines, notes = [], []

    if o.phase == "solid":
        md.say("crystal at rest")
        a0 = md.ground_state()
        rest = md.static(a0)
        natoms = BASIS[o.lattice] * o.cells**3
        C, error = md.stiffness(a0)
        K0, G0 = averages(C)
        notes += ["Crystal at 0 K: lattice constant %.8g, energy per atom %.8g" %
                  (a0, rest["etotal"] / natoms),
                  "C11 %.6g  C12 %.6g  C44 %.6g  +- %.1g, in %s" %
                  (C[0, 0] * unit[1], C[0, 1] * unit[1], C[3, 3] * unit[1], error * unit[1],
                   "Pa" if o.si else "pressure units"),
                  "of the polycrystal: K %s, G %s (Hill; half the distance of the bounds)" %
                  (format(K0 * unit[1]), format(G0 * unit[1]))]
        for note in notes:
            md.say("  " + note)
        md.say("density at rest")
        density = md.rest_density(md.atom_mass * BASIS[o.lattice] / a0**3)
        notes.append("Density at rest %s" % format(density * unit[0]))
        md.say("  " + notes[-1])
    else:
        density = Value(o.density)

    md.say("heat")
    md.gruneisen, cv = md.heat(density.value)
    md.say("  Grueneisen parameter %s, specific heat %s" % (format(md.gruneisen), format(cv)))

    KT = md.bulk_modulus(density.value)
    energy = MASS_VELOCITY2[o.units]
    KS = Value(KT.value + md.gruneisen.value**2 * density.value * cv.value * o.temperature * md.pv,
               KT.error)
    sound = math.sqrt(max(0.0, KS.value) / md.pv / (density.value * energy))
    notes.append("Isothermal bulk modulus %s; adiabatic %s, its sound speed %.5g" %
                 (format(KT * unit[1]), format(KS * unit[1]), sound * unit[2]))
    md.say("  " + notes[-1])

    md.say("Hugoniot")
    rows, errors = md.hugoniot(density.value)
    c0, s = line_fit(rows, errors)
    notes.append("Hugoniot from %g to %g times the volume: up %.4g to %.4g, pressure up to %.4g, "
                 "%.4g K" % (o.compressions[0], o.compressions[-1], rows[0, 0] * unit[2],
                             rows[-1, 0] * unit[2], rows[-1, 2] * unit[1], rows[-1, 4]))
    if o.units == "lj":
        notes[-1] = notes[-1].replace(" K", " (temperature)")
    notes.append("C0 %s, S %s, GAMMA0 %s" % (format(c0 * unit[2]), format(s), format(md.gruneisen)))
    md.say("  " + notes[-1])

    def number(x):
        return "%.6g" % x
    lines.append("density     " + number(density.value * unit[0]))
    lines.append("eos         shock %s %s %s" % (number(c0.value * unit[2]), number(s.value),
                                               number(md.gruneisen.value)))
    if o.phase == "solid":
        md.say("strength")
        tau, rate = md.strength(density.value)
        Y = tau * math.sqrt(3.0)
        notes.append("Shear strength of the perfect crystal on (010)[100] %s at rate %.4g; "
                     "SIGMAY is 3^1/2 times that, an upper bound for real crystals" %
                     (format(tau * unit[1]), rate / unit[4]))
        md.say("  " + notes[-1])
        lines.append("strength    j2 %s %s" % (number(G0.value * unit[1]),
                                               number(Y.value * unit[1])))
    else:
        md.say("viscosity")
        eta, rates = md.viscosity(density.value)
        notes.append("Viscosity %s, from shear rates %.4g to %.4g extrapolated to none" %
                     (format(eta * (unit[1] * unit[4])), rates[0] / unit[4], rates[-1] / unit[4]))
        md.say("  " + notes[-1])
        lines.append("viscosity   newtonian %s" % number(eta.value * unit[1] * unit[4]))
    lines.append("thermal     adiabatic %s %s 1" % (number(cv.value * unit[3]), o.temperature))
    notes.append("Specific heat at constant volume %s" % format(cv * unit[3]))
    lines.append("range       pressure -INF %s" % number(rows[-1, 2] * unit[1]))

    kind = "%s of atoms, %s, at temperature %g" % (
        o.phase, "density %.6g" % (density.value * unit[0]), o.temperature)
    with open(o.output, "w") as out:
        out.write("# DATE: %s UNITS: %s CONTRIBUTOR: mpm_from_md CITATION: %s COMMENT: %s\n#\n" %
                  (datetime.date.today(), "si" if o.si else o.units, o.citation, kind))
        for line in open(o.potential):
            if line.strip() and not line.lstrip().startswith("#"):
                out.write("#   " + line.rstrip() + "\n")
        out.write("# %d atoms, means over %d steps of %g; errors are standard errors of the mean "
                  "unless said otherwise.\n" % (BASIS[o.lattice] * o.cells**3, o.steps, md.dt))
        for note in notes:
            out.write("# " + note + "\n")
        out.write("# up, Us, pressure, density, temperature on the Hugoniot:\n")
        for row in rows:
            out.write("#   %.5g %.5g %.5g %.5g %.5g\n" %
                      (row[0] * unit[2], row[1] * unit[2], row[2] * unit[1], row[3] * unit[0],
                       row[4]))
        out.write("\n" + "\n".join(lines) + "\n")
    md.say("written: " + o.output)


if __name__ == "__main__":
    main()
