# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""The scenes of the atlas and the combinations of settings that are run on them.

A combination is a tuple of settings in the order of SETTINGS, all of them strings as in the input.
"""

SETTINGS = ("shape", "transfer", "scheme", "frame", "ppc", "dtfrac", "h")

SHAPES = ("linear", "quadratic", "cubic", "gimp", "cpgimp", "cpdi", "cpdi2", "bernstein")
SPLINES = SHAPES[:3]
CORNERS = SHAPES[5:7]    # slow, for solids: two transfers, and usl, musl, usavg
TRANSFERS = ("pic", "flip 1.0", "apic", "tpic", "aflip 1.0", "polypic", "xpic 5", "fmpm 5")
SCHEMES = ("usl", "usf", "musl", "usavg")
TOTAL = (SPLINES + ("bernstein",), ("pic", "flip 1.0", "apic", "xpic 5", "fmpm 5"))
MAIN_TRANSFERS = ("flip 1.0", "apic")
COST_SCENE = {2: "bar", 3: "taylor"}    # by dimension: where the costs of all schemes are measured
MIDDLE = ("2", "0.4")    # ppc, dtfrac of the full factorial

# levels: spacings from coarse to fine, as text; the factorial uses the first two, the others are for
#   combinations on the Pareto front
# reference: value of the quantity of interest, or the settings whose mean value at the last of the
#   "reference levels" it is, uncertain by half of the range of their values at both levels
# cost_level: the spacing at which costs are measured, so fine that a run is long enough for that
# extra: ns per point-step of what is no part of the method (a body force), when runs are planned
# total: whether the total frame can be used
# stretch: whether points move so far apart that more of them are tried in the updated frame
# cheap: whether all schemes are part of the factorial; goal: the error that settings are compared at
# scale: what errors are relative to; pairs of q: error = |q - reference| / scale
CONVERGED = (("quadratic", "apic", "usl", "updated"), ("cubic", "flip 1.0", "musl", "updated"))
SCENES = {
    "bar": dict(
        title="Wave in a bar that flies across the lattice",
        quantity="largest error of the displacement over one flight, relative to the amplitude",
        source="exact", reference=0.0, scale=1.0, total=True, cheap=True, cost_level=2, dimension=2, goal=0.02,
        levels=("0.0625", "0.03125", "0.015625", "0.0078125")),
    "vortex": dict(
        title="Generalized vortex",
        quantity="largest error of the displacement in a period, over the largest displacement",
        source="exact (manufactured)", reference=0.0, scale=1.0, total=True, cheap=True, cost_level=2, extra=600.0, dimension=2, goal=0.04,
        levels=("0.1", "0.05", "0.025", "0.0125")),
    "cantilever": dict(
        title="Cantilever under gravity",
        quantity="lowest position of the lower corner of the free end",
        source="extrapolated from finite elements, -3.2958 m with 40 by 10 and -3.3027 m with 80 by 20",
        reference=-3.3050, scale=3.3050, total=True, cheap=True, cost_level=2, stretch=True, dimension=2, goal=0.01,
        levels=("0.25", "0.125", "0.0625", "0.03125")),
    "disks": dict(
        title="Two elastic disks",
        quantity="velocity at which the centers of mass part, over that at which they met",
        source="two settings with fine lattices", reference=CONVERGED,
        reference_levels=("0.0125", "0.00625"),
        scale=1.0, total=False, cheap=True, cost_level=2, dimension=2, goal=0.02,
        levels=("0.05", "0.025", "0.0125", "0.00625")),
    "taylor": dict(
        title="Taylor bar",
        quantity="final diameter of the foot over the final length",
        source="axisymmetric finite elements, 13.48 mm over 16.27 mm",
        reference=13.48 / 16.27, scale=13.48 / 16.27, total=True, cheap=False, cost_level=0, dimension=3, goal=0.04,
        levels=("0.00095", "0.00076", "0.000475", "0.00038")),
    "dam": dict(
        title="Dam break",
        quantity="place of the front, (mean of x^8)^(1/8), at T = 2.5, over the width of the column",
        source="two settings with fine lattices", reference=CONVERGED,
        reference_levels=("0.0017859375", "0.00089296875"),
        scale=2.157, total=False, cheap=False, cost_level=2, dimension=2, goal=0.005,
        levels=("0.00714375", "0.003571875", "0.0017859375")),
    "sand": dict(
        title="Sand column",
        quantity="center of mass along the floor after the collapse, over the width of the column",
        source="two settings with fine lattices", reference=CONVERGED,
        reference_levels=("0.003125", "0.0015625"),
        scale=0.25, total=False, cheap=False, cost_level=1, dimension=2, goal=0.1,
        levels=("0.0125", "0.00625", "0.003125")),
}


# Variants of the scenes of flows, on which the energy is looked at that a setting creates: at the two coarsest
# spacings, with the points per cell and the time step of the factorial
VARIANTS = {
    "sand": [dict(phi=phi, floor=floor, aspect=aspect) for phi in ("25", "35.3")
             for floor in ("stick", "separate friction 0.5") for aspect in ("0.5", "1", "2", "8")] +
            [dict(phi="25", jitter="0.3", seed=seed) for seed in ("1", "2", "3")],
    "dam": [dict(floor=floor, aspect=aspect) for floor in ("slip", "stick") for aspect in ("1", "2", "4")] +
           [dict(jitter="0.3", seed=seed) for seed in ("1", "2", "3")],
}
FLOWS = tuple(VARIANTS)    # the other scenes are of solids
MOST_GAIN = 0.02    # of the energy in play: a setting that creates more in any run is not recommended


def allowed(scene, shape, transfer, scheme, frame):
    """Combinations that fix mpm accepts and that are not the same as another one."""
    name = transfer.split()[0]
    if name == "fmpm" and scheme != "usl":
        return False
    if (shape in CORNERS + ("bernstein",) and
            (not SCENES[scene]["total"] or transfer not in MAIN_TRANSFERS or
             scheme not in ("usl", "musl", "usavg")[:3 if shape in CORNERS and SCENES[scene]["cheap"] else 2])):
        return False
    if name == "polypic":
        return frame == "updated" and shape in ("quadratic", "cubic") and scheme in ("usl", "musl")
    if frame == "total":
        return SCENES[scene]["total"] and shape in TOTAL[0] and transfer in TOTAL[1]
    if shape == "bernstein":
        return False
    # with these shapes tpic is apic
    return not (name == "tpic" and shape not in ("quadratic", "cubic"))


def factorial(scene):
    """Factorial of shape, transfer, scheme, and frame at the two coarsest spacings: full in scenes that are
    cheap; in the others the schemes usf and usavg with two transfers and at the coarsest spacing only, and
    musl and the total frame at the second spacing with two transfers only."""
    for level, h in enumerate(SCENES[scene]["levels"][:2]):
        for kind in kinds(scene):
            plain = kind[2:] == ("usl", "updated")
            main = kind[1] in MAIN_TRANSFERS and kind[2] in ("usl", "musl")
            if kind[3] == "total" and SCENES[scene]["dimension"] == 3:
                main = main and level == 0    # takes five times as many steps there
            if SCENES[scene]["cheap"] or level == 0 or plain or main:
                yield kind + MIDDLE + (h,)


def kinds(scene):
    """The (shape, transfer, scheme, frame) of the factorial."""
    for frame in ("updated", "total"):
        for shape in SHAPES:
            for transfer in TRANSFERS:
                for scheme in SCHEMES:
                    cheap = SCENES[scene]["cheap"] or scheme in ("usl", "musl") or transfer in MAIN_TRANSFERS
                    if cheap and allowed(scene, shape, transfer, scheme, frame):
                        yield shape, transfer, scheme, frame


def costed(scene):
    """Those whose cost is measured before anything is known: with usl, and on one scene of each dimension
    with quadratic functions in all schemes; in 2d, where it is cheap, with all functions.  What is on the
    front is always measured (results.py estimates the others)."""
    for kind in kinds(scene):
        here = scene == COST_SCENE[SCENES[scene]["dimension"]]
        if kind[2] == "usl" or here and (SCENES[scene]["cheap"] or kind[0] == "quadratic"):
            yield kind + MIDDLE + (cost_spacing(scene),)


def cost_spacing(scene):
    return SCENES[scene]["levels"][SCENES[scene]["cost_level"]]


def one_at_a_time(scene):
    """From two base settings: points per cell, time step, and parameters of transfers."""
    h = SCENES[scene]["levels"][1]
    bases = [("quadratic", "apic", "usl", "updated"), ("cubic", "flip 1.0", "musl", "updated")]
    if SCENES[scene]["total"]:
        bases.append(("linear", "flip 1.0", "musl", "total"))
    for base in bases:
        for ppc in ("1", "3", "4"):
            yield base + (ppc,) + MIDDLE[1:] + (h,)
        for dtfrac in ("0.1", "0.2", "0.6", "0.8", "1.0"):
            yield base + (MIDDLE[0], dtfrac, h)
    if SCENES[scene].get("stretch"):
        for level in SCENES[scene]["levels"][:3]:
            for shape in SHAPES:
                for transfer in MAIN_TRANSFERS:
                    for scheme in ("usl", "musl"):
                        if allowed(scene, shape, transfer, scheme, "updated"):
                            yield (shape, transfer, scheme, "updated", "3") + MIDDLE[1:] + (level,)
    for shape in ("quadratic", "gimp"):
        for dtfrac in ("0.1", "0.2", "0.6", "0.8"):
            yield (shape, "fmpm 5", "usl", "updated", MIDDLE[0], dtfrac, h)
    for transfer in ("flip 0.99", "flip 0.95", "aflip 0.99", "xpic 2", "fmpm 2"):
        yield ("quadratic", transfer, "usl", "updated") + MIDDLE + (h,)


def reference_runs(scene):
    """The runs that the reference comes from."""
    if isinstance(SCENES[scene]["reference"], tuple):
        for h in SCENES[scene]["reference_levels"]:
            for base in SCENES[scene]["reference"]:
                yield base + MIDDLE + (h,)


def refinement(scene, front):
    """Settings next to those on the Pareto front so far: other points per cell, time steps, and spacings."""
    for c in front:
        shape, transfer, scheme, frame = c[:4]
        for level, h in enumerate(SCENES[scene]["levels"]):
            for ppc, dtfrac in (("2", "0.4"), ("2", "0.8"), ("1", "0.4"), ("3", "0.4"))[:4 if level < 3 else 2]:
                yield (shape, transfer, scheme, frame, ppc, dtfrac, h)
