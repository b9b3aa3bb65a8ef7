# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: docs
# sanitize: no
"""The rooms of src/MPM: files include those of their own room and of the rooms below it, that is, above it in the
tables of src/MPM/README.md; each room has a README that names all of its files; circles of includes do not leave a
room."""

import glob
import os
import re

import mpm_testing as mt

SOURCES = os.path.join(mt.ROOT, "src", "MPM")

# upward includes that are allowed: file and room that it includes, and the reason
EXCEPTIONS = {
}


def rooms():
    """the rooms, from the bottom up"""
    return re.findall(r"^\| \[(\w+)\]\(\1\) \|", mt.read(os.path.join(SOURCES, "README.md")), re.M)


def files():
    return sorted(os.path.relpath(path, SOURCES)
                  for path in glob.glob(os.path.join(SOURCES, "**", "*.[hc]*"), recursive=True))


def includes(name):
    """files of the package that a file includes"""
    found = re.findall(r'^#include "([^"]+)"', mt.read(os.path.join(SOURCES, name)), re.M)
    return [path for path in found if os.path.exists(os.path.join(SOURCES, path))]


def upward(order):
    """(file, included file) of each include of a higher room"""
    return [(name, path) for name in files() for path in includes(name)
            if order.index(os.path.dirname(path)) > order.index(os.path.dirname(name))]


def circles():
    """sets of modules (a header and its source) that include each other, by Tarjan's algorithm"""
    graph = {}
    for name in files():
        graph.setdefault(os.path.splitext(name)[0], set()).update(os.path.splitext(path)[0] for path in includes(name))
    number, low, stack, found = {}, {}, [], []

    def visit(node):
        number[node] = low[node] = len(number)
        stack.append(node)
        for other in sorted(graph.get(node, ())):
            if other not in number:
                visit(other)
                low[node] = min(low[node], low[other])
            elif other in stack:
                low[node] = min(low[node], number[other])
        if low[node] == number[node]:
            circle = stack[stack.index(node):]
            del stack[stack.index(node):]
            if len(circle) > 1:
                found.append(sorted(circle))

    for node in sorted(graph):
        if node not in number:
            visit(node)
    return sorted(found, key=len, reverse=True)


def test_every_file_is_in_a_room():
    folders = {os.path.dirname(name) for name in files()}
    assert folders == set(rooms()), sorted(folders ^ set(rooms()))


def test_rooms_use_only_rooms_below_them():
    found = upward(rooms())
    wrong = ["%s includes %s" % pair for pair in found if (pair[0], os.path.dirname(pair[1])) not in EXCEPTIONS]
    assert not wrong, "\n".join(wrong + [
        "A room must not know those above it: let the lower one have an interface that the higher one implements."])
    used = {(name, os.path.dirname(path)) for name, path in found}
    assert set(EXCEPTIONS) <= used, "no longer needed: %s" % sorted(set(EXCEPTIONS) - used)


def test_circles_of_includes_stay_in_a_room():
    wrong = [circle for circle in circles() if len({os.path.dirname(name) for name in circle}) > 1]
    assert not wrong, "\n".join("%d files include each other: %s" % (len(circle), " ".join(circle)) for circle in wrong)


def test_each_room_tells_what_it_has():
    wrong = []
    for room in rooms():
        path = os.path.join(SOURCES, room, "README.md")
        text = mt.read(path) if os.path.exists(path) else ""
        if not 20 <= text.count("\n") <= 60:
            wrong.append("src/MPM/%s/README.md has %d lines, not 20 to 60" % (room, text.count("\n")))
        have = [os.path.basename(name) for name in files() if os.path.dirname(name) == room]
        wrong += ["src/MPM/%s/%s is not in the README of its room" % (room, name) for name in have
                  if not named(name, text)]
        wrong += ["src/MPM/%s/README.md names %s, which is not there" % (room, word)
                  for word in re.findall(r"^\| (`[^|]*`) \|", text, re.M) for word in re.findall(r"`([^`]+)`", word)
                  if not any(named(name, "`%s`" % word) for name in have)]
    assert not wrong, "\n".join(wrong)


def named(name, text):
    """is a file named in a README, as name.h, name.cpp, name.*, or by a pattern such as test_*.h?"""
    for word in re.findall(r"`([\w.*{},]+)`", text):
        pattern = re.escape(word).replace(r"\*", r"\w*").replace(r"\.\w*", r"\.\w+")
        if re.fullmatch(pattern, name) or re.fullmatch(pattern, name.rsplit(".", 1)[0]):
            return True
    return False


mt.main(globals())
