#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""This package and what a user would take instead, on the same problems: error, time, memory.

   python3 bench/peers/run.py [problem...]         installs and builds what is missing; default: all, 20 minutes
   python3 bench/peers/run.py dam --only SPH       only cases in whose name or setting this text is
   python3 bench/peers/run.py --table              only prints peers.csv
   python3 bench/peers/run.py dam --reference      makes the reference of a problem anew (dam: 8 minutes)

Options: --mpm LMP (default: build/lmp, by tools/build.sh), --peers LMP (default: by build.sh), --repeat N (of short
cases, 3; the least processor time counts), --keep FOLDER (for the files of the runs).
Results go to peers.csv; rows of cases that have run are replaced, others stay.
"""
import argparse
import csv
import datetime
import importlib
import os
import platform
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
REPO = os.path.join(HERE, "..", "..")
TABLE = os.path.join(HERE, "peers.csv")
PROBLEMS = ("taylor", "dam", "beam", "solid", "disks", "sand")
COLUMNS = ("problem", "code", "setting", "quantity", "error_percent", "other_errors", "cpu_s", "ns_per_point_step",
           "mb", "points", "steps", "ranks", "note", "cpu", "compiler", "date")


def environment():
    env = dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
               OMPI_MCA_rmaps_base_oversubscribe="1", OMPI_MCA_hwloc_base_binding_policy="none")
    env.setdefault("WM_PROJECT_DIR", "/usr/share/openfoam")    # where Debian has the settings of OpenFOAM
    return env


def built(script):
    """what a script of the build prints last"""
    done = subprocess.run(["bash", script], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
    if done.returncode:
        sys.exit(done.stdout[-3000:])
    return done.stdout.strip().split("\n")[-1]


def machine():
    model = platform.machine()
    if os.path.exists("/proc/cpuinfo"):
        with open("/proc/cpuinfo") as file:
            model = (re.findall(r"^model name\s*: (.*)$", file.read(), re.M) or [model])[0]
    compiler = subprocess.run(["c++", "--version"], stdout=subprocess.PIPE, universal_newlines=True).stdout
    return {"cpu": model, "compiler": "g++ " + re.search(r"(\d+\.\d+\.\d+)", compiler).group(1),
            "date": datetime.date.today().isoformat()}


def run(case, builds, folder):
    """processor time of all commands together, largest memory, all output"""
    os.makedirs(folder, exist_ok=True)
    if case.prepare:
        case.prepare(folder)
    seconds, memory, output = 0.0, 0.0, ""
    for words in case.commands:
        words = [builds.get(w, w) for w in words]
        if case.ranks > 1:
            words = ["mpirun", "-np", str(case.ranks)] + words
        note = os.path.join(folder, "measured.txt")
        done = subprocess.run([sys.executable, "-S", os.path.join(HERE, "measure.py"), note] + words, cwd=folder,
                              env=environment(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        output += done.stdout.decode(errors="replace")
        if done.returncode:
            raise RuntimeError("%s: %s" % (" ".join(words), output[-1500:]))
        with open(note) as file:
            used = [float(w) for w in file.read().split()]
        seconds, memory = seconds + used[0], max(memory, used[1])
    return seconds, memory, output


def measure(problem, case, builds, repeat, keep):
    with tempfile.TemporaryDirectory() as scratch:
        times = []
        for k in range(1 if case.long else repeat):
            folder = os.path.join(keep or scratch, problem, re.sub(r"\W+", "-", "%s %s" % (case.code, case.setting)))
            seconds, memory, output = run(case, builds, folder if keep else "%s-%d" % (folder, k))
            times.append(seconds)
            if seconds > 20.0:
                break
        found = case.measure(folder if keep else "%s-%d" % (folder, k), output)
    seconds = min(times)
    first = next(iter(found.errors), "")
    others = "; ".join("%s %.3g" % item for item in list(found.errors.items())[1:])
    work = found.size * found.steps
    return {"problem": problem, "code": case.code, "setting": case.setting.strip(), "quantity": first,
            "error_percent": "%.3g" % found.errors[first] if first else "", "other_errors": others,
            "cpu_s": "%.3g" % seconds, "ns_per_point_step": "%.3g" % (1e9 * seconds / work) if work else "",
            "mb": "%.0f" % memory, "points": found.size, "steps": found.steps or "", "ranks": case.ranks,
            "note": found.note}


def rows_of_table():
    if not os.path.exists(TABLE):
        return []
    with open(TABLE, newline="") as file:
        return list(csv.DictReader(file))


def write(rows):
    codes = list(dict.fromkeys(r["code"] for r in rows))
    rows.sort(key=lambda r: (PROBLEMS.index(r["problem"]), codes.index(r["code"])))
    with open(TABLE, "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def show(rows):
    print("| problem | code | setting | error, % | other errors, % | CPU s | ns | MB | points | steps |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for r in rows:
        print("| %s |" % " | ".join(str(r[c]) for c in (
            "problem", "code", "setting", "error_percent", "other_errors", "cpu_s", "ns_per_point_step", "mb", "points",
            "steps")))
    for line in sorted({"%s, %s, %s" % (r["cpu"], r["compiler"], r["date"]) for r in rows}):
        print("measured on " + line)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("problems", nargs="*")
    parser.add_argument("--only", default="")
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--reference", action="store_true")
    parser.add_argument("--mpm")
    parser.add_argument("--peers")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--keep")
    args = parser.parse_args()
    for problem in args.problems:
        if problem not in PROBLEMS:
            sys.exit("problems are " + ", ".join(PROBLEMS))
    if args.table:
        return show(rows_of_table())

    sys.path.insert(0, HERE)
    sys.dont_write_bytecode = True
    builds = {"MPM": os.path.abspath(args.mpm or os.path.join(REPO, "build", "lmp")), "PEERS": args.peers}
    if not os.path.exists(builds["MPM"]):
        builds["MPM"] = built(os.path.join(REPO, "tools", "build.sh"))
    builds["PEERS"] = os.path.abspath(args.peers or built(os.path.join(HERE, "build.sh")))
    try:
        import numpy    # noqa: F401
    except ImportError:
        if sys.executable == "/usr/bin/python3":
            raise
        os.execv("/usr/bin/python3", ["/usr/bin/python3"] + sys.argv)    # which has what build.sh has installed
    about = machine()
    failed = 0
    for problem in args.problems or PROBLEMS:
        module = importlib.import_module(problem + ".cases")
        if args.reference:
            case, made = module.reference()
            with tempfile.TemporaryDirectory() as folder:
                run(case, builds, folder)
                made(folder)
            continue
        for case in module.cases():
            if args.only not in case.code + " " + case.setting:
                continue
            try:
                row = dict(measure(problem, case, builds, args.repeat, args.keep), **about)
            except Exception as error:     # one that fails must not hide the others
                print("FAILED %s, %s %s: %s" % (problem, case.code, case.setting, error), flush=True)
                failed += 1
                continue
            key = [row[c] for c in ("problem", "code", "setting")]
            old = rows_of_table()
            place = [k for k, r in enumerate(old) if [r[c] for c in ("problem", "code", "setting")] == key]
            if place:
                old[place[0]] = row
            else:
                old.append(row)
            write(old)
            print("%s, %s %s: %s %s %%; %s; %s s, %s ns, %s MB; %s" % (
                problem, row["code"], row["setting"], row["quantity"], row["error_percent"], row["other_errors"],
                row["cpu_s"], row["ns_per_point_step"], row["mb"], row["note"]), flush=True)
    if not args.reference:
        show(rows_of_table())
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
