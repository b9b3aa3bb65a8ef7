# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""What is measured: shape functions, transfers and schemes. New ones are added here."""

# (name in the tables, words after "fix ... mpm h")
SHAPES = [
    ("linear", "shape linear"),
    ("linear light", "shape linear light 0.5"),
    ("quadratic", "shape quadratic"),
    ("cubic", "shape cubic"),
    ("gimp", "shape gimp"),
    ("cpgimp", "shape cpgimp"),
    ("cpdi", "shape cpdi"),
    ("cpdi2", "shape cpdi2"),
    ("linear total", "shape linear frame total"),
    ("quadratic total", "shape quadratic frame total"),
    ("cubic total", "shape cubic frame total"),
]
TRANSFERS = ["flip 1.0", "apic", "pic", "aflip 1.0", "tpic", "xpic 2", "xpic 5", "fmpm 2"]
SCHEMES = ["usl", "usf", "musl", "usavg"]


def valid(shape, transfer, scheme):
    """Combinations that fix mpm accepts."""
    if transfer.startswith("fmpm") and scheme != "usl":
        return False
    if "light" in shape and scheme != "usl" and transfer.split()[0] not in ("apic", "aflip", "tpic"):
        return False
    return not ("total" in shape and transfer.split()[0] in ("aflip", "tpic"))


def combos():
    """All (shape, transfer, scheme) with the words of fix mpm."""
    for transfer in TRANSFERS:
        for scheme in SCHEMES:
            for shape, words in SHAPES:
                if valid(shape, transfer, scheme):
                    yield (shape, transfer, scheme), "%s transfer %s scheme %s" % (words, transfer,
                                                                                  scheme)


# those of these are measured in all cases of the time step and in the sweep of the edge, unless in
# the total frame, where the edge stays where it is on the lattice; all others in the first case only
SHORT_TRANSFERS = ["flip 1.0", "apic"]
SHORT_SCHEMES = ["usl", "usf", "musl"]


def in_short(key):
    """Is this combination measured in all cases?"""
    shape, transfer, scheme = key
    return "total" not in shape and transfer in SHORT_TRANSFERS and scheme in SHORT_SCHEMES
