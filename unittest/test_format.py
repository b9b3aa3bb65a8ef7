# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: docs
# sanitize: no
"""All C++ files are as clang-format 14 writes them with .clang-format. Other versions of the program
break lines differently, so that the test is left out where there is no version 14. Messages have the types of what
they carry with any size of IDs."""

import glob
import os
import re
import shutil

import mpm_testing as mt

VERSION = "14"


def find_program():
    for name in ("clang-format-" + VERSION, "clang-format"):
        if shutil.which(name):
            found = re.search(r"version (\d+)", mt.run([name, "--version"]).output)
            if found and found.group(1) == VERSION:
                return name
    raise mt.Skip("there is no clang-format " + VERSION)


def test_files_are_formatted():
    files = [path for folder in ("src", "unittest", "bench", "examples")
             for path in glob.glob(os.path.join(mt.ROOT, folder, "**", "*.[hc]*"), recursive=True)
             if path.endswith((".h", ".cpp"))]
    assert files
    result = mt.run([find_program(), "--dry-run", "--Werror"] + sorted(files), mt.ROOT)
    assert result.code == 0, "run clang-format -i on these files:\n" + "\n".join(
        sorted(set(re.findall(r"^(\S+?):\d+:", result.output, re.M))))


def test_ids_have_their_own_mpi_types():
    """IDs, image flags and counts of atoms have 32 or 64 bits: MPI_LMP_TAGINT and its like"""
    wrong = [path + ": " + line for path in glob.glob(os.path.join(mt.ROOT, "src", "MPM", "*.cpp"))
             for line in open(path)
             if re.search(r"MPI_INT[^0-9_].*(tag|image)|(tagint|imageint|bigint).*MPI_INT[^0-9_]", line)]
    assert not wrong, "".join(wrong)


mt.main(globals())
