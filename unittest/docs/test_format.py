# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: docs
# sanitize: no
"""All C++ files are as clang-format 14 writes them with .clang-format. Other versions of the program
break lines differently, so that the test is left out where there is no version 14. Messages have the types of what
they carry with any size of IDs. Files include the headers of LAMMPS's classes that they use: what another header
brings along is not the same in all versions of LAMMPS."""

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


def test_lines_end_at_100_columns():
    """clang-format leaves comments as they are"""
    long = [f"{os.path.relpath(path, mt.ROOT)}:{number}" for folder in ("src", "unittest", "bench", "examples")
            for path in sorted(glob.glob(os.path.join(mt.ROOT, folder, "**", "*.[hc]*"), recursive=True))
            if path.endswith((".h", ".cpp"))
            for number, line in enumerate(open(path), 1) if len(line.rstrip("\n")) > 100]
    assert not long, "\n".join(long)


def test_ids_have_their_own_mpi_types():
    """IDs, image flags and counts of atoms have 32 or 64 bits: MPI_LMP_TAGINT and its like"""
    wrong = [path + ": " + line for path in glob.glob(os.path.join(mt.ROOT, "src", "MPM", "*", "*.cpp"))
             for line in open(path)
             if re.search(r"MPI_INT[^0-9_].*(tag|image)|(tagint|imageint|bigint).*MPI_INT[^0-9_]", line)]
    assert not wrong, "".join(wrong)


def all_includes(name, texts, found):
    """Headers that a file of the package includes, itself or through headers of the package."""
    for header in re.findall(r'^#include "(\S+\.h)"', texts[name], re.M):
        if header not in found:
            found.add(header)
            if header in texts:
                all_includes(header, texts, found)
    return found


def test_classes_of_lammps_are_included():
    sources = os.path.join(mt.ROOT, "src", "MPM")
    texts = {os.path.relpath(path, sources): open(path).read() for path in glob.glob(os.path.join(sources, "*", "*.[hc]*"))}
    classes = ("atom", "comm", "domain", "error", "force", "group", "input", "memory", "modify", "neighbor",
               "output", "update")
    missing = [name + " uses " + used + ", but does not include " + used + ".h"
               for name in sorted(texts) if name.endswith(".cpp")
               for included in [all_includes(name, texts, set())]
               for used in classes
               if re.search(r"\b" + used + "->", texts[name]) and used + ".h" not in included]
    assert texts and not missing, "\n".join(missing)


mt.main(globals())
