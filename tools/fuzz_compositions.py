# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Scenes in which the physics of the package meet, for fuzz.py and matrix.py.

A composition has a base, which says how the points move, and up to five parts, which act on them.  Each is
a function with the composition as its argument: it appends commands to the lists below, or changes the
options of a fix mpm, and says what must hold.  Lengths are in cells, all other values in shares of those of
the scene, by the functions length(), velocity(), stress(), and so on, so that one seed is the same scene in
all unit styles.  To add a physics, write such a function and append it to PARTS.
"""

import os
import random as random_numbers
import sys

from fuzz_scenes import CUBE, LOOSE, SOLIDS, UNITS

sys.path.insert(0, os.path.join(os.environ.get("MPM_ROOT", os.path.dirname(os.path.dirname(os.path.abspath(
    __file__)))), "unittest", "docs"))

import docs_scenes    # noqa: E402  (of unittest)


class Unfit(Exception):
    """The part cannot be put into this scene, whatever the package says to it."""


class Composition:
    """One scene of a seed, with random parts or given ones; length: factor of all lengths and times.

    fields: fix mpm, each its ID, group, and options by keyword, first the one that others act on
    materials: ID, group, density, law, and what parts have appended to the law
    bodies: group and corners (xlo, xhi, ylo, yhi, zlo, zhi) in cells
    settings, before, define, fill, physics: commands that are not in restart files, those before the points,
        fix mpm and their like, commands that make points, and all others
    checks: (name, expression that must not change, expression of its scale, tolerance)
    ledger: the residual of compute mpm/energy is round-off
    free: nothing outside acts on the points, so that their momentum is constant
    loose: ranks and restarts may differ by so much more than by round-off, where a solver stops at a tolerance
    """

    def __init__(self, seed, names=None, units=None, dimension=None, length=1.0):
        pick = self.pick = random_numbers.Random("composition %d" % seed)
        other = random_numbers.Random("other %d" % seed)    # so that all else is the same in other units
        self.seed, self.asked, self.files = seed, names, {}
        self.units = units or other.choice(sorted(UNITS))
        self.h, self.density, self.speed, self.mvv2e, nktv2p = UNITS[self.units]
        self.h *= length
        self.modulus = self.density * self.speed ** 2 * self.mvv2e * nktv2p
        self.dimension = dimension or pick.choice((2, 2, 3))
        self.size = (14, 12, 1) if self.dimension == 2 else (12, 8, 7)
        self.periodic = [pick.random() < 0.25 for _ in range(3)]
        self.axisymmetric = False
        self.fields, self.materials, self.bodies = [], [], []
        self.settings, self.before, self.define, self.fill, self.physics = [], [], [], [], []
        self.checks, self.columns, self.mass = [], [], "mass(all)"
        self.free, self.ledger, self.loose, self.style, self.step = True, True, 1.0, "mpm", ""
        self.balance = pick.choice(("", "shift xy 4 1.05", "shift x 4 1.05", "rcb"))
        self.ranks = pick.choice((2, 2, 3))
        found = self.random_names()
        self.names = sorted(names or found, key=list(ALL).index)
        for name in list(self.names):
            try:
                ALL[name](self)
            except Unfit:
                if names:
                    raise
                self.names.remove(name)

    def random_names(self):
        pick = self.pick
        base = pick.choice(("field",) * 6 + ("contact",) * 3 + ("flow",) * 3 + ("refine", "mixture", "mesh") * 2)
        fit = [name for name, part in PARTS.items() if base in FITS.get(name, ("field", "contact", "refine", "mixture"))]
        return [base] + pick.sample(fit, min(len(fit), pick.choice((1, 2, 2, 3, 3, 4, 5))))

    # ------------------------------------------------------------ values of the scene

    def length(self, cells):
        return "%.15g" % (cells * self.h)

    def velocity(self, share):
        return "%.15g" % (share * self.speed)

    def time(self, share):
        """share of the time that waves take for a cell"""
        return "%.15g" % (share * self.h / self.speed)

    def stress(self, share):
        return "%.15g" % (share * self.modulus)

    def mass_density(self, share):
        return "%.15g" % (share * self.density)

    def viscosity(self, share):
        return "%.15g" % (share * self.modulus * self.h / self.speed)

    def acceleration(self, share):
        return "%.15g" % (share * self.speed ** 2 / self.h)

    def energy(self, share):
        """share of the energy of a cell at the speed of waves"""
        return share * self.density * self.h ** 3 * self.speed ** 2 * self.mvv2e

    def heat_capacity(self):
        """per mass: a temperature difference of 100 is the energy of the speed of waves"""
        return 0.01 * self.speed ** 2 * self.mvv2e

    def conductivity(self, share):
        """heat crosses a cell in 1/share times the time of waves"""
        return share * self.density * self.heat_capacity() * self.h * self.speed

    def vector(self, x, y, z=0.0, scale=None):
        scale = scale or self.velocity
        return "%s %s %s" % (scale(x), scale(y), scale(z if self.dimension == 3 else 0.0))

    def block(self, name, low_high):
        """A region command."""
        corners = [word if word in ("INF", "EDGE") else self.length(word) for word in low_high]
        if self.dimension == 2:
            corners[4:] = ["INF", "INF"]
        return "region %s block %s" % (name, " ".join(corners))

    def top(self, name, body=0):
        """A plane on top of a body, as a region."""
        return "region %s plane 0 %s 0 0 -1 0" % (name, self.length(self.bodies[body][1][3]))

    def has(self, *names):
        return any(name in self.names for name in names)

    def law(self, laws):
        pick = self.pick
        e = self.modulus * pick.choice((1.0, 0.5))
        return pick.choice(laws).format(E="%.15g" % e, c1="%.15g" % (0.3 * e), c2="%.15g" % (0.05 * e),
                                        Y="%.15g" % (0.01 * e), M="%.15g" % (0.02 * e * self.h / self.speed))

    # ------------------------------------------------------------ inputs

    def make(self, again=False):
        """All commands up to the first run; again: after read_restart."""
        faces = " ".join("p" if periodic or d >= self.dimension else "f" for d, periodic in enumerate(self.periodic))
        box = [0, self.size[0], 0, self.size[1]] + ([0, self.size[2]] if self.dimension == 3 else [-0.5, 0.5])
        lines = ["units " + self.units]
        settings = ["neighbor %s bin" % self.length(0.5)] + self.settings
        if self.balance == "rcb" and (self.style != "mpm" or self.has("cells", "penalty")):
            self.balance = "shift xy 4 1.05"    # CommTiled of LAMMPS lacks what these need
        if self.has("cells"):
            self.balance = ""    # LAMMPS's fix ave/grid crashes with fix balance
        if self.balance == "rcb":
            settings.append("comm_style tiled")
        if again:
            lines += ["read_restart half.restart"] + settings
        else:
            lines += ["dimension %d" % self.dimension, "boundary " + faces, "atom_style " + self.style] + settings + [
                "region box block " + " ".join(self.length(c) for c in box), "create_box 4 box"]
            lines += ["group body%d type %d" % (k, k) for k in (1, 2, 3)] + ["group points type 1 2 3"]
        lines += self.before
        for name, group, options in self.fields:
            lines.append("fix %s %s mpm %s %s" % (name, group, self.length(options.get("h", 1)), " ".join(
                "%s %s" % item for item in options.items() if item[0] != "h")))
        lines += self.define
        if not again:
            lines += self.fill + ["group body%d type %d" % (k, k) for k in (1, 2, 3)] + ["group points type 1 2 3"]
        lines += ["fix %s %s mpm/material density %s %s" % material for material in map(tuple, self.materials)]
        lines += self.physics + [self.step or "fix dt all mpm/dt %.3g max %s" % (0.2, self.time(0.3))]
        if self.balance:
            lines.append("fix even all balance 4 1.0 " + self.balance)
        names = ["stress/*", "F/*"] + [name for name, _ in self.columns]
        lines.append("compute state points mpm/atom " + " ".join(names))
        words = "thermo_style custom step time atoms"
        if self.fields and self.ledger:
            lines.append("compute ledger all mpm/energy")
            words += " c_ledger c_ledger[*]"
        return lines + ["thermo 6", words, "thermo_modify norm no format float %.15g"]

    def output(self, name):
        return ("write_dump all custom %s id type mass xu yu zu vx vy vz c_state[*] "
                "modify sort id format float %%.17g" % name)

    def all_checks(self):
        found = list(self.checks)
        found.append(("mass", self.mass, "mass(all)", 1e-12))
        return found

    def first(self, steps=12, half=True, between=()):
        """Some steps, a restart file, and as many steps again; or all of them in one run."""
        lines = self.make() + ["run 0", self.output("state.0")]
        for name, what, _, _ in self.all_checks():
            lines += ["variable %s equal %s" % (name, what),
                      "variable %s0 equal $(v_%s:%%.17g)" % (name, name)]
        lines += ["run %d" % steps, "write_restart half.restart"] + list(between) + [
            "run %d" % steps] if half else ["run %d" % (2 * steps)]
        lines.append(self.output("state.1"))
        for name, _, scale, tolerance in self.all_checks():
            lines.append('print "CHECK %s $(v_%s-v_%s0:%%.17g) $(%s:%%.17g) %g"' % (name, name, name, scale, tolerance))
        return "\n".join(lines) + "\n"

    def second(self, steps=12):
        """The second half, from the restart file."""
        return "\n".join(self.make(again=True) + ["run %d" % steps, self.output("state.2")]) + "\n"

    def redefined(self):
        """A fix is removed between two runs, and defined again, now and then some steps later."""
        pick = random_numbers.Random("redefined %d" % self.seed)
        lines = [line for line in self.make(again=True) if line.startswith("fix ")]
        line = pick.choice(lines)
        between = ["unfix " + line.split()[1]]
        if pick.random() < 0.4:
            between.append("run 3")
        if pick.random() < 0.8:
            between.append(line)
        return self.first(between=between)


# ---------------------------------------------------------------- bases

def options_of_field(c):
    """A method that goes with most physics, now and then one that does not."""
    pick = c.pick
    options = {"shape": pick.choice(("quadratic", "quadratic", "cubic")), "transfer": pick.choice((
        "apic", "apic", "flip 1.0", "flip 0.98", "aflip 0.95", "pic", "tpic")), "scheme": pick.choice(("usl", "usl", "musl"))}
    if pick.random() < 0.2:
        options["shape"] = pick.choice(("linear", "gimp", "cpdi", "cpdi2", "cpgimp"))
        if options["shape"] == "linear":
            options.update(scheme="musl", transfer="flip 1.0")
    if pick.random() < 0.12:
        options.update(frame="total", shape=pick.choice(("linear", "quadratic", "cubic")), transfer=pick.choice((
            "apic", "flip 0.98")))
    if pick.random() < 0.1:
        options["locking"] = pick.choice(("fbar", "pressure", "both"))
    if pick.random() < 0.08:
        options["every"] = pick.choice((2, 3))
    if pick.random() < 0.1:
        options.update(heat="yes", transfer=pick.choice(("pic", "apic")))
        if options["shape"] not in ("quadratic", "cubic"):
            options["transfer"] = "pic"
    return options


def add_body(c, number, corners, law, fix=None, velocity=None):
    """A block of points of a type, with a material of its own."""
    c.bodies.append(("body%d" % number, corners))
    c.fill += [c.block("body%d" % number, corners), "create_points %d region body%d ppc 2%s" % (
        number, number, " fix " + fix if fix else "")]
    c.fill.append("group body%d type %d" % (number, number))
    c.fill.append("velocity body%d set %s" % (number, c.vector(*(velocity or (0.03, 0.02, 0.01)))))
    if law:
        c.materials.append(["law%d" % number, "body%d" % number, c.mass_density(c.pick.choice((1.0, 2.0))), law])


def field(c):
    """One fix mpm, with one or two bodies."""
    pick, options = c.pick, options_of_field(c)
    if c.dimension == 2 and pick.random() < 0.2:
        c.axisymmetric, c.periodic[0], options["axisymmetric"] = True, False, "yes"
        c.physics.append("fix axis all mpm/boundary xlo slip")
        c.free = False
    c.fields.append(("grid1", "all", options))
    low = 0 if c.axisymmetric else 2
    law = SOLIDS if "frame" in options or pick.random() < 0.6 else LOOSE
    if pick.random() < 0.15 and "frame" not in options:
        law = ["eos tait {c1} 7", "eos linear {E} viscosity newtonian {M}"]
        options["smooth"] = 0.5
    add_body(c, 1, (low, low + 4, 2, 6, 1, 5), c.law(law))
    if pick.random() < 0.4:
        add_body(c, 2, (low + 6, low + 9, 3, 6, 2, 5), c.law(law), velocity=(-0.03, 0.01, 0.0))


def contact(c):
    """Two bodies in contact, each with a lattice."""
    options = options_of_field(c)
    while "frame" in options or options["shape"] == "linear":
        options = options_of_field(c)
    c.fields += [("grid1", "body1", options), ("grid2", "body2", options)]
    for k, corners, speed in ((1, (1, 5, 2, 6, 1, 5), 0.03), (2, (5, 9, 3, 6, 1, 4), -0.03)):
        add_body(c, k, corners, c.law(SOLIDS if k == 1 or "frame" in options else SOLIDS + LOOSE), "grid1",
                 (speed, 0.01, 0.0))
    c.physics.append("fix touch all mpm/contact grid1 grid2 law %s normal %s" % (
        c.pick.choice(("frictionless", "coulomb 0.3", "stick")), c.pick.choice(("colinear", "volume", "mass"))))


def refine(c):
    """One body on lattices of two spacings."""
    options = {"shape": c.pick.choice(("linear", "quadratic", "cubic")), "transfer": c.pick.choice((
        "apic", "aflip 0.95", "tpic")), "scheme": "musl"}
    if c.pick.random() < 0.3:
        options.update(frame="total", transfer="apic")
    c.fields += [("grid1", "body1", options), ("grid2", "body2", dict(options, h=0.5, origin=" ".join(
        [c.length(0.25 if options["shape"] == "quadratic" else 0)] * c.dimension)))]
    law = c.law(SOLIDS)
    if c.dimension == 3:
        add_body(c, 1, (1, 4, 2, 5, 1, 4), law, "grid1")
        add_body(c, 2, (4, 6, 2, 5, 1, 4), law, "grid2")
    else:
        add_body(c, 1, (1, 5, 2, 6, 1, 5), law, "grid1")
        add_body(c, 2, (5, 8, 2, 6, 1, 5), law, "grid2")
    c.define.append("fix one all mpm/refine grid1 grid2")


def mixture(c):
    """Soil and water as two fields."""
    options = {"shape": c.pick.choice(("quadratic", "cubic")), "transfer": c.pick.choice(("apic", "flip 1.0", "aflip 0.95")),
               "scheme": c.pick.choice(("usl", "musl"))}
    c.fields += [("grid1", "body1", options), ("grid2", "body2", options)]
    corners = (2, 6, 1, 4, 1, 4)
    add_body(c, 1, corners, c.law(["linear {E} 0.3", "drucker/prager {E} 0.3 30"]), "grid1")
    c.materials[-1][2] = c.mass_density(1.25)
    add_body(c, 2, corners, c.law(["eos tait {c1} 7", "eos linear {E}"]), "grid2 share 0.5")
    c.materials[-1][2] = c.mass_density(1.0)
    c.physics.append("fix mix all mpm/mixture grid1 grid2 %s %s drag %s" % (
        c.mass_density(2.5), c.viscosity(0.001), c.pick.choice((
            "none", "darcy %.15g" % (0.01 * c.h ** 2), "gidaspow " + c.length(0.1), "ergun " + c.length(0.1),
            "difelice " + c.length(0.1)))))


def mesh(c):
    """A mesh in place of the lattice."""
    c.periodic = [False] * 3
    c.files["cells.msh"] = docs_scenes.block_mesh(c.dimension, 0.0, 8 * c.h, {
        "xlo": "left", "ylo": "bottom", "xhi": "right"}).encode()
    corners = (0, 8, 0, 4, 0, 4)
    total, more = (c.pick.random() < 0.5 or c.has("mesh_heat")) and not c.has("mesh_contact"), " 0" if c.dimension == 3 else ""
    add_body(c, 1, corners if total else (1, 7, 1, 3, 1, 3), c.law(SOLIDS if total else SOLIDS + LOOSE))
    c.fill[:] = [line.replace("ppc 2", "spacing " + c.length(1.0)) for line in c.fill]
    c.before.append("group meshed type 1 2")
    c.fill.append("group meshed type 1 2")
    c.define.append("fix grid1 meshed mpm/mesh cells.msh frame %s scheme %s transfer %s locking %s%s" % (
        "total" if total else "updated", c.pick.choice(("usl", "musl")), c.pick.choice((
            "flip 1.0", "flip 0.9", "apic" if total else "flip 0.8")),
        c.pick.choice(("none", "fbar")), c.pick.choice(("", " slip bottom", " velocity left 0 0" + more, " traction right %s 0%s" % (
            c.stress(0.001), more), " pressure right " + c.stress(0.001)))))
    c.free = False


def flow(c):
    """Incompressible flow, with one or two liquids."""
    pick, text = c.pick, ""
    add_body(c, 1, (1, 6, 0, 5, 0, 4), None)
    c.fill[:] = [line.replace("ppc 2", "spacing " + c.length(0.5)) for line in c.fill]
    second = pick.random() < 0.3
    kind = pick.choice(("liquid body2 " + c.mass_density(0.5), "solid body2")) if second and not c.has(
        "emit", "immersed", "grains", "rigid") else ""
    viscous = pick.random() < 0.4 and not kind
    if viscous:
        text += " viscosity %s%s" % (c.viscosity(0.01), pick.choice(("", " implicit yes")) if not c.has("immersed") else "")
    if pick.random() < 0.2:
        text += " wall ylo " + pick.choice(("stick", "slip"))
    if pick.random() < 0.3:
        text += " transfer " + pick.choice(("auto", "apic", "flip 0.95", "aflip 0.95", "pic"))
    special = pick.choice(("", "", "tension", "gas", "reflect", "sharp", "region"))
    if special == "tension" and not kind and not c.has("immersed", "rigid"):
        text += " tension %.15g" % (1e-4 * c.modulus * c.h)
    elif special == "gas" and not kind and not c.has("rigid", "immersed", "emit") and "implicit" not in text:
        text += " gas %s 1.4%s" % (c.stress(0.1), pick.choice(("", " open yhi")))
    elif special in ("reflect", "sharp") and not kind and not c.has("rigid", "immersed", "emit") and not viscous:
        text += " reflect 0.8" if special == "reflect" else " sharp yes"
    if c.has("rigid") and not kind:
        if "viscosity" in text:
            text = ""
        text += " region tool"
    elif special == "region" and not viscous:
        c.before.append("region rock %s" % ("cylinder z %s %s %s INF INF" % tuple(map(c.length, (8, 3, 2)))
                                            if c.dimension == 2 else "sphere %s %s %s %s" % tuple(
                                                map(c.length, (8, 3, 3, 2)))))
        text += " region rock"
    if kind:
        add_body(c, 2, (7, 10, 6, 8, 1, 4), None)
        c.fill[-3] = c.fill[-3].replace("ppc 2", "spacing " + c.length(0.5))
        if kind.startswith("solid"):
            c.materials.append(["law2", "body2", c.mass_density(1.0), "neohookean %s 0.3" % c.stress(0.01)])
        text += " " + kind
    c.free = False
    c.loose = 1e3
    group = "points"
    if c.has("membrane", "solid_elements"):
        c.before.append("group water type 1 2")
        c.fill.append("group water type 1 2")
        group = "water"
    c.physics.append("fix grid1 %s mpm/incompressible %s %s tolerance 1e-10%s" % (group, c.length(1), c.mass_density(1), text))


# ---------------------------------------------------------------- parts

def heat(c):
    """Heat at faces and surfaces, and from a source."""
    pick, text = c.pick, ""
    if c.has("refine"):
        c.loose = 1.0
    for material in c.materials:
        if material[0] == "law3" or material[1] == "body2" and c.has("mixture"):
            continue
        material[3] += " thermal conducting %.15g 300 %.15g" % (c.heat_capacity(), c.conductivity(pick.choice((0.05, 0.5))))
        if pick.random() < 0.2:
            material[3] += " expansion 1e-5"
        if pick.random() < 0.2:
            material[3] += " melt 310 %.15g" % (5 * c.heat_capacity())
    flux, coefficient = "%.15g" % (10 * c.conductivity(0.1) / c.h), "%.15g" % (c.conductivity(0.1) / c.h)
    ways = ("temperature 350", "flux " + flux, "convection %s 280" % coefficient)
    if pick.random() < 0.5:
        face = pick.choice([axis for k, axis in enumerate("xyz"[:c.dimension]) if not c.periodic[k]] or [""])
        if face:
            text += " %s %s" % (face + "lo" if face != "x" or not c.axisymmetric else "xhi", pick.choice(ways))
    if pick.random() < 0.4 and not c.has("refine"):
        text += " surface " + pick.choice(ways)
    if pick.random() < 0.3:
        c.physics.append("variable source atom %.15g*(id>50)" % (10 * c.conductivity(0.1) / c.h ** 2))
        text += " source v_source"
    if pick.random() < 0.3:
        text += " transfer " + pick.choice(("relax 0", "relax 1", "pic", "affine", "xpic 3"))
    if pick.random() < 0.4 and not c.has("refine"):
        text += " time " + pick.choice(("euler", "sdirk2"))
        c.loose = max(c.loose, 1e4)
    if pick.random() < 0.4:
        text += " every %s" % pick.choice(("1", "3", "auto"))
    if c.has("contact") and pick.random() < 0.4 and "frame" not in c.fields[0][2]:
        text += " contact grid1 grid2 conductance " + coefficient
    c.physics.append("fix heat all mpm/heat" + text)
    c.columns.append(("temperature", 1.0))


def pore(c):
    """Pore water in the first body."""
    pick = c.pick
    options = c.fields[0][2]
    if pick.random() < 0.9:
        options.update(shape=pick.choice(("quadratic", "cubic")), scheme="usl")
        if c.axisymmetric:
            raise Unfit
        for word in ("frame", "locking", "smooth"):
            options.pop(word, None)
        c.materials[0][3] = c.law(["linear {E} 0.3", "hencky {E} 0.35", "drucker/prager {E} 0.3 30"]) + (
            c.materials[0][3][c.materials[0][3].find(" thermal"):] if " thermal" in c.materials[0][3] else "")
    text = "fix water all mpm/pore %s %s %.15g soil law1 0.4 %s %.15g" % (
        c.stress(1), c.mass_density(0.5), 0.01 * c.modulus / c.h, pick.choice(("constant", "kozeny", "squared")),
        0.01 * c.speed * pick.choice((0.01, 1.0)))
    if pick.random() < 0.2:
        text += " biot 0.8 " + c.stress(10)
    elif pick.random() < 0.2:
        text += " retention vangenuchten %.15g 2.0 saturation 0.1 1" % (50 / c.modulus)
    if pick.random() < 0.3 and not c.has("implicit", "relax") and "biot" not in text and "retention" not in text:
        text += " formulation u-v-p"
    if pick.random() < 0.5:
        text += " %s %s" % (pick.choice(("free", "ylo")), pick.choice((
            "pressure " + c.stress(0.002), "flux " + c.velocity(0.001), "seepage", "rain " + c.velocity(0.0005), "closed")))
    if pick.random() < 0.5:
        text += " initial " + c.stress(0.003)
    if pick.random() < 0.4 and not c.has("implicit"):
        text += " every " + (pick.choice(("1", "2", "auto")) if "u-v-p" not in text and "retention" not in text else "1")
    c.physics.append(text)
    c.columns += [("pore", 0.01 * c.modulus), ("porosity", 0.01)]
    c.mass += "-%s*f_water" % c.mass_density(0.5)
    c.free = False


def implicit(c):
    """Implicit steps."""
    pick = c.pick
    method = pick.choice(("euler", "euler", "newmark", "midpoint", "alpha", "hht", "static"))
    if c.has("relax", "rigid") or c.has("contact") and c.has("membrane", "solid_elements"):
        raise Unfit
    if c.has("pore"):
        method = pick.choice(("euler", "static"))
    for material in c.materials:    # a fluid has no stiffness in shear, and no unique motion
        if material[3].startswith("eos") or "viscosity" in material[3]:
            material[3] = c.law(["linear {E} 0.3", "neohookean {E} 0.3"]) + (
                material[3][material[3].find(" thermal"):] if " thermal" in material[3] else "")
    for _, _, options in c.fields:
        options["scheme"] = "usl"
        if pick.random() < 0.9:
            for word in ("locking", "smooth", "heat", "every"):
                options.pop(word, None)
            options["transfer"] = "apic" if method in ("euler", "midpoint", "static") else "flip 1.0"
    if c.has("contact") and method in ("alpha", "hht"):
        method = "newmark"
    c.physics.append("fix solve all mpm/implicit %s tolerance 1e-11 solver %s%s" % (
        method, pick.choice(("blocks", "multigrid" if c.has("field") else "blocks")), " stabilize 1e-3" if method == "static" else ""))
    if method == "static" and not c.has("walls"):
        c.periodic[1] = False
        c.physics.append("fix hold all mpm/boundary ylo stick")
    c.step = "timestep " + c.time(pick.choice((0.3, 1.0, 2.0)))
    c.loose, c.free = max(c.loose, 1e4), False
    c.ledger = False


def membrane(c):
    """A closed membrane, which a lattice or fix nve moves, with a gas in it now and then."""
    pick = c.pick
    if c.axisymmetric:
        raise Unfit
    ball = c.dimension == 3
    c.files["skin.msh"] = (docs_scenes.ball_mesh() if ball else ring_mesh()).encode()
    where = c.vector(*((9, 4, 3) if ball else (10, 8, 0)), scale=c.length).split()[:c.dimension]
    c.fill += ["create_points 3 mesh skin.msh scale %.15g thickness %s move %s" % (
        c.h * (15 if ball else 2), c.length(0.05), " ".join(where)), "group body3 type 3",
        "velocity body3 set " + c.vector(-0.03, -0.01)]
    c.materials.append(["law3", "body3", c.mass_density(1.0), "linear %s 0.3" % c.stress(0.5)])
    for _, _, options in c.fields:
        for word in ("locking", "every"):
            options.pop(word, None)
    c.physics.append("fix skin body3 mpm/elements skin.msh thickness %s%s" % (
        c.length(0.05), pick.choice(("", " compression no", " bending yes"))))
    lattice = c.fields and c.fields[0][1] == "all"
    if not lattice:
        c.physics.append("fix nve body3 nve")
    if pick.random() < 0.6:
        c.physics.append("fix gas all mpm/airbag skin " + pick.choice((
            "pressure " + c.stress(0.001), "gas %s 1.4 outside %s" % (c.stress(0.1), c.stress(0.099)))))
    c.free = False


def ring_mesh(n=24):
    """Gmsh's file of a polygon in a circle of radius 1."""
    from math import cos, pi, sin
    nodes = "".join("%d %.12g %.12g 0\n" % (k + 1, cos(2 * pi * k / n), sin(2 * pi * k / n)) for k in range(n))
    lines = "".join("%d 1 2 1 1 %d %d\n" % (k + 1, k + 1, (k + 1) % n + 1) for k in range(n))
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n%s$EndNodes\n$Elements\n%d\n%s$EndElements\n" % (
        n, nodes, n, lines)


