#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""How near to their bounds the results of tests are.

  tools/bounds.py FOLDER [-t] [-w] [PATTERN]

FOLDER has the files that tests wrote in a build tree with -D MPM_BOUNDS=on (its folder bounds).  For each check the
table has its line, the error that was nearest to the bound, that bound, their ratio, the largest of the values that
were compared, how often the check was made, and the bound in the words of the test; then, for each file, how many
bounds are more than ten times as wide as the error.  Values that are compared with "less than" may be other things
than errors.

  -t        a line for each test of a check in a function that several tests call
  -w        only the checks with a bound more than ten times as wide as the error
  PATTERN   only files whose name has this in it
"""

import collections
import glob
import os
import sys


def read(folder, by_test):
    """The nearest results by (file, line, test), with the sum of the times."""
    checks = {}
    for path in glob.glob(os.path.join(folder, "*.txt")):
        for row in open(path):
            file, line, test, error, bound, scale, times, text = row.rstrip("\n").split("\t")
            error, bound, scale, times = float(error), float(bound), float(scale), int(times)
            at = (file.split("/unittest/")[-1], int(line), test if by_test else "")
            ratio = error / bound if bound > 0 else 1.0
            old = checks.get(at, (-1, 0, 0, 0, 0, ""))
            largest, count = max(scale, old[3]), times + old[4]
            if ratio > old[0]:
                old = (ratio, error, bound, largest, count, text)
            checks[at] = (*old[:3], largest, count, old[5])
    return checks


def main():
    words = [word for word in sys.argv[1:] if not word.startswith("-")]
    if not words or not os.path.isdir(words[0]):
        sys.exit(__doc__)
    checks = read(words[0], "-t" in sys.argv)
    files = collections.defaultdict(list)
    for (file, line, test), (ratio, error, bound, scale, times, text) in sorted(checks.items()):
        if len(words) > 1 and words[1] not in file:
            continue
        files[file].append(ratio)
        if "-w" in sys.argv and ratio >= 0.1:
            continue
        print("%-44s %9.2g %9.2g %9.2g %9.2g %7d  %s" %
              ("%s:%d" % (file, line), error, bound, ratio, scale, times, text + (test and "  " + test)))
    print()
    wide = 0
    for file, ratios in files.items():
        below = sum(ratio < 0.1 for ratio in ratios)
        wide += below
        print("%-44s %4d bounds, %4d wide" % (file, len(ratios), below))
    print("%-44s %4d bounds, %4d wide" % ("all", sum(map(len, files.values())), wide))


if __name__ == "__main__":
    main()
