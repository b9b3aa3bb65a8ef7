#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
# labels: unit
# timeout: 300
# sanitize: no
"""The tables of the manual page on stability are those of bench/extremes/results, have all combinations
that fix mpm accepts, and the warnings of fix mpm about the time step agree with them."""
import csv
import os
import re
import sys

import mpm_testing

EXTREMES = os.path.join(mpm_testing.ROOT, "bench", "extremes")
sys.path.insert(0, EXTREMES)
import combos
import dt_limit
import drift
import sweep
import trial

trial.LMP = os.path.abspath(mpm_testing.LMP)


def results(name, *keys):
    with open(os.path.join(EXTREMES, "results", name + ".csv")) as f:
        return {tuple(row[k] for k in keys): row for row in csv.DictReader(f)}


def limits():
    return {key: float(row["limit"])
            for key, row in results("dt", "case", "shape", "transfer", "scheme").items()}


def test_pages_are_up_to_date():
    mpm_testing.ok(mpm_testing.run([sys.executable, os.path.join(EXTREMES, "tables.py"), "check"]))


def test_tables_are_complete():
    wanted = {key for key, words in combos.combos()}
    found = limits()
    for case in dt_limit.CASES:
        assert {key[1:] for key in found if key[0] == case} == wanted, case
    # a million steps take long: these shapes, others as far as measured
    for name, part in (("sweep", sweep), ("drift", drift)):
        found = set(results(name, "shape", "transfer", "scheme"))
        possible = {key for key, words in part.work()}
        assert found <= possible, (name, found - possible)
        if name == "drift":
            wanted = {key for key in possible
                      if key[0] in ("quadratic", "cubic", "cpgimp", "linear light", "quadratic total")
                      and (key[1] != "xpic 5" or key[0] == "quadratic")}
        else:
            wanted = possible
        assert wanted <= found, (name, wanted - found)


def test_other_combinations_are_refused():
    seen = set()
    for key, words in combos.combos(lambda *key: not combos.valid(*key)):
        # the scheme matters to few of them, and each error ends a process
        if key[2] != "usl" and (key[0] not in ("quadratic", "linear light") or key[2] != "musl"):
            continue
        kind, out = trial.run(dt_limit.scene(words, "bar", 0.1, steps=0))
        assert re.search("ERROR: Fix mpm .*(use|needs|remove|is for)", out), (key, out[-500:])
        seen.add(key[:2])
    assert len(seen) > 30


def test_warnings_agree_with_the_tables():
    """What the warning at the start of a run recommends is below all limits that were found, wherever the
    body was on the lattice. A limit of zero in the tables: below the smallest time step that was tried."""
    found = limits()
    swept = results("sweep", "shape", "transfer", "scheme")
    for key, words in combos.combos():
        for case in dt_limit.CASES:
            kind, out = trial.run(dt_limit.scene(words, case, 0.99, steps=1, check=True))
            assert kind in ("ok", "inverted point"), (key, case, out[-500:])    # with linear functions
            if "amplify round-off" in out:    # no limit that one could rely on
                continue
            share = re.search(r"can be unstable above (\S+),", out)
            share = float(share.group(1)) if share else 1.0
            limit = max(found[(case,) + key], dt_limit.LOWEST)
            if case == "bar" and key in swept:
                limit = min(limit, float(swept[key]["limit"]))
            assert share <= limit, "%s, %s: %g is above %g" % (case, " ".join(key), share, limit)


if __name__ == "__main__":
    mpm_testing.main(globals())
