#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Whole-run cost of the reference work: ns per point-step, everything LAMMPS does included.

usage: run_block.py LMP [case ...]     cases: see CASES below, default: all but large
Time is the difference of two run lengths of the same input, so that set-up drops out: processor
time of all ranks for the cost (other jobs on the machine matter less), wall time beside it.
Each number is the median of REPEAT pairs. Memory is the peak resident size of the largest rank.
"""
import os
import re
import resource
import statistics
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
REPEAT = int(os.environ.get("REPEAT", 3))

# name: (input, variables, points, ranks, steps of the long run beyond the short one)
CASES = {
    "quadratic-apic-46k": ("in.block", {"n": 18, "box": 22}, 46656, 1, 400),
    "quadratic-apic-405k": ("in.block", {"n": 37, "box": 41}, 405224, 1, 100),
    "quadratic-apic-405k-avx2": ("in.block", {"opts": "kernels avx2"}, 405224, 1, 100),
    "quadratic-apic-405k-baseline": ("in.block", {"opts": "kernels baseline"}, 405224, 1, 60),
    "linear-flip-musl-405k": ("in.block", {"opts": "shape linear transfer flip 0.99 scheme musl"},
                              405224, 1, 100),
    "linear-apic-405k": ("in.block", {"opts": "shape linear transfer apic"}, 405224, 1, 100),
    "quadratic-flip-405k": ("in.block", {"opts": "transfer flip 0.99"}, 405224, 1, 60),
    "cubic-apic-405k": ("in.block", {"opts": "shape cubic"}, 405224, 1, 60),
    "quadratic-apic-2d-360k": ("in.block2d", {"n": 300}, 360000, 1, 200),
    "quadratic-flip-46k": ("in.block", {"n": 18, "box": 22, "opts": "transfer flip 0.99"}, 46656, 1,
                           300),
    "cubic-apic-46k": ("in.block", {"n": 18, "box": 22, "opts": "shape cubic"}, 46656, 1, 300),
    "quadratic-apic-405k-2ranks": ("in.block", {}, 405224, 2, 100),
    "sparse-tight-46k": ("in.block", {"n": 18, "box": 22}, 46656, 1, 400),
    "sparse-512-46k": ("in.block", {"n": 18, "box": 512}, 46656, 1, 400),
    "quadratic-apic-3m": ("in.block", {"n": 72, "box": 76}, 2985984, 1, 20),
}


def run(lmp, case, steps):
    script, variables, _, ranks, _ = CASES[case]
    command = ["mpirun", "-np", str(ranks)] if ranks > 1 else []
    command += [lmp, "-in", os.path.join(HERE, script), "-log", "none", "-v", "steps", str(steps)]
    for name, value in variables.items():
        command += ["-v", name, str(value)]
    env = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
               OMP_NUM_THREADS="1")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.time()
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(command, cwd=folder, env=env, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, universal_newlines=True)
    wall = time.time() - start
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        sys.exit("%s failed:\n%s" % (" ".join(command), done.stdout[-2000:]))
    loop = float(re.search(r"Loop time of ([0-9.eE+-]+)", done.stdout).group(1))
    return (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, wall, loop,
            done.stdout)


def peak_memory(lmp, case):
    """Peak resident bytes of one rank, from a process of its own."""
    code = ("import resource,subprocess,sys;subprocess.run(sys.argv[1:],stdout=subprocess.DEVNULL);"
            "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss*1024)")
    script, variables, _, _, _ = CASES[case]
    command = [sys.executable, "-c", code, lmp, "-in", os.path.join(HERE, script), "-log", "none",
               "-v", "steps", "10"]
    for name, value in variables.items():
        command += ["-v", name, str(value)]
    return int(subprocess.check_output(command))


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    lmp = os.path.abspath(sys.argv[1])
    cases = sys.argv[2:] or [c for c in CASES if not c.endswith("3m")]
    rates = {case: ([], []) for case in cases}
    kernels = {}
    for _ in range(REPEAT):    # in turn, so that what else the machine does hits all cases
        for case in cases:
            _, _, points, _, steps = CASES[case]
            short = run(lmp, case, 10)
            long = run(lmp, case, 10 + steps)
            for k in 0, 1:
                rates[case][k].append((long[2 * k] - short[2 * k]) / steps / points * 1e9)
            kernels[case] = re.search(r"points, (\S+) kernels", long[3]).group(1)
    print("%-30s %9s %9s %10s %9s" % ("case", "cpu ns", "loop ns", "peak B/pt", "kernels"))
    for case in cases:
        _, _, points, ranks, _ = CASES[case]
        memory = peak_memory(lmp, case) / points if ranks == 1 else float("nan")
        cpu, loop = (statistics.median(rate) for rate in rates[case])
        print("%-30s %9.1f %9.1f %10.0f %9s" % (case, cpu, loop, memory, kernels[case]), flush=True)


if __name__ == "__main__":
    main()
