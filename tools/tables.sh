#!/bin/bash
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# Writes the parts of the manual that are made from declarations in the source:
# tables of parameters and history variables of all laws, keywords of all styles, what goes with what:
#   tools/tables.sh        environment: see tools/build.sh

set -u
tools=$(dirname "${BASH_SOURCE[0]}")
tests="test_law_tables test_option_tables test_combinations"
"$tools/build.sh" $tests >/dev/null || { "$tools/build.sh" $tests; exit 1; }
for test in $tests; do
  MPM_WRITE=1 "${MPM_BUILD_DIR:-$tools/../build}/unittest/$test" --gtest_filter='*UpToDate'
done | grep -e '^wrote' -e FAILED || echo "the tables are up to date"
