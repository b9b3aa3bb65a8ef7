#!/bin/bash
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# Builds as tools/build.sh does and runs all tests:
#   tools/test.sh [ctest arguments], e.g. -L unit or -R topology
# The last line printed is "N passed, N failed"; failed also when nothing ran.
# Environment: see tools/build.sh

set -u
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
# whatever fails before the tests can be counted is one failure
trap '[ -n "${counted:-}" ] || echo "0 passed, 1 failed"' EXIT

setup
build_project all unittests
say "testing"
rm -rf "$build/results"
mkdir -p "$build/results"
(cd "$build" && ctest -j "$jobs" --output-on-failure --output-junit results/ctest.xml "$@")
python3 "$repo/tools/count_tests.py" "$build/results"
status=$?
counted=yes
exit $status