def solid_elements(c):
    """A body of finite elements on the lattice."""
    if c.axisymmetric or c.has("membrane"):
        raise Unfit
    for _, _, options in c.fields:
        for word in ("locking", "every"):
            options.pop(word, None)
    c.files["bar.msh"] = docs_scenes.block_mesh(c.dimension, 0.0, 4 * c.h, {"xlo": "left"}).encode()
    if c.has("membrane"):
        raise Unfit
    c.fill += ["create_points 3 mesh bar.msh part cells move " + " ".join(
        c.vector(7, 8, 2, scale=c.length).split()[:c.dimension]) if c.dimension == 2 else
        "create_points 3 mesh bar.msh part cells move " + c.vector(7, 5.5, 2, scale=c.length),
        "group body3 type 3", "velocity body3 set " + c.vector(0.0, -0.03)]
    c.materials.append(["law3", "body3", c.mass_density(1.0), c.law(["linear {E} 0.3", "neohookean {E} 0.3"])])
    c.physics.append("fix bar body3 mpm/elements bar.msh part cells" + c.pick.choice(("", " locking fbar")))
    if not c.fields or c.fields[0][1] != "all":
        c.physics.append("fix nve body3 nve")
    c.free = False


def emit(c):
    """An inlet in the middle of the box, of the material of the first body."""
    if c.has("pore", "implicit", "relax") or c.axisymmetric:
        raise Unfit
    for _, _, options in c.fields:
        options.pop("every", None)
        if options.pop("frame", None):
            options["transfer"] = "apic"
    if len(c.bodies) > 1 and c.has("field"):
        raise Unfit
    corners = (12, 13, 3, 6, 2, 5) if c.dimension == 2 else (10, 11, 2, 5, 2, 5)
    c.before.append(c.block("inlet", corners))
    flow = c.has("flow")
    emitters = "water" if c.has("membrane", "solid_elements") else "points"
    c.physics.append("fix in %s mpm/emit 1 region inlet velocity %s ppc 2" % (
        emitters if flow else "body1", c.vector(0.1, 0.0)))
    c.mass += "-f_in"
    c.free = False


