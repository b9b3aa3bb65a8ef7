# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: build long
# sanitize: no
# timeout: 7200
"""All sources of the package compile with clang, too, without a warning: GCC knows more than C++17, such as structured
bindings in lambdas."""

import json
import os
import shlex
import shutil

import mpm_testing as mt

# options with a file after them, and those that clang does not have
WITH_FILE = ("-o", "-MF", "-MT", "-include")
LEFT_OUT = ("-MD", "-c", "-g", "-Winvalid-pch", "-fno-semantic-interposition")


def commands():
    """(folder, words) for each source and instruction set"""
    found = {}
    for entry in json.loads(mt.read(os.path.join(os.path.dirname(mt.LMP), "compile_commands.json"))):
        if not any(part in entry["file"] for part in ("/src/MPM/", "/mpm_kernels/", "/mpm_laws/")):
            continue
        words, with_file = [], False
        for word in shlex.split(entry["command"])[1:]:
            if not (with_file or word in LEFT_OUT or word in WITH_FILE or word.startswith("--param")):
                words.append(word)
            with_file = word in WITH_FILE
        instructions = [word for word in words if word.startswith(("-m", "-DMPM_ISA"))]
        found[entry["file"], *instructions] = entry["directory"], words
    return list(found.values())


def test_sources_compile_without_warnings():
    clang = next(filter(shutil.which, ("clang++", "clang++-14")), None)
    if not clang:
        raise mt.Skip("there is no clang")
    wrong = []
    for folder, words in commands():
        result = mt.run([clang, "-fsyntax-only", "-Wall", "-Wextra", "-Werror"] + words, folder, 600)
        if result.code:
            wrong.append(result.output)
    assert not wrong, "\n".join(wrong)


mt.main(globals())
