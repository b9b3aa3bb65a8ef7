# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: docs
# sanitize: no
# timeout: 3600
"""The list of tools/mutate.py fits the source and the tests, so that its mutants can be made at any time."""

import os
import re
import sys
import tempfile

import mpm_testing as mt

MUTATE = [sys.executable, os.path.join(mt.ROOT, "tools", "mutate.py"), "--check"]


def test_list_fits_the_source_and_the_tests():
    result = mt.run(MUTATE)
    mt.ok(result)
    count = re.search(r"^(\d+) mutants, 0 stale, 0 tests", result.output, re.M)
    assert count and int(count.group(1)) >= 150, result.output


def test_some_mutants_are_killed():
    """others with each commit; all of them take hours: tools/mutate.py"""
    mt.long_case()
    commit = mt.run(["git", "-C", mt.ROOT, "rev-parse", "HEAD"])
    seed = int(commit.output[:8], 16) if commit.code == 0 else 0
    result = mt.run(MUTATE[:2] + ["--no-build", "--sample", "30", "--seed", str(seed), "--jobs", "1"], timeout=3600)
    print(result.output)
    mt.ok(result)


def test_what_does_not_fit_is_told():
    good = ("mutant good\nin field/mpm_halo.cpp\n- void MPMHalo::sum(\n+ void MPMHalo::add(\n"
            "test test_parallel.np2 All/Walls.*\n")
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "mutants.txt")
        for old, new, said in (("", "", "1 mutants, 0 stale, 0 tests"),
                               ("::sum(", "::summe(", "good: the text is not exactly once in field/mpm_halo.cpp"),
                               ("void MPMHalo::sum(", "void", "1 mutants, 1 stale"),    # more than once
                               ("Walls", "Waals", "good: no Waals in the source of test_parallel"),
                               (".np2", ".np7", "good: no test_parallel.np7 in the source of test_parallel"),
                               (".np2", "", "good: no test_parallel in the source of test_parallel"),
                               ("test_parallel", "test_series", "good: no test_series.cpp in")):
            with open(path, "w", encoding="ascii") as file:
                file.write(good.replace(old, new) if old else good)
            result = mt.run(MUTATE + ["--list", path])
            assert said in result.output and (result.code != 0) == bool(old), result.output


mt.main(globals())
