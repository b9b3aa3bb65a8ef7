# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Count test cases in folders of results: ctest.xml and one json file of
GoogleTest per test.  Prints the cases that took longest, and "N passed, N failed"; fails if
any failed or none ran."""

import json
import os
import sys
import xml.etree.ElementTree as xml


slowest = []    # (seconds of processor time of the first process, test, case)


def cases(path):
    """passed, failed, skipped cases of one GoogleTest report"""
    with open(path) as file:
        report = json.load(file)
    count = [0, 0, 0]
    test = os.path.basename(path)[:-5]
    for suite in report["testsuites"]:
        for case in suite["testsuite"]:
            name = case.get("classname", test) + "." + case["name"]
            slowest.append((float(case.get("seconds", 0.0)), test, name))
            if case.get("failures"):
                count[1] += 1
            elif case.get("result") == "SKIPPED" or case.get("status") == "NOTRUN":
                count[2] += 1
            else:
                count[0] += 1
    return count


def count(folder):
    """passed, failed, skipped cases of a folder"""
    total = [0, 0, 0]
    try:
        tests = xml.parse(os.path.join(folder, "ctest.xml")).getroot().iter("testcase")
    except (OSError, xml.ParseError) as error:
        print("no result of ctest:", error)
        return [0, 1, 0]
    for test in tests:
        ok = test.get("status") == "run"
        skipped = test.find("skipped") is not None
        try:
            found = cases(os.path.join(folder, test.get("name") + ".json"))
        except (OSError, ValueError, KeyError):
            found = [0, 0, 1] if skipped else [1, 0, 0] if ok else [0, 1, 0]
        if not ok and not skipped and found[1] == 0:
            found[1] = 1    # e.g. crashed at the end, or on another process
        total = [a + b for a, b in zip(total, found)]
    if sum(total) == 0:
        print("no tests were run in", folder)
        total[1] = 1
    return total


def main(folders):
    total = [sum(column) for column in zip(*map(count, folders))]
    print("most processor time:")
    for seconds, test, name in sorted(slowest, reverse=True)[:10]:
        print("%8.1f s  %s %s" % (seconds, test, name))
    if total[2]:
        print(total[2], "skipped")
    print("%d passed, %d failed" % (total[0], total[1]))
    return 1 if total[1] else 0


sys.exit(main(sys.argv[1:]))
