#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Folders of unittest whose tests concern what differs from a commit, as an expression for ctest -L

usage: changed_rooms.py COMMIT

These are the rooms with a changed source or test, and those that include a changed header. All of them, where
something else has changed that is compiled or run: a tool, the build, or what all tests include."""

import glob
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SOURCES = os.path.join(ROOT, "src", "MPM")


def rooms_of(changed):
    found = set()
    for path in changed:
        room = re.match(r"(?:src/MPM|unittest)/(\w+)/", path)
        if room:
            found.add(room.group(1))
        elif path.startswith("doc/"):
            found.add("docs")
        elif path.startswith(("src/", "unittest/", "cmake/", "tools/", "CMakeLists.txt", "examples/")):
            return {os.path.basename(os.path.dirname(test)) for test in glob.glob(os.path.join(ROOT, "unittest", "*", "test_*"))}
    headers = {path[len("src/MPM/"):] for path in changed if path.startswith("src/MPM/") and path.endswith(".h")}
    for path in glob.glob(os.path.join(SOURCES, "*", "*")):
        with open(path, encoding="utf-8") as file:
            if headers.intersection(re.findall(r'^#include "(\w+/\w+\.h)"', file.read(), re.M)):
                found.add(os.path.basename(os.path.dirname(path)))
    return found


def main(commit):
    listed = subprocess.run(["git", "diff", "--name-only", commit], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=False)
    if listed.returncode:
        return 1
    print("|".join(sorted(rooms_of(listed.stdout.split()) | {"docs"})))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
