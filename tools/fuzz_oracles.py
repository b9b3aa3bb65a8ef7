# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""What must be true of a composition (fuzz_compositions.py), by a few runs of it.

first       it ends, or an error of LAMMPS tells why not; all is finite; checks of the scene hold; momentum
            is constant where nothing acts
ranks       the same on several processes
restart     the same when the second half begins from a restart file
whole       the same in one run as in two
units       the same in another unit style
length      the same with all lengths and times in another unit, by a factor that changes round-off
redefined   a fix that is removed and defined again between two runs: only that it ends
"""

import math
import os
import re
import tempfile

from fuzz_compositions import Composition, UNITS
from fuzz_scenes import ROUNDING

ORACLES = ("ranks", "restart", "whole", "units", "length", "redefined")
# largest differences, in units of strains of 1 %; constants of unit styles have eight digits or more
TOLERANCE = {"ranks": ROUNDING, "restart": 1e-10, "whole": 1e-10, "units": 1e-4, "length": 1e-9}
LEDGER = 1e-10    # largest residual, of all energies
OWN_DOUBTS = re.compile(r"WARNING.*(round-off|rounding|another decomposition)")


def table(path):
    """Rows of numbers of a dump, sorted by ID."""
    with open(path, encoding="ascii") as file:
        lines = file.read().splitlines()
    start = next(k for k, line in enumerate(lines) if line.startswith("ITEM: ATOMS"))
    return [list(map(float, line.split())) for line in lines[start + 1:]]


def scaled(scene, rows):
    """Rows without units."""
    mass = scene.density * scene.h ** (3 if scene.axisymmetric else scene.dimension)    # of rings
    scales = [1, 1, mass] + [scene.h] * 3 + [0.01 * scene.speed] * 3 + [
        0.01 * scene.modulus] * 6 + [0.01] * 9 + [scale for _, scale in scene.columns]
    found = [[value / scale for value, scale in zip(row, scales)] for row in rows]
    for row in found:
        if row[1] == 4 and scene.dimension == 2:    # grains are spheres
            row[2] /= scene.h
    return found


def difference(one, two):
    if len(one) != len(two):
        return math.inf
    return max([0.0] + [abs(a - b) for row, other in zip(one, two) for a, b in zip(row, other)])


def momentum_change(scene, before, after):
    axes = (7,) if scene.axisymmetric else (6, 7, 8)
    size = math.fsum(abs(row[2] * row[k]) for rows in (before, after) for row in rows for k in (6, 7, 8))
    return max(abs(math.fsum(row[2] * row[k] for row in before) - math.fsum(row[2] * row[k] for row in after))
               for k in axes) / max(size, 1e-300)


def without(text, skip):
    return "".join(line + "\n" for line in text.splitlines() if line not in skip)


def checks(output):
    """What fails of the checks that the scene prints, and of the ledger of energy."""
    wrong = ["%s changes by %.3g" % (name, abs(float(value)) / max(float(scale), 1e-300)) for name, value, scale, most
             in re.findall(r"^CHECK (\S+) (\S+) (\S+) (\S+)$", output, re.M)
             if not abs(float(value)) <= float(most) * float(scale)]
    tables = re.findall(r"^ *Step .*\n(?: +[0-9].*\n)+", output, re.M)
    energies = [list(map(float, line.split()))[3:] for rows in tables for line in rows.splitlines()[1:]]
    if energies and energies[0]:    # the sum, and the vector from 1 on
        scale = max(sum(abs(value) for k, value in enumerate(row) if k != 11) for row in energies)
        residual = max(abs(row[11]) for row in energies)
        if not residual <= LEDGER * scale:
            wrong.append("residual of the ledger is %.3g" % (residual / max(scale, 1e-300)))
    return wrong


def judge(machine, scene, oracle, skip=()):
    """(verdict, what is wrong or how close, text, Done)"""
    text = without(scene.redefined() if oracle == "redefined" else scene.first(), skip)
    with tempfile.TemporaryDirectory(prefix="fuzz") as folder:
        done = machine.run(folder, text, scene.files)
        verdict = done.verdict(folder)
        if verdict == "error" or done.code:
            return ("refused" if verdict in ("ran", "error") else verdict), done.message(), text, done
        if verdict != "ran" or oracle == "redefined":
            return verdict, done.message(), text, done
        before, after = (table(os.path.join(folder, "state.%d" % k)) for k in (0, 1))
        wrong = checks(done.output)
        if oracle == "first" and wrong:
            return "check", "; ".join(wrong), text, done
        change = momentum_change(scene, before, after)
        if oracle == "first":
            return ("momentum" if scene.free and change > 1e-11 else "ran"), "momentum changes by %.3g" % change, text, done
        other, ranks, name, second = scene, 1, "state.1", text
        if oracle == "restart":
            second, name = without(scene.second(), skip), "state.2"
        elif oracle == "ranks":
            ranks = scene.ranks
        elif oracle == "whole" and " mpm/surface" in text:    # a new run looks for surfaces again
            return "ran", "", text, done
        elif oracle == "whole":
            second = without(scene.first(half=False), skip)
        elif scene.has("relax") or scene.dimension == 2 and scene.has("grains", "immersed"):
            # round-off decides when motion is taken out; spheres are among points per length
            return "ran", "", text, done
        else:
            names = sorted(UNITS)
            units = names[(names.index(scene.units) + (oracle == "units")) % len(names)]
            other = Composition(scene.seed, scene.asked, units, length=0.7 if oracle == "length" else 1.0)
            second = without(other.first(), skip)
        files = other.files
        again = machine.run(folder, second, files, ranks=ranks)
        verdict = again.verdict(folder)
        if verdict != "ran" or again.code:
            return (oracle if verdict in ("ran", "error") else verdict), again.message(), second, again
        apart = difference(scaled(scene, after), scaled(other, table(os.path.join(folder, name))))
        doubts = OWN_DOUBTS.search(done.output + again.output)
        wrong = apart > TOLERANCE[oracle] * scene.loose and not doubts
        return (oracle if wrong else "ran"), "differs by %.3g" % apart, second, again


def smaller(machine, scene, oracle, verdict, tries=120):
    """Lines of the scene that can be left out."""
    skip = set()
    lines = [line for line in scene.first().splitlines() if not re.match(
        r"units|dimension|boundary|atom_style|region box|create_box|run |write_|print|thermo|neighbor", line)]
    for line in reversed(lines):
        if tries > 0:
            tries -= 1
            skip |= {line} if judge(machine, scene, oracle, skip | {line})[0] == verdict else set()
    return skip


def oracles_of(seed):
    """Two of them for each seed."""
    return ("ranks",) + (ORACLES[1 + seed % 5],)


def try_composition(machine, seed, oracles=None):
    """(verdict, scene, oracle, what, text, Done) of the first thing that is wrong"""
    scene = Composition(seed)
    verdict, what, text, done = judge(machine, scene, "first")
    result = (verdict, scene, "first", what, text, done)
    for oracle in oracles or oracles_of(seed) if verdict == "ran" else ():
        verdict, what, text, done = judge(machine, scene, oracle)
        if verdict not in ("ran", "refused"):
            return verdict, scene, oracle, what, text, done
    return result
