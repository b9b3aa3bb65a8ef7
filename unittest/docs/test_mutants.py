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

sys.path.insert(0, os.path.join(mt.ROOT, "tools"))
import mutants_random

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


# random mistakes in this
PROGRAM = """// prints some numbers
#include <cstdio>
#include <vector>
static constexpr double HALF = 0.5;
struct Pair {
  static constexpr double TENTH = 0.1;
  double x[3] = {1.0, 2.0, 4.0};
};
static double power(const Pair &p, int n)
{
  if (n > 3)
    return p.x[0] + HALF * n;
  return n <= 2 ? p.x[2] - Pair::TENTH : 1.5;
}
int main()
{
  Pair p;
  std::vector<double> all(3 + 4, 7.0);
  double sum = 0.25;
  for (int i = 0; i < 5; i++) {
    p.x[0] += i * sum;
    sum -= power(p, i);
    all[i + 1] = i > 2 && sum < 1.0e3 ? p.x[1] : p.x[0] - sum;
  }
  for (const double x : all) printf("%.9g ", x);
  printf("%.9g", sum);
}
"""


def test_random_mistakes_are_made_while_the_program_runs():
    """a program with all of them does what one does that has one of them in its text"""
    with tempfile.TemporaryDirectory() as folder:
        def build(name, sources):
            mt.ok(mt.run(["c++", "-std=c++17", "-w", "-I", os.path.join(folder, "all")] + sources + ["-o", os.path.join(folder, name)]))

        def prints(name, number=0):
            return mt.run(["env", "MPM_MUTANT=%d" % number, os.path.join(folder, name)]).output

        def write(path, text):
            path = os.path.join(folder, path)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w", encoding="ascii") as file:
                file.write(text)
            return path

        write("src/room/program.cpp", PROGRAM)
        build("plain", [write("plain.cpp", PROGRAM)])
        write("all/math/mpm_mutant.h", mutants_random.HEADER)
        helper = write("all/mpm_mutant.cpp", mutants_random.SOURCE % {"size": 1000})
        tried, seen = 0, 0
        for seed in range(2):
            mutants = list(mutants_random.draw(os.path.join(folder, "src"), seed))
            assert len(mutants) == 12 and all(mutant.edits for mutant in mutants), [mutant.told for mutant in mutants]
            edits = [edit for mutant in mutants for edit in mutant.edits]
            build("choices", [write("choices.cpp", mutants_random.with_choices(PROGRAM, edits)), helper])
            assert prints("choices") == prints("plain")
            for mutant in mutants:
                line, text = re.match(r"room/program.cpp:(\d+) [^:]+: (.*)", mutant.told).groups()
                lines = PROGRAM.splitlines(True)
                lines[int(line) - 1] = text + "\n"
                build("one", [write("one.cpp", "".join(lines))])
                assert prints("choices", mutant.number) == prints("one"), mutant.told
                tried += 1
                seen += prints("one") != prints("plain")
        assert seen > 0.7 * tried, (seen, tried)


mt.main(globals())