def absorb(c):
    """Points that come to a place are removed."""
    c.before.append(c.block("drain", c.pick.choice(((5, 9, "INF", "INF", "INF", "INF"), ("INF", "INF", "INF", 2.4, "INF", "INF")))))
    c.physics.append("fix out %s mpm/absorb region drain every %d" % ("body1" if c.has("membrane", "solid_elements") else c.pick.choice(("body1", "all")), c.pick.choice((1, 3))))
    c.mass += "+f_out"
    c.free = False


def traction(c):
    """A load on top of the first body, or on all of its surface."""
    where, what = c.pick.choice((("region lid", "traction " + c.vector(0.001, -0.002, 0, c.stress)), ("region lid", "pressure " + c.stress(0.002)),
                                 ("free", "pressure " + c.stress(0.002))))
    c.physics += [c.top("lid"), "fix load body1 mpm/traction %s %s" % (where, what)]
    c.free = False


def dashpot(c):
    """The top of the first body lets waves out."""
    if c.has("mixture", "pore", "implicit"):
        raise Unfit
    c.physics += [c.top("upper"), "fix upper body1 mpm/dashpot region upper %s %s%s" % (
        c.velocity(1.1), c.velocity(0.6), c.pick.choice(("", " support yes", " spring " + c.time(5))))]
    c.free = False


