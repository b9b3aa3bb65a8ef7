# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Scenes that are right, for fuzz.py: put together at random from what the package can do.

A scene is two or three bodies in a box, some cells wide, that move by a few per cent of the speed of
waves.  It knows what must be true of it: see the members of Scene.
"""

import random as random_numbers

# what 24 steps make of the rounding of sums in another order, in units of strains and velocities of 1 %
ROUNDING = 1e-8

# unit style: (spacing of nodes, density, speed of waves, energy of mass*speed^2, pressure of energy/volume)
UNITS = {
    "lj": (1.0, 1.0, 3.0, 1.0, 1.0), "si": (0.01, 1000.0, 100.0, 1.0, 1.0),
    "cgs": (1.0, 1.0, 1.0e4, 1.0, 1.0), "micro": (1.0, 1.0, 1.0, 1.0, 1.0), "nano": (10.0, 1.0e-3, 1.0, 1.0, 1.0),
    "metal": (10.0, 5.0, 20.0, 1.0364269e-4, 1.6021765e6),
    "real": (10.0, 5.0, 0.02, 48.88821291 ** 2, 68568.415)}

# with the modulus E, the viscosity M, and the strength Y of the scene
SOLIDS = [
    "linear {E} 0.3", "neohookean {E} 0.3", "neohookean/split {E} 0.4", "hencky {E} 0.35",
    "stvenant/kirchhoff {E} 0.25", "corotated {E} 0.3", "mooney/rivlin {c1} {c2} {E}", "ogden {E} term {c1} 1.3 term {c2} 4.0",
    "orthotropic {E} {c1} {c1} 0.2 0.2 0.2 {c1} {c1} {c1}", "transversely/isotropic {E} {c1} 0.2 0.3 {c1} axis 1 1 0",
    "eos linear {E} strength elastic {c1}", "eos linear {E} strength j2 {c1} {Y} hardening linear {c2}",
    "eos linear {E} strength j2 {c1} {Y} kinematic {c2} 10", "eos linear {E} strength elastic {c1} damage rankine {Y}",
    "eos linear {E} strength elastic {c1} viscosity artificial 1.5 0.06", "neohookean {E} 0.3 viscosity newtonian {M}",
    "gurson {E} 0.3 {Y} 0.01"]
LOOSE = [
    "drucker/prager {E} 0.3 30", "drucker/prager {E} 0.3 25 cohesion {Y}", "mohr/coulomb {E} 0.3 30 {Y}",
    "eos linear {E}", "eos tait {c1} 7", "eos tait {c1} 7 viscosity newtonian {M}", "eos linear {E} viscosity newtonian {M}",
    "snow {E} 0.2 0.025 0.0075 10", "nacc {E} 0.3 1.2 0.3 1.0 -0.02"]

CUBE = "solid cube\n%sendsolid\n" % "".join(
    "facet\nouter loop\n%sendloop\nendfacet\n" % "".join("vertex %g %g %g\n" % corner for corner in facet)
    for axis in range(3) for side in (-1, 1) for turn in (0, 1)
    for facet in [[tuple(side if d == axis else uv[(d - axis - 1) % 3] for d in range(3))
                   for uv in (((-1, -1), (1, -1), (1, 1)), ((-1, -1), (1, 1), (-1, 1)))[turn][::side]]])


class Scene:
    """One scene of a seed.

    free: nothing outside acts on it, so that momentum is constant to round-off
    bitwise: a restart on as many processes is the run that was not interrupted, bit by bit
    """

    def __init__(self, seed):
        self.seed, self.files = seed, {}
        self.free, self.bitwise = True, True
        pick = self.pick = random_numbers.Random("scene %d" % seed)
        self.dimension = pick.choice((2, 2, 3, 3, 3))
        self.axisymmetric = self.dimension == 2 and pick.random() < 0.35
        units = pick.choice(sorted(UNITS))
        self.h, self.density, self.speed, mvv2e, nktv2p = UNITS[units]
        self.mvv2e = mvv2e
        self.modulus = self.density * self.speed ** 2 * mvv2e * nktv2p
        self.size = (14, 12, 1) if self.dimension == 2 else (12, 8, 7)
        self.periodic = [pick.random() < 0.35 for _ in range(3)]
        if self.dimension == 2:
            self.periodic[2] = True
        if self.axisymmetric:
            self.periodic[0] = False
        self.options()
        self.bodies = pick.choice((1, 2, 2, 3))
        kinds = ["one field"]
        if self.bodies > 1:
            kinds += ["penalty"] if self.frame == "total" else ["penalty", "contact", "contact"]
        if self.scheme in ("usf", "usavg"):
            kinds = [kind for kind in kinds if kind != "contact"]
        if not self.axisymmetric:
            kinds.append("grains")
        if not self.axisymmetric and self.frame == "updated" and not self.transfer.startswith("fmpm") \
                and "edges" not in self.extra:
            kinds.append("immersed")
        if self.dimension == 3 and self.frame == "updated" and self.scheme in ("usl", "musl"):
            kinds.append("rigid")
        self.kind = pick.choice(kinds)
        self.head = self.make_head(units)
        self.definitions = self.make_definitions()
        self.points = self.make_points()
        self.physics = self.make_physics()

    # ------------------------------------------------------------ parts

    def options(self):
        """The method: a combination that the manual allows."""
        pick = self.pick
        self.frame = "total" if pick.random() < 0.2 else "updated"
        total = self.frame == "total"
        self.scheme = pick.choice(("usl", "usl", "musl", "musl", "usf", "usavg"))
        if self.axisymmetric and self.scheme == "usf":
            self.scheme = "musl"
        even = () if self.dimension == 3 and self.periodic[2] else ("bernstein",)    # cells of two spacings
        self.shape = pick.choice(("linear", "quadratic", "cubic") + even if total else
                                 ("linear", "quadratic", "quadratic", "cubic", "gimp", "cpgimp", "cpdi", "cpdi2"))
        transfers = ["pic", "flip 1.0", "flip 0.98", "apic", "apic", "xpic 3"]
        if not total:
            transfers += ["aflip 1.0", "aflip 0.95", "tpic"]
        if self.scheme == "usl":
            transfers.append("fmpm 2")
        if self.shape in ("quadratic", "cubic") and not total and not self.axisymmetric:
            transfers.append("polypic")
        self.transfer = pick.choice(transfers)
        if self.shape == "linear" and not total:
            self.scheme, self.transfer = "musl", pick.choice(("flip 1.0", "pic"))
        self.extra = ""
        if pick.random() < 0.15 and not (self.axisymmetric and self.scheme == "usl"):
            self.extra += " locking " + pick.choice(("fbar", "pressure", "both"))
        if pick.random() < 0.1:
            self.extra += " every %d" % pick.choice((2, 3))
        if pick.random() < 0.1 and not total and self.shape in ("quadratic", "cubic") \
                and self.transfer.startswith("flip"):
            self.extra += " edges modified"
        self.ppc = 2 if self.shape in ("gimp", "cpgimp", "cpdi", "cpdi2") else pick.choice((2, 2, 2, 3))

    def length(self, cells):
        return "%.12g" % (cells * self.h)

    def make_head(self, units):
        faces = " ".join("p" if periodic else "f" for periodic in self.periodic)
        text = "units %s\n%satom_style %s\n" % (units, "dimension 2\n" if self.dimension == 2 else "",
                                                "hybrid sphere mpm" if self.kind in ("grains", "immersed") else "mpm")
        text = text.replace("atom_style", "boundary %s\natom_style" % faces)
        box = " ".join("0 " + self.length(n) for n in self.size[:2])
        box += " %s %s" % ((self.length(-0.5), self.length(0.5)) if self.dimension == 2 else
                           ("0", self.length(self.size[2])))
        return text + self.settings() + "region box block %s\ncreate_box 4 box\n" % box

    def settings(self):
        """What is not in restart files."""
        if self.kind in ("grains", "immersed"):
            return "neighbor %s multi\ncomm_modify vel yes mode multi\n" % self.length(0.5)
        return "neighbor %s bin\n%s" % (self.length(0.5), "comm_modify vel yes\n" if self.kind == "penalty" else "")

    def make_definitions(self):
        options = "shape %s transfer %s scheme %s frame %s%s%s" % (
            self.shape, self.transfer, self.scheme, self.frame,
            " axisymmetric yes" if self.axisymmetric else "", self.extra)
        if self.kind in ("penalty", "contact"):
            return "".join("fix grid%d body%d mpm %s %s\n" % (k, k, self.length(1), options)
                           for k in range(1, self.bodies + 1))
        return "fix grid all mpm %s %s\n" % (self.length(1), options)

    def make_points(self):
        """Bodies side by side along x, which move towards each other."""
        pick, text = self.pick, ""
        width = self.size[0] // self.bodies
        for k in range(1, self.bodies + 1):
            low = (k - 1) * width + (0 if self.axisymmetric else 1)
            # one field: bodies away from each other, else side by side
            high = low + width - (2 if self.kind in ("one field", "grains") or self.frame == "total" else 1)
            ylow = pick.choice((1, 1, 2))
            zlow, zhigh = ("INF", "INF") if self.dimension == 2 else (self.length(1), self.length(4))
            radius = min(2.9, (high - low) / 2)
            if pick.random() < 0.25 and self.kind not in ("contact", "grains") and not self.axisymmetric:
                text += "region body%d %s\n" % (k, "cylinder z %s %s %s INF INF" % (
                    self.length((low + high) / 2), self.length(4), self.length(radius))
                    if self.dimension == 2 else "sphere %s %s %s %s" % (
                    self.length((low + high) / 2), self.length(4), self.length(3.5), self.length(radius)))
            else:
                text += "region body%d block %s %s %s %s %s %s\n" % (
                    k, self.length(low), self.length(high), self.length(ylow), self.length(ylow + 4), zlow, zhigh)
            fix = " fix grid1" if self.kind in ("penalty", "contact") else ""
            text += "create_points %d region body%d ppc %d%s\n" % (k, k, self.ppc, fix)
        text += "".join("group body%d type %d\n" % (k, k) for k in range(1, self.bodies + 1))
        text += "group points type 1 2 3\n"
        for k in range(1, self.bodies + 1):
            across = "0" if self.dimension == 2 else "%.6g" % self.rate(0.01)
            radial = self.rate(0.04) * (-1) ** (k + 1) if not self.axisymmetric else 0.0
            text += "velocity body%d set %.6g %.6g %s\n" % (k, radial, self.rate(0.03), across)
        if self.kind == "immersed":
            for _ in range(pick.choice((1, 3))):    # style random would number them by process
                text += "create_atoms 4 single %s %s %s units box\n" % (
                    self.length(pick.uniform(1.5, 3.5)), self.length(pick.uniform(2.5, 4.5)),
                    self.length(pick.uniform(1.5, 3.5)) if self.dimension == 3 else "0")
            text += "group grains type 4\n"
            text += "set group grains diameter %s density %.6g\n" % (self.length(0.2), 2 * self.density)
        if self.kind == "grains":
            # above the first body, which it touches if that ends there
            where = [self.length(3), self.length(4), self.length(4.7)]
            if self.dimension == 2:
                where = [self.length(3), self.length(6.7), "0"]
            text += "create_atoms 4 single %s units box\ngroup grains type 4\n" % " ".join(where)
            text += "set group grains diameter %s density %.6g\n" % (self.length(1.5), 2 * self.density)
            text += "velocity grains set 0 %.6g %s units box\n" % (
                -self.rate(0.05), "%.6g" % -self.rate(0.05) if self.dimension == 3 else "0")
        return text

    def rate(self, share):
        """A velocity of about this share of the speed of waves, never zero."""
        return share * self.speed * self.pick.uniform(0.5, 1.5)

    def make_physics(self):
        pick, text = self.pick, ""
        for k in range(1, self.bodies + 1):
            law = pick.choice(SOLIDS if self.frame == "total" or pick.random() < 0.6 else LOOSE)
            if self.kind == "immersed":
                law = "eos tait {c1} 7"
            e = self.modulus * pick.choice((1.0, 0.5))
            text += "fix law%d body%d mpm/material density %.6g %s\n" % (
                k, k, self.density * (1.0 if self.kind == "immersed" else pick.choice((1.0, 2.0))),
                law.format(E="%.6g" % e, c1="%.6g" % (0.3 * e), c2="%.6g" % (0.05 * e), Y="%.6g" % (0.01 * e),
                           M="%.6g" % (0.02 * e * self.h / self.speed)))
        text += self.walls()
        if self.kind == "contact":
            law = pick.choice(("frictionless", "coulomb 0.3", "stick", "coulomb 0.2 0.4"))
            text += "fix touch all mpm/contact %s law %s normal %s gap %s\n" % (
                " ".join("grid%d" % k for k in range(1, self.bodies + 1)), law,
                pick.choice(("colinear", "volume", "mass", "logistic")), pick.choice(("yes", "no")))
        if self.kind == "penalty":
            text += "pair_style mpm/penalty\npair_coeff * * 0.0\npair_coeff 1 2 %.6g%s\npair_coeff 2 3 %.6g\n" % (
                self.modulus, pick.choice(("", " friction 0.3 %.6g" % self.rate(0.01))), self.modulus)
            self.bitwise = "friction" not in text
        if self.kind == "grains":
            text += "pair_style granular\npair_coeff * * hertz/material %.6g 0.0 0.3 tangential mindlin NULL 0.0 0.0\n" \
                "neigh_modify exclude group points points\n" % (
                    0.02 * self.density * self.speed ** 2 * self.mvv2e)    # force per area, whatever pressure is
            text += "fix move grains nve/sphere%s\n" % (" disc" if self.dimension == 2 else "")
            if pick.random() < 0.4:
                text += "fix skin points mpm/surface\n"
            self.free = False    # velocities of grains are those of the end of a step, of points of its middle
        if self.kind == "immersed":
            text += "pair_style zero %s\npair_coeff * *\nneigh_modify exclude group all all\n" % self.length(0.5)
            text += "fix move grains nve/sphere%s\n" % (" disc" if self.dimension == 2 else "")
            text += "fix drag grains mpm/immersed grid %.6g %.6g drag %s\n" % (
                self.density, 1e-3 * self.modulus * self.h / self.speed,
                pick.choice(("gidaspow", "difelice", "ergun", "schiller", "stokes", "none")))
            self.free = self.bitwise = False
        if self.kind == "rigid":
            self.files["cube.stl"] = CUBE.encode()
            # a little above the first body
            text += "region tool mpm/mesh cube.stl %s %s %s %s\n" % (
                self.length(1.0), self.length(3.3), self.length(3.6), self.length(4.8))
            text += "fix tool all mpm/rigid tool density %.6g %s velocity 0 0 %.6g\n" % (
                2 * self.density, pick.choice(("stick", "slip", "separate", "separate friction 0.3")),
                -self.rate(0.05))
            self.free = False    # the momentum of the body is not among that of the points
        if pick.random() < 0.3:
            text += "fix g points gravity %.6g vector 0 -1 0\n" % (
                0.01 * self.speed ** 2 / self.h * self.mvv2e)    # force per mass
            self.free = False
        text += "fix dt all mpm/dt %.3g\n" % pick.uniform(0.15, 0.3)
        if pick.random() < 0.3:    # only seen with several processes
            text += "fix even all balance 4 1.0 shift xy 3 1.05\n"
        return text

    def walls(self):
        """Faces and now and then a region; the axis of symmetry must be held."""
        pick, text = self.pick, ""
        total = self.frame == "total"
        kinds = ["stick", "slip"]
        if not total and self.scheme not in ("usf", "usavg"):
            kinds += ["separate", "separate friction 0.3"]
        for axis in range(self.dimension):
            if self.periodic[axis]:
                continue
            for side in ("lo", "hi"):
                face = "xyz"[axis] + side
                if self.axisymmetric and face == "xlo":
                    text += "fix axis all mpm/boundary xlo slip\n"
                    self.free = False
                elif pick.random() < 0.5:
                    text += "fix %s all mpm/boundary %s %s\n" % (face, face, pick.choice(kinds))
                    self.free = False
        if pick.random() < 0.15 and not total:
            text += "region wall block INF INF INF %s INF INF\nfix wall all mpm/boundary region wall %s\n" % (
                self.length(1.3), pick.choice(kinds))
            self.free = False
        return text

    # ------------------------------------------------------------ inputs

    def output(self, name):
        """The state of all atoms at this time; the numbers are exact."""
        return ("write_dump all custom %s id type mass x y z vx vy vz c_state[*] "
                "modify sort id format float %%.17g\n" % name)

    def first(self, steps=12):
        """Some steps, a restart file, and as many steps again."""
        groups = "".join("group body%d type %d\n" % (k, k) for k in range(1, self.bodies + 1))
        return (self.head + groups + self.definitions + self.points + self.physics +
                "compute state points mpm/atom stress/* F/*\nthermo 6\nrun 0\n" + self.output("state.0") +
                "run %d\nwrite_restart half.restart\nrun %d\n" % (steps, steps) + self.output("state.1"))

    def second(self, steps=12):
        """The second half, from the restart file."""
        units = self.head[:self.head.index("\n") + 1]
        return (units + "read_restart half.restart\n" + self.settings() + self.definitions + self.physics +
                "compute state points mpm/atom stress/* F/*\nthermo 6\n" + "run %d\n" % steps +
                self.output("state.2"))
