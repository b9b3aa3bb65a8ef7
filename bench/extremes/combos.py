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
    ("quadratic edges", "shape quadratic edges modified"),
    ("cubic edges", "shape cubic edges modified"),
    ("linear total", "shape linear frame total"),
    ("quadratic total", "shape quadratic frame total"),
    ("cubic total", "shape cubic frame total"),
    ("bernstein total", "shape bernstein frame total"),
]
TRANSFERS = ["flip 1.0", "flip 0.99", "pic", "apic", "aflip 1.0", "tpic", "polypic", "xpic 2", "xpic 5",
             "fmpm 2"]
SCHEMES = ["usl", "usf", "musl", "usavg"]
AFFINE = ("apic", "aflip", "tpic", "polypic")


def valid(shape, transfer, scheme):
    """Combinations that fix mpm accepts: the others have no meaning (light where no light node can do
    harm, aflip and tpic in the total frame), or are known to be wrong. unittest/scenes/test_extreme_tables.py
    tests that they are refused."""
    kind = transfer.split()[0]
    if kind == "fmpm" and scheme != "usl":
        return False
    if "light" in shape and scheme != "usl" and kind not in AFFINE:
        return False
    if "total" in shape and kind in ("aflip", "tpic"):
        return False
    if kind == "polypic" and shape not in ("quadratic", "cubic"):
        return False
    return not ("edges" in shape and kind not in ("flip", "pic"))


def combos(wanted=valid):
    """All (shape, transfer, scheme) with the words of fix mpm."""
    for transfer in TRANSFERS:
        for scheme in SCHEMES:
            for shape, words in SHAPES:
                if wanted(shape, transfer, scheme):
                    yield (shape, transfer, scheme), "%s transfer %s scheme %s" % (words, transfer,
                                                                                  scheme)
