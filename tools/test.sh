#!/bin/bash
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# Builds as tools/build.sh does and runs all tests:
#   tools/test.sh [ctest arguments], e.g. -L unit or -R topology
# Without arguments, and when no LAMMPS is asked for, the tests with label smoke
# are run with the oldest supported LAMMPS, too, which has 64-bit atom IDs.
# The last line printed is "N passed, N failed"; failed also when nothing ran.
# Environment: see tools/build.sh

set -u
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
# whatever fails before the tests can be counted is one failure
trap '[ -n "${counted:-}" ] || echo "0 passed, 1 failed"' EXIT

oldest=20250204
old_tree=lammps-$oldest-bigbig
[ $# -gt 0 ] || [ -n "${LAMMPS_SOURCE_DIR:-}${MPM_LAMMPS:-}" ] && oldest=

# build the oldest LAMMPS's tests in a tree of their own, and run them.  It is the one place where the package is
# compiled with 64-bit IDs and image flags, and without precompiled headers, which hide that a source lacks an include
smoke_tests() (
  build=$build/$old_tree
  sizes=BIGBIG
  LAMMPS_SOURCE_DIR=
  MPM_LAMMPS=$oldest
  # the core of the package needs no LAMMPS: that of the first build
  MPM_CMAKE="${MPM_CMAKE:-} -D MPM_CORE_DIR=${build%/*} -D CMAKE_DISABLE_PRECOMPILE_HEADERS=on"
  rm -rf "$build/results"
  setup all
  build_project all smoketests
  run_tests -L smoke
)

setup all
build_project all unittests
run_tests "$@"
results=("$build/results")
if [ -n "$oldest" ]; then
  if (get_sources $oldest); then
    smoke_tests
    results+=("$build/$old_tree/results")
  else
    say "LAMMPS $oldest cannot be had here: its smoke tests are left out"
  fi
fi
python3 "$repo/tools/count_tests.py" "${results[@]}"
status=$?
counted=yes
exit $status
