#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Does any input crash LAMMPS, hang, or give numbers that are none without a word?

usage: fuzz.py [options]

Runs inputs with random mistakes (fuzz_inputs.py), scenes that are right (fuzz_scenes.py), and compositions
of the physics of the package (fuzz_compositions.py), and tells of each how it ended:

  ran, error       went on to the end, or stopped with an error message of LAMMPS
  crash            a signal, or an exit without a message of LAMMPS
  hang             more processor time than the limit, and alone again more than five times the limit
  large            stopped, since a mistake has made more points than --points; no failure
  nan              a number that is not finite in the output or in the state at the end, without a message
  mass, momentum   of a scene that nothing acts on have changed
  ranks            the state on two processes is another than on one, by more than round-off can do
  restart          the state after a restart is not, bit by bit, that of the uninterrupted run
  check, whole, units, length    of a composition: mass or the ledger of energy does not close, one run is
                   not the same as two, another unit style or length gives another result (fuzz_oracles.py)
  refused          a scene that ought to be right ended in an error; a composition may be refused

  --inputs N       inputs with mistakes (default 200)
  --scenes N       scenes (default 20)
  --compositions N compositions (default 0)
  --seed N         of the first input, scene, and composition, the others follow (default 1)
  --minutes M      begin nothing new after that time
  --go-on          leave out what a run into the same folder has done: the summary is that of all parts
  --every S        seconds between lines that tell how far it is (default 60)
  --points N       stop an input that makes more points than this (default 100000)
  --jobs N         runs at a time (default: MPM_JOBS, or all cores)
  --out DIR        folder for failures (default: BUILD/fuzz)
  --lmp FILE       executable (default: MPM_LMP or BUILD/lmp)
  --limit S        seconds of processor time for a run (default: 200 times a small scene, at least 20)
  --memory GB      of address space for each run (default 4)
  --bases          only run the inputs as they are before mistakes are made
  --show           only print the input of --seed; the scene or composition with --inputs 0, too

Each failure is a folder with the input, its files, output, and a file COMMAND that repeats it; crashes and
states that are not finite, and compositions, also have the input with as few lines as fail (small.in).  Failures that are
those of LAMMPS itself are in fuzz_known.txt with a reason.  Exit status: 0 if there are no others.