def column(c):
    """A column of its own, whose motion a side of the first body follows."""
    if c.axisymmetric or c.has("mixture", "membrane", "solid_elements", "implicit") or len(c.fields) and c.fields[0][1] == "all":
        raise Unfit
    c.periodic[1] = False
    options = {key: c.fields[0][2][key] for key in ("shape", "transfer", "scheme", "every", "frame") if key in c.fields[0][2]}
    c.fields.append(("far", "body3", options))
    add_body(c, 3, (c.size[0] - 2, c.size[0] - 1, 2, 6, 0, c.size[2]), c.law(["linear {E} 0.3"]), "far", (0, 0.01))
    c.physics.append("fix side all mpm/column far y")
    c.free = False


def pml(c):
    """A layer that absorbs waves."""
    c.periodic[1] = False
    if c.axisymmetric or c.has("heat", "pore", "implicit", "mixture", "refine"):
        raise Unfit
    for _, _, options in c.fields:
        options["transfer"] = c.pick.choice(("apic", "pic"))
        options.pop("locking", None)
    c.physics.append("fix layer all mpm/pml ylo 4")
    c.free = False


def walls(c):
    """Faces and a region that hold nodes."""
    kinds = ("stick", "slip", "separate", "separate friction 0.3", "slip friction 0.2")
    for k, axis in enumerate("xyz"[:c.dimension]):
        for side in ("lo", "hi"):
            if not c.periodic[k] and c.pick.random() < 0.5 and not (k == 0 and c.axisymmetric and side == "lo"):
                c.physics.append("fix %s all mpm/boundary %s %s" % (axis + side, axis + side, c.pick.choice(kinds)))
    if c.pick.random() < 0.5:
        c.physics += ["variable shift equal %s*step*0.01" % c.length(0.5),
                      "region block block INF INF INF %s INF INF%s" % (c.length(2.27), c.pick.choice((
                          "", " move NULL v_shift NULL"))),
                      "fix block all mpm/boundary region block " + c.pick.choice(kinds)]
    c.free = False


