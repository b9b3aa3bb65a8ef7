#!/bin/bash
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# All tests with the sanitizers of addresses and of undefined behaviour:
#   tools/sanitize.sh [ctest arguments], e.g. -R contact
# The package and the tests are compiled again, into the folder "sanitize" of the
# build tree, and linked to the cached stock LAMMPS; a wrong access or operation ends
# the test concerned.  The last line printed is "N passed, N failed".
# Environment: see tools/build.sh

set -u
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

build=$build/sanitize
MPM_CMAKE="${MPM_CMAKE:-} -D MPM_SANITIZE=on -D MPM_PLUGIN=off"
setup all
build_project all unittests
run_tests "$@"
python3 "$repo/tools/count_tests.py" "$build/results"
