# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Small mistakes at random places of src/MPM, for tools/mutate.py --random"""

import glob
import os
import random
import re

OPERAND = r"[\w.]+(?:->\w+|::\w+|\[[^\[\]]*\])*"


def scaled(factor):
    return lambda found: repr(float(found.group()) * factor)


def swapped(*pairs):
    return lambda found: dict(pairs)[found.group()]


# name, what is replaced, and by what
CHANGES = [
    ("sign", r"(?<=[\w)\]]) [+-] (?=[\w(*&])", swapped((" + ", " - "), (" - ", " + "))),
    ("sign", r"(?<= )[+-]=(?= )", swapped(("+=", "-="), ("-=", "+="))),
    ("twice", r"(?<![\w.\[-])\d+\.\d+(?:e[+-]?\d+)?(?![\w.])", scaled(2.0)),
    ("2 % more", r"(?<![\w.\[-])\d+\.\d+(?:e[+-]?\d+)?(?![\w.])", scaled(1.02)),
    ("comparison", r" (?:<|<=|>|>=) ", swapped((" < ", " <= "), (" <= ", " < "), (" > ", " >= "), (" >= ", " > "))),
    ("term", r" [+-] " + OPERAND + r"(?=[;,)])", lambda found: ""),
    ("factor", r" \* " + OPERAND + r"(?=[;,) ])", lambda found: ""),
    ("index", r"\[[012]\]", swapped(("[0]", "[1]"), ("[1]", "[0]"), ("[2]", "[1]"))),
]
# messages, declarations of options, and sizes are not what computes
LEFT_OUT = re.compile(r'^\s*(?://|\*|/\*|#)|"|\bstatic_assert\b|\breserve\(|memory_usage|sizeof')


def without_comment(line):
    return re.sub(r"//.*", "", line)


def places(sources):
    """(file, number of the line, name of the change, where it begins and ends, the new text), of all lines"""
    found = []
    for path in sorted(glob.glob(os.path.join(sources, "*", "*.cpp")) + glob.glob(os.path.join(sources, "*", "*.h"))):
        in_comment = False
        with open(path, encoding="utf-8") as file:
            for number, line in enumerate(file):
                if in_comment or line.lstrip().startswith("/*"):
                    in_comment = "*/" not in line
                    continue
                code = without_comment(line)
                if LEFT_OUT.search(code):
                    continue
                here = [(name, match.start(), match.end(), new(match)) for name, pattern, new in CHANGES
                        for match in re.finditer(pattern, code) if match.group() != "0.0"]
                if here:
                    found.append((os.path.relpath(path, sources), number, here))
    return found


def draw(sources, count, seed):
    """(name, file, whole new text, description) of so many mutants; lines are drawn first, then what to do there"""
    chance = random.Random(seed)
    lines = places(sources)
    for k in range(count):
        file, number, here = chance.choice(lines)
        change, begin, end, new = chance.choice(here)
        with open(os.path.join(sources, file), encoding="utf-8") as source:
            text = source.readlines()
        old = text[number]
        text[number] = old[:begin] + new + old[end:]
        yield ("random-%d-%d" % (seed, k), file, "".join(text),
               "%s:%d %s: %s" % (file, number + 1, change, text[number].strip()))