def gravity(c):
    """Weight of all atoms."""
    c.physics.append("fix g all gravity %.15g vector 0 -1 0" % (0.005 * c.speed ** 2 / c.h * c.mvv2e))
    c.free = False


def rigid(c):
    """A rigid cube, or a body in a flow."""
    if c.dimension == 2 and not c.has("flow") or c.has("flow") and c.has("immersed", "grains"):
        raise Unfit
    for _, _, options in c.fields:
        if options.pop("frame", None):
            options["transfer"] = "apic"
    if c.has("flow"):
        c.before.append("region tool %s" % ("block %s INF INF" % " ".join(map(c.length, (8.2, 9.7, 2.2, 4.7)))
                                            if c.dimension == 2 else "sphere %s" % " ".join(map(c.length, (8.5, 3, 3, 1.2)))))
    else:
        c.files["cube.stl"] = CUBE.encode()
        c.physics.append("region tool mpm/mesh cube.stl " + " ".join(map(c.length, (0.75, 4.3, 3.6, 5.8))))
    c.physics.append("fix tool all mpm/rigid tool density %s %s velocity %s" % (c.mass_density(2), c.pick.choice((
        "stick", "slip", "separate", "separate friction 0.3")), c.vector(0, -0.02, -0.05)))
    c.free = False