Limits are processor time, so that a busy machine makes no difference.  Interrupted or terminated, it ends
what runs, and writes its summary.  What was done is in the file DONE of the folder, with a checksum of the
executable and of the inputs that mistakes are made in: only a run on the same state can go on.
"""

import argparse
import concurrent.futures
import hashlib
import math
import os
import random
import re
import resource
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import fuzz_compositions
import fuzz_inputs
import fuzz_oracles
import fuzz_scenes

ROOT = fuzz_inputs.ROOT
BUILD = os.path.abspath(os.environ.get("MPM_BUILD_DIR") or os.path.join(ROOT, "build"))
KNOWN = os.path.join(os.path.dirname(os.path.abspath(__file__)), "fuzz_known.txt")
FAILURES = ("crash", "hang", "nan", "mass", "momentum", "ranks", "restart", "check", "whole", "units")

# all processes are on one machine: see unittest/CMakeLists.txt
ENVIRONMENT = {
    "OMP_NUM_THREADS": "1", "MALLOC_PERTURB_": "128", "LAMMPS_POTENTIALS": os.path.join(ROOT, "potentials"),
    "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_mpi_yield_when_idle": "1", "OMPI_MCA_hwloc_base_binding_policy": "none",
    "OMPI_MCA_btl_vader_single_copy_mechanism": "none", "OMPI_MCA_pml": "ob1", "OMPI_MCA_mtl": "^ofi",
    "OMPI_MCA_btl": "^ofi", "OMPI_MCA_ess_singleton_isolated": "1"}

# limits of a process; what is written to a file that is full is lost, without a signal
LIMITS = 'ulimit -c 0; ulimit -f 131072; ulimit -v %s; ulimit -t %d; trap "" XFSZ; exec "$@"'


class Machine:
    """Executable, limits, and how fast this machine is."""

    def __init__(self, options):
        self.lmp = os.path.abspath(options.lmp)
        self.memory, self.points = int(options.memory * 2 ** 20), options.points
        self.stopped, self.running = False, set()
        if "ASAN_OPTIONS" in os.environ:    # the sanitizer takes address space for all that there is
            self.memory = "unlimited"
        self.mpiexec = shlex.split(os.environ.get("MPM_MPIEXEC", "mpirun -np"))
        self.environment = dict(os.environ)
        for key, value in ENVIRONMENT.items():
            self.environment.setdefault(key, value)
        self.environment.pop("GTEST_OUTPUT", None)
        self.limit = options.limit or 60
        self.limit = options.limit or self.calibrated()

    def calibrated(self):
        """Limit in seconds of processor time: some hundred times that of a scene, at least 20."""
        with tempfile.TemporaryDirectory() as folder:
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            done = self.run(folder, fuzz_scenes.Scene(0).first(), files=fuzz_scenes.Scene(0).files)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.code != 0:
            sys.exit("the first scene does not run:\n" + done.output[-2000:])
        return max(20, math.ceil(200 * (after.ru_utime - before.ru_utime)))

    def run(self, folder, text, files=None, ranks=1, patience=1):
        """Run an input in a folder, in which its files are written."""
        for name, content in dict(files or {}, **{"in.fuzz": text.encode()}).items():
            with open(os.path.join(folder, os.path.basename(name)), "wb") as file:
                file.write(content)
        os.makedirs(os.path.join(folder, "out"), exist_ok=True)    # of examples
        seconds = int(patience * self.limit)
        command = ["sh", "-c", LIMITS % (self.memory, seconds), "sh", self.lmp, "-in", "in.fuzz", "-log",
                   "log.lammps", "-nocite"]
        if ranks > 1:
            command = self.mpiexec + [str(ranks)] + command
        with open(os.path.join(folder, "output"), "wb") as output:
            own = dict(self.environment, TMPDIR=folder)    # runs do not share folders of MPI
            process = subprocess.Popen(command, cwd=folder, env=own, stdin=subprocess.DEVNULL,
                                       stdout=output, stderr=subprocess.STDOUT, start_new_session=True)
            self.running.add(process)
            if self.stopped:    # a signal that came just now has not seen this one
                self.kill(process)
            try:    # one that sleeps for ever uses no time; the factor is for a machine that is busy
                process.wait(30 * seconds)
                code = process.returncode
            except subprocess.TimeoutExpired:
                self.kill(process)
                process.wait()
                code = -signal.SIGXCPU
            self.running.discard(process)
        with open(os.path.join(folder, "output"), "rb") as output:
            return Done(code, output.read(20000000).decode(errors="replace"))

    @staticmethod
    def kill(process):
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)

    def stop(self, *_):
        """Begin nothing new, and end what runs."""
        self.stopped = True
        for process in list(self.running):
            self.kill(process)


class Done:
    """Exit status and output of a run."""

    def __init__(self, code, output):
        by_signal = re.search(r"exited on signal (\d+)", output)    # of mpirun
        self.code = -int(by_signal.group(1)) if by_signal else code
        self.output = output

    def verdict(self, folder):
        if self.code in (-signal.SIGXCPU, -signal.SIGKILL, 128 + signal.SIGXCPU):
            return "hang"
        if self.code < 0 or self.code > 128 or (self.code and "ERROR" not in self.output):
            return "crash"
        if re.search(r"^FUZZ: \d+ points are too many", self.output, re.M):
            return "large"
        notice = re.search(r"^WARNING.*(finite|\bnan\b|\binf\b)|^ERROR", self.output.split("FUZZ: the end")[0],
                           re.M | re.I)
        if not notice and (any(map(not_finite, self.output.splitlines())) or
                           state_not_finite(folder, "Loop time" in self.output)):
            return "nan"
        return "ran" if "FUZZ: the end" in self.output or not self.code else "error"

    def message(self):
        """The error, or the last line."""
        lines = [line for line in self.output.splitlines() if line.strip()]
        errors = [line for line in lines if line.startswith("ERROR")]
        return (errors or lines or [""])[-1][:200]


def not_finite(line):
    """Is this a row of numbers with one that is not finite?"""
    low = line.lower()
    if "nan" not in low and "inf" not in low:
        return False
    try:
        return not all(math.isfinite(float(word)) for word in line.split())
    except ValueError:
        return False


def state_not_finite(folder, forces):
    """forces: LAMMPS sets those of atoms in the first run, not before"""
    for name in ("fuzz.state", "fuzz.stress"):
        path = os.path.join(folder, name)
        if os.path.exists(path):
            with open(path, "rb") as file:
                rows = file.read()
            if name == "fuzz.state" and not forces:
                rows = b"\n".join(b" ".join(row.split()[:8]) for row in rows.splitlines())
            if re.search(rb"\s-?(nan|inf)\b", rows, re.I):
                return True
    return False


# ---------------------------------------------------------------- inputs with mistakes

def run_input(machine, case, folder, patience=1):
    done = machine.run(folder, case.text(machine.points) + fuzz_inputs.TRAILER, case.files, patience=patience)
    return done.verdict(folder), done


def try_input(machine, mutator, seed, patience=1):
    """(verdict, input, Done) of one seed"""
    case = mutator.make(random.Random("input %d" % seed))
    with tempfile.TemporaryDirectory(prefix="fuzz") as folder:
        verdict, done = run_input(machine, case, folder, patience)
    return verdict, case, done


def smaller(machine, case, verdict, tries=150):
    """The input without lines that it does not take to fail."""
    size = max(1, len(case.lines) // 2)
    while size and tries > 0:
        start = 0
        while start < len(case.lines) and tries > 0:
            trial = case.copy()
            del trial.lines[start:start + size]
            tries -= 1
            with tempfile.TemporaryDirectory(prefix="fuzz") as folder:
                same = run_input(machine, trial, folder)[0] == verdict
            if same:
                case = trial
            else:
                start += size
        size //= 2
    return case


def backtrace(machine, case):
    """Where it crashes, if there is a debugger."""
    if not shutil.which("gdb"):
        return ""
    with tempfile.TemporaryDirectory(prefix="fuzz") as folder:
        machine.run(folder, case.text() + fuzz_inputs.TRAILER, case.files)
        command = ["gdb", "-batch", "-ex", "run", "-ex", "bt 25", "--args", machine.lmp, "-in", "in.fuzz", "-nocite"]
        found = subprocess.run(["timeout", "600"] + command, cwd=folder, env=machine.environment, check=False,
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    return "\n".join(line for line in found.stdout.decode(errors="replace").splitlines()
                     if re.match(r"#\d+ |Program", line)) + "\n"


# ---------------------------------------------------------------- scenes

def table(path):
    """Rows of numbers of a dump, sorted by ID."""
    with open(path, encoding="ascii") as file:
        lines = file.read().splitlines()
    start = next(k for k, line in enumerate(lines) if line.startswith("ITEM: ATOMS"))
    return [list(map(float, line.split())) for line in lines[start + 1:]]


def totals(rows, axisymmetric):
    """Mass and momentum, and the sum of absolute values of the latter; a ring has none in its plane."""
    mass = math.fsum(row[2] for row in rows)
    axes = (1,) if axisymmetric else (0, 1, 2)
    momentum = [math.fsum(row[2] * row[6 + d] for row in rows) for d in axes]
    return mass, momentum, math.fsum(row[2] * abs(row[6 + d]) for row in rows for d in (0, 1, 2))


def difference(scene, one, two):
    """Largest difference of positions, velocities, stresses, and deformation, in units of those of the scene."""
    if len(one) != len(two):
        return math.inf
    worst = 0.0
    for columns, scale in ((range(3, 6), scene.h), (range(6, 9), 0.01 * scene.speed),
                           (range(9, 15), 0.01 * scene.modulus), (range(15, 24), 0.01)):
        worst = max([worst] + [abs(a[k] - b[k]) / scale for a, b in zip(one, two) for k in columns])
    return worst


def try_scene(machine, seed):
    """(verdict, Scene, Done, what is wrong) of one seed"""
    scene = fuzz_scenes.Scene(seed)
    with tempfile.TemporaryDirectory(prefix="fuzz") as folder:
        done = machine.run(folder, scene.first(), scene.files)
        verdict = done.verdict(folder)
        if verdict != "ran" or done.code:
            return ("refused" if done.code > 0 and verdict in ("ran", "error") else verdict), scene, done, ""
        sensitive = re.search(r"WARNING.*(round-off|rounding|another decomposition)", done.output)
        before, after = (table(os.path.join(folder, "state.%d" % k)) for k in (0, 1))
        start, end = totals(before, scene.axisymmetric), totals(after, scene.axisymmetric)
        if len(before) != len(after) or start[0] != end[0]:
            return "mass", scene, done, "mass %.17g and %.17g" % (start[0], end[0])
        change = max(abs(a - b) for a, b in zip(start[1], end[1])) / (start[2] + end[2])
        if scene.free and change > 1e-12:
            return "momentum", scene, done, "momentum changes by %g" % change

        again = machine.run(folder, scene.second(), scene.files)
        verdict = again.verdict(folder)
        if verdict != "ran" or again.code:
            return ("restart" if verdict in ("ran", "error") else verdict), scene, again, again.message()
        rows = table(os.path.join(folder, "state.2"))
        if scene.bitwise and rows != after or difference(scene, rows, after) > 1e-3:
            return "restart", scene, again, "differs by %g" % difference(scene, rows, after)

        two = machine.run(folder, scene.first(), scene.files, ranks=2)
        verdict = two.verdict(folder)
        if verdict != "ran" or two.code:
            return ("ranks" if verdict in ("ran", "error") else verdict), scene, two, two.message()
        rows = table(os.path.join(folder, "state.1"))
        apart = difference(scene, rows, after)
        if apart > fuzz_scenes.ROUNDING and not sensitive:
            return "ranks", scene, two, "differs by %g" % apart
        return "ran", scene, done, "%.2g" % apart


# ---------------------------------------------------------------- report

def known_failures():
    """(verdict, pattern of input and output, reason)"""
    found = []
    if os.path.exists(KNOWN):
        with open(KNOWN, encoding="ascii") as file:
            for line in file:
                if line.strip() and not line.startswith("#"):
                    verdict, pattern, reason = (word.strip() for word in line.split("\t"))
                    found.append((verdict, re.compile(pattern, re.S | re.M), reason))
    return found


def is_known(known, verdict, text, trace):
    return next((reason for kind, pattern, reason in known
                 if kind == verdict and pattern.search(text + "\nBACKTRACE\n" + trace)), None)


def write_failure(options, name, files, command):
    folder = os.path.join(options.out, name)
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    for file, content in dict(files, COMMAND=command + "\n").items():
        with open(os.path.join(folder, os.path.basename(file)), "wb") as out:
            out.write(content if isinstance(content, bytes) else content.encode(errors="replace"))
    return folder


def command_of(seed, kind):
    return "tools/fuzz.py --seed %d --inputs %d --scenes %d --compositions %d" % (
        seed, kind == "input", kind == "scene", kind == "composition")


class Report:
    """Counts verdicts, and writes failures."""

    def __init__(self, machine, options, state):
        self.machine, self.options = machine, options
        self.counts, self.known, self.failures = {}, known_failures(), 0
        self.start = self.told = time.time()
        kinds = ("input", "scene", "composition")
        self.done, self.new = {kind: set() for kind in kinds}, {kind: 0 for kind in kinds}
        self.open_record("state " + state)

    def open_record(self, state):
        """What a run before this one has done, if this one goes on."""
        path = os.path.join(self.options.out, "DONE")
        os.makedirs(self.options.out, exist_ok=True)
        lines = []
        if self.options.go_on and os.path.exists(path):
            with open(path, encoding="ascii") as file:
                lines = file.read().splitlines()
            if lines[0] != state:
                sys.exit("%s is of another executable or of other inputs" % path)
        self.record = open(path, "a" if lines else "w", encoding="ascii")
        if not lines:
            print(state, file=self.record, flush=True)
        for kind, seed, verdict in map(str.split, lines[1:]):
            if self.wanted(kind, int(seed)) and int(seed) not in self.done[kind]:
                self.count(kind, int(seed), verdict)

    def seeds(self, kind):
        count = getattr(self.options, kind + "s")
        return range(self.options.seed, self.options.seed + count)

    def wanted(self, kind, seed):
        return seed in self.seeds(kind)

    def count(self, kind, seed, verdict):
        self.done[kind].add(seed)
        self.counts.setdefault(kind, {}).setdefault(verdict, 0)
        self.counts[kind][verdict] += 1
        self.failures += verdict in FAILURES

    def add(self, kind, seed, verdict):
        """Count one that was done now."""
        self.new[kind] += 1
        self.count(kind, seed, verdict)
        print(kind, seed, verdict, file=self.record, flush=True)
        if time.time() - self.told >= self.options.every:
            self.tell(kind)

    def tell(self, kind):
        """How far it is."""
        self.told = time.time()
        counts = self.counts.get(kind, {})
        done, all_of_them = len(self.done[kind]), len(self.seeds(kind))
        minutes = (self.told - self.start) / 60 / max(1, sum(self.new.values())) * (all_of_them - done)
        print("%d of %d %ss done, %d ended in an error, %d failures, some %.0f minutes left" % (
            done, all_of_them, kind, counts.get("error", 0), self.failures, minutes), flush=True)

    def input(self, seed, verdict, case, done):
        trace, small = "", ""
        if verdict == "crash":
            trace = backtrace(self.machine, case)
        text = case.text() + "\nOUTPUT\n" + done.output[-20000:]
        reason = is_known(self.known, verdict, text, trace) if verdict in FAILURES else None
        self.add("input", seed, "known" if reason else verdict)
        if verdict not in FAILURES or reason:
            return
        if verdict in ("crash", "nan"):
            small = smaller(self.machine, case, verdict).text()
        folder = write_failure(self.options, "input-%d" % seed, dict(
            case.files, **{"in.fuzz": case.text() + fuzz_inputs.TRAILER, "small.in": small,
                           "output": done.output[-100000:], "backtrace": trace}), command_of(seed, "input"))
        print("%s: input %d (%s): %s\n    %s" % (verdict, seed, case.name, folder, done.message()), flush=True)

    def scene(self, seed, verdict, scene, done, what):
        reason = is_known(self.known, verdict, scene.first() + "\nOUTPUT\n" + done.output[-20000:], "")
        self.add("scene", seed, "known" if reason and verdict in FAILURES else verdict)
        if verdict == "ran" or reason:
            return
        folder = write_failure(self.options, "scene-%d" % seed, dict(
            scene.files, **{"in.first": scene.first(), "in.second": scene.second(),
                            "output": done.output[-100000:]}), command_of(seed, "scene"))
        print("%s: scene %d: %s: %s\n    %s" % (verdict, seed, folder, what, done.message()), flush=True)

    def composition(self, seed, verdict, scene, oracle, what, text, done):
        """A failure comes with the input that was run last, and a small one."""
        reason = is_known(self.known, verdict, text + "\nOUTPUT\n" + done.output[-20000:], "")
        self.add("composition", seed, "known" if reason and verdict in FAILURES else verdict)
        if verdict not in FAILURES or reason:
            return
        skip = fuzz_oracles.smaller(self.machine, scene, oracle, verdict)
        folder = write_failure(self.options, "composition-%d" % seed, dict(
            scene.files, **{"in.first": scene.first(), "in.last": text, "output": done.output[-100000:],
                            "small.in": fuzz_oracles.without(scene.first(), skip)}), command_of(seed, "composition"))
        print("%s: composition %d (%s; %s): %s\n    %s" % (
            verdict, seed, " ".join(scene.names), oracle, folder, what), flush=True)

    def end(self):
        for kind, counts in self.counts.items():
            print("%d %ss: %s" % (sum(counts.values()), kind, ", ".join(
                "%d %s" % (counts[key], key) for key in sorted(counts))))
        left = sum(len(self.seeds(kind)) - len(self.done[kind]) for kind in self.done)
        if left:
            print("%d were not run: the same command with --go-on runs these" % left)
        print("%d failures in %.0f s" % (self.failures, time.time() - self.start), flush=True)
        return 1 if self.failures else 0


def state_of(options, bases):
    """Checksum of the executable and of the inputs that mistakes are made in."""
    found = hashlib.sha256()
    with open(options.lmp, "rb") as file:
        found.update(file.read())
    for base in bases:
        found.update(base.text().encode())
    return found.hexdigest()[:16]


def try_all(machine, options):
    mutator = fuzz_inputs.Mutator() if options.inputs else None
    report, hangs = Report(machine, options, state_of(options, mutator.bases if mutator else ())), []
    end = time.time() + 60 * options.minutes
    for name in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(name, machine.stop)

    def each(kind, function):
        """(seed, what function gives) for each of the seeds there is time for"""
        def in_time(seed):
            found = None if machine.stopped or time.time() > end else (seed, function(seed))
            return None if machine.stopped else found    # what a signal has ended tells nothing
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            seeds = [seed for seed in report.seeds(kind) if seed not in report.done[kind]]
            yield from filter(None, pool.map(in_time, seeds))

    for seed, (verdict, case, done) in each("input", lambda seed: try_input(machine, mutator, seed)):
        if verdict == "hang":
            hangs.append(seed)
        else:
            report.input(seed, verdict, case, done)
    for seed in hangs:    # alone, and with more time
        found = None if machine.stopped else try_input(machine, mutator, seed, patience=5)
        if not machine.stopped:
            report.input(seed, *found)
    for seed, result in each("scene", lambda seed: try_scene(machine, seed)):
        report.scene(seed, *result)
    for seed, result in each("composition", lambda seed: fuzz_oracles.try_composition(machine, seed)):
        report.composition(seed, *result)
    return report.end()


def try_bases(machine):
    """Inputs without mistakes run, but for what the examples of the manual leave out."""
    wrong = 0
    for base in fuzz_inputs.bases():
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        with tempfile.TemporaryDirectory(prefix="fuzz") as folder:
            verdict, done = run_input(machine, base, folder)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime - before.ru_utime
        wrong += verdict != "ran"
        print("%-6s %6.2f s  %s%s" % (verdict, seconds, base.name, "" if verdict == "ran" else
                                      "\n    " + done.message()), flush=True)
    return 1 if wrong else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, usage=argparse.SUPPRESS,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--inputs", type=int, default=200)
    parser.add_argument("--scenes", type=int, default=20)
    parser.add_argument("--compositions", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=int(os.environ.get("MPM_JOBS") or os.cpu_count()))
    parser.add_argument("--out", default=os.path.join(BUILD, "fuzz"))
    parser.add_argument("--lmp", default=os.environ.get("MPM_LMP") or os.path.join(BUILD, "lmp"))
    parser.add_argument("--minutes", type=float, default=math.inf)
    parser.add_argument("--go-on", action="store_true")
    parser.add_argument("--every", type=float, default=60.0)
    parser.add_argument("--points", type=int, default=100000)
    parser.add_argument("--limit", type=int, default=0)
    parser.add_argument("--memory", type=float, default=4.0)
    parser.add_argument("--bases", action="store_true")
    parser.add_argument("--show", action="store_true")
    options = parser.parse_args()
    if options.show:
        print(fuzz_inputs.Mutator().make(random.Random("input %d" % options.seed)).text() if options.inputs
              else fuzz_compositions.Composition(options.seed).first() if options.compositions
              else fuzz_scenes.Scene(options.seed).first())
        return 0
    machine = Machine(options)
    return try_bases(machine) if options.bases else try_all(machine, options)


if __name__ == "__main__":
    sys.exit(main())
