#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""measure.py FILE COMMAND...: runs the command, writes its processor time (s) and largest peak memory (MB) to the file

This is a process of its own, and a small one: the peak of a child includes what its parent had when it was started.
"""
import resource
import subprocess
import sys

code = subprocess.call(sys.argv[2:], stdin=subprocess.DEVNULL)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
with open(sys.argv[1], "w") as file:
    file.write("%.6g %.6g\n" % (used.ru_utime + used.ru_stime, used.ru_maxrss / 1024.0))
sys.exit(code)