def immersed(c):
    """Grains in a fluid."""
    if c.axisymmetric or c.fields and "frame" in c.fields[0][2] or c.has("implicit"):
        raise Unfit
    c.style = "hybrid sphere mpm"
    if not c.has("grains"):
        c.settings[:] = ["neighbor %s multi" % c.length(0.5), "comm_modify vel yes mode multi"]
        c.physics += ["pair_style zero " + c.length(0.5), "pair_coeff * *", "neigh_modify exclude group all all"]
    for _ in range(2):
        c.fill.append("create_atoms 4 single %s units box" % c.vector(
            c.pick.uniform(2.5, 5.5), c.pick.uniform(2.5, 3.5), c.pick.uniform(1.5, 3.5), scale=c.length))
    c.fill += ["group grains type 4", "set group grains diameter %s density %s" % (c.length(0.2), c.mass_density(2))]
    c.physics += ["fix move grains nve/sphere" + (" disc" if c.dimension == 2 else ""),
                  "fix drag grains mpm/immersed grid1 %s %s drag %s" % (c.mass_density(1), c.viscosity(0.001), c.pick.choice((
                      "gidaspow", "difelice", "ergun", "schiller", "stokes", "none")))]
    c.free = False


def grains(c):
    """A grain falls on the first body."""
    if c.has("immersed") or c.axisymmetric:
        raise Unfit
    c.style = "hybrid sphere mpm"
    c.settings[:] = ["neighbor %s multi" % c.length(0.5), "comm_modify vel yes mode multi"]
    c.fill += ["create_atoms 4 single %s units box" % c.vector(4, 6.6, 3, scale=c.length), "group grains type 4",
               "set group grains diameter %s density %s" % (c.length(1.5), c.mass_density(2)),
               "velocity grains set %s units box" % c.vector(0, -0.05)]
    c.physics += ["pair_style granular",
                  "pair_coeff * * hertz/material %.15g 0.0 0.3 tangential mindlin NULL 0.0 0.0" % (
                      0.02 * c.density * c.speed ** 2 * c.mvv2e), "neigh_modify exclude group points points",
                  "fix move grains nve/sphere" + (" disc" if c.dimension == 2 else "")]
    if c.pick.random() < 0.5 and c.fields:
        c.physics.append("fix outer points mpm/surface")
    c.free = False


