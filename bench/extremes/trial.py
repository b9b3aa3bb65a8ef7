# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""One short run of lmp and what came of it."""
import csv
import os
import re
import subprocess
import sys
import tempfile

LMP = None    # path of the executable, set by run.py
RESULTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "results")

# what an error message is called in the tables; anything else is "error"
KINDS = [("is above the limit", "time step"), ("determinant", "inverted point"),
         ("out of reach of the lattice", "lost point"), ("lost its position", "lost point"),
         ("left the box", "left the box"), ("no valid wave speed", "wave speed")]


class Server:
    """An lmp that reads one trial after the other: to start it takes longer than most trials.
    It ends with an error, and a new one is started for the next trial."""

    def __init__(self):
        self.folder = tempfile.TemporaryDirectory()
        self.process = None

    def start(self):
        env = dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1",
                   OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
        self.process = subprocess.Popen(
            ["stdbuf", "-oL", LMP, "-log", "none", "-nocite"], cwd=self.folder.name, env=env, stdin=subprocess.PIPE,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)

    def run(self, text):
        """All that lmp prints."""
        if self.process is None or self.process.poll() is not None:
            self.start()
        out = []
        try:
            self.process.stdin.write("clear\n" + text + 'print "END OF TRIAL"\n')
            self.process.stdin.flush()
        except BrokenPipeError:
            pass
        for line in self.process.stdout:
            if line.startswith("END OF TRIAL"):
                break
            out.append(line)
        else:
            self.process.wait()
            self.process = None
        return "".join(out)


SERVER = Server()


def run(text):
    """(outcome, output): "ok", "silent nan", or the kind of the error, and all that was printed."""
    out = SERVER.run(text)
    if "ERROR" in out or SERVER.process is None:
        for word, kind in KINDS:
            if word in out:
                return kind, out
        return "error", out
    return ("silent nan" if re.search(r"\bnan\b", out) else "ok"), out


def value(out, name):
    """The number that the line "name = number" of the output has."""
    found = re.findall(r"^%s = (\S+)$" % re.escape(name), out, re.M)
    return float(found[-1]) if found else float("nan")


class Table:
    """A CSV file to which rows are added as they are measured, and that knows which it has."""

    def __init__(self, name, keys, values):
        self.path = os.path.join(RESULTS, name + ".csv")
        self.keys, self.columns = keys, keys + values
        self.rows = []
        if os.path.exists(self.path):
            with open(self.path) as f:
                self.rows = list(csv.DictReader(f))
        self.known = {self.key(r): r for r in self.rows}

    def key(self, row):
        return tuple(str(row[k]) for k in self.keys)

    def has(self, *key):
        return tuple(str(k) for k in key) in self.known

    def get(self, *key):
        return self.known.get(tuple(str(k) for k in key))

    def add(self, **row):
        new = not os.path.exists(self.path)
        with open(self.path, "a", newline="") as f:
            out = csv.DictWriter(f, self.columns, lineterminator="\n")
            if new:
                out.writeheader()
            out.writerow(row)
        row = {k: str(v) for k, v in row.items()}
        self.rows.append(row)
        self.known[self.key(row)] = row
        print("  ".join("%s=%s" % (k, row[k]) for k in self.columns), flush=True)


def progress(done, total, what):
    print("[%d/%d] %s" % (done, total, what), file=sys.stderr, flush=True)
