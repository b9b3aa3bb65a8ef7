#!/bin/bash
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# Builds as tools/build.sh does and runs tests:
#   tools/test.sh                    all but the long ones, compiled with less optimization in a folder of their own,
#                                    build/quick
#   tools/test.sh all                everything: the long tests with sanitizers, many random inputs, and some mutants; all
#                                    instruction sets; label smoke with the oldest supported LAMMPS, with 64-bit atom IDs
#   tools/test.sh room heat pore     all tests of these folders of unittest
#   tools/test.sh changed [COMMIT]   those of the rooms with files that differ from this commit (default: main),
#                                    or that include one of these files; without the tests that are long as a whole
#   tools/test.sh mutants [PATTERN]  all mutants, see tools/mutate.py: hours
#   tools/test.sh -R topology        the tests that these arguments of ctest choose, with the long ones
# The last line printed is "N passed, N failed"; failed also when nothing ran.
# Environment: see tools/build.sh

set -u
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
# whatever fails before the tests can be counted is one failure
trap '[ -n "${counted:-}" ] || echo "0 passed, 1 failed"' EXIT

quick_build() {
  build=$build/quick
  MPM_CMAKE="-D MPM_QUICK=on ${MPM_CMAKE:-}"
}

oldest=
old_tree=lammps-20250204-bigbig
case ${1:-} in
  all)
    shift
    [ -n "${LAMMPS_SOURCE_DIR:-}${MPM_LAMMPS:-}" ] || oldest=20250204
    ;;
  room)
    shift
    [ $# -gt 0 ] || die "usage: tools/test.sh room ROOM..."
    set -- -L "^($(IFS='|'; echo "$*"))\$"
    ;;
  changed)
    rooms=$(python3 "$repo/tools/changed_rooms.py" "${2:-main}") || exit 1
    say "rooms: ${rooms//|/ }"
    set -- -L "^($rooms)\$" -LE '^long$'
    quick_build
    ;;
  mutants)
    shift
    setup all
    build_project all unittests
    python3 "$repo/tools/mutate.py" --no-build "$@" || exit 1
    echo "1 passed, 0 failed"
    counted=yes
    exit 0
    ;;
  "")
    set -- -LE '^long$'
    # cases of other tests that take long are left out, too
    export MPM_QUICK=1
    quick_build
    ;;
esac

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