def relax(c):
    """Motion is taken out until forces are balanced."""
    c.physics.append("fix rest all mpm/relax 1e-6 stop no every 5")
    c.free = False


def deform(c):
    """Mean strain of a periodic cell."""
    if c.axisymmetric or c.has("walls", "rigid", "traction", "dashpot", "membrane", "solid_elements", "heat", "pore",
                               "implicit", "emit", "record", "pml"):
        raise Unfit
    c.periodic = [True] * 3
    c.fields[0][2].update(frame="total", transfer="apic", shape="quadratic")
    c.fields[0][2].pop("every", None)
    c.physics.append("fix cell all mpm/deform x erate %.15g y stress 0" % (0.001 * c.speed / c.h))
    c.free = False


def cells(c):
    """Means over cells."""
    c.physics += ["fix cells all mpm/cells grid1", "fix mean all ave/grid 3 2 6 %d %d %d f_cells:cell:density f_cells:cell:stress[1]" %
                  c.size]


def record(c):
    """A measured history, as a pressure."""
    c.files["history.txt"] = ("0 0\n%s 1\n%s 0\n" % (c.time(2), c.time(4))).encode()
    c.physics += ["fix past all mpm/record history.txt", "variable past equal f_past*" + c.stress(0.001)]
    if not c.has("flow", "mesh"):
        c.physics += [c.top("under"), "fix past2 body1 mpm/traction region under pressure v_past"]
    c.free = False


