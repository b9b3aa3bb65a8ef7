#!/bin/bash
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# Writes the tables of parameters and history variables of all laws, which the
# manual includes, from their declarations:
#   tools/law_tables.sh        environment: see tools/build.sh

set -u
tools=$(dirname "${BASH_SOURCE[0]}")
"$tools/build.sh" test_law_tables >/dev/null || { "$tools/build.sh" test_law_tables; exit 1; }
MPM_WRITE=1 "${MPM_BUILD_DIR:-$tools/../build}/unittest/test_law_tables" --gtest_filter='*UpToDate' |
  grep -e '^wrote' -e FAILED || echo "the tables are up to date"