def penalty(c):
    """Contact of two bodies by a pair style."""
    if c.has("mixture", "refine", "grains", "immersed", "implicit") or len(c.bodies) < 2 or len(c.fields) < 2:
        raise Unfit
    c.settings.append("comm_modify vel yes")
    c.physics += ["pair_style mpm/penalty", "pair_coeff * * 0.0", "pair_coeff 1 2 %s%s" % (
        c.stress(1), c.pick.choice(("", " friction 0.3 " + c.velocity(0.01))))]


def mesh_heat(c):
    """Heat on a mesh."""
    if c.has("mesh_contact"):
        raise Unfit
    for material in c.materials:
        if " thermal" not in material[3]:
            material[3] += " thermal conducting %.15g 300 %.15g" % (c.heat_capacity(), c.conductivity(0.1))
    c.physics.append("fix warm all mpm/mesh/heat grid1 " + c.pick.choice((
        "", "temperature bottom 350", "flux left %.15g" % (10 * c.conductivity(0.1) / c.h), "convection right %.15g 280" % (
            c.conductivity(0.1) / c.h))))
    c.columns.append(("temperature", 1.0))


def mesh_contact(c):
    """Two bodies on one mesh."""
    c.fill += [c.block("half", (4, "INF", "INF", "INF", "INF", "INF")), "set region half type 2", "group body2 type 2"]
    c.materials.append(["law2", "body2"] + c.materials[0][2:])
    c.physics.append("fix between all mpm/mesh/contact grid1 body1 body2 law " + c.pick.choice((
        "frictionless", "coulomb 0.3", "stick")))


BASES = {part.__name__: part for part in (field, contact, refine, mixture, mesh, flow)}
PARTS = {part.__name__: part for part in (
    solid_elements, membrane, column, emit, heat, pore, implicit, absorb, traction, dashpot, pml, walls, gravity,
    grains, rigid, immersed, relax, deform, cells, record, penalty, mesh_contact, mesh_heat)}
ALL = dict(BASES, **PARTS)
# bases that a part goes with, if these are others than all that have a fix mpm
FITS = {"emit": ("field", "contact", "flow"), "absorb": ("field", "contact", "refine", "flow", "mesh"),
        "pore": ("field", "contact"), "implicit": ("field", "contact"), "membrane": ("field", "contact", "mesh", "flow"),
        "solid_elements": ("field", "contact", "flow", "mesh"), "rigid": ("field", "contact", "refine", "flow"),
        "immersed": ("field", "flow", "mixture"), "deform": ("field",), "column": ("contact",),
        "gravity": tuple(BASES), "record": tuple(BASES), "mesh_heat": ("mesh",), "mesh_contact": ("mesh",),
        "cells": ("field", "contact", "refine", "mixture"), "grains": tuple(BASES)}
