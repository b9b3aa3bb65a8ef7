# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# MPM_SANITIZE=on: the package and its tests, and not LAMMPS, are compiled with the
# sanitizers of addresses and of undefined behaviour, and with the checks of the
# standard library and of Eigen; they end the program at the first wrong access.
# Memory that LAMMPS allocates is watched, too.  Kernels and laws for instruction sets
# are as always, as the optimizer would need many minutes for each file: the test
# sanitize.units has them.  See tools/sanitize.sh.

option(MPM_SANITIZE "Compile the package and its tests with sanitizers" OFF)

set(MPM_SANITIZERS)
if(MPM_SANITIZE)
  set(CMAKE_CXX_FLAGS_RELEASE "")
  set(MPM_SANITIZERS -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all)
endif()

# after the other options of a target
function(mpm_sanitize target)
  if(MPM_SANITIZE)
    target_compile_options(${target} PRIVATE ${MPM_SANITIZERS} -O1 -g1 -fno-omit-frame-pointer -UNDEBUG
      "SHELL:-include ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/sanitize.h")
    target_compile_definitions(${target} PRIVATE MPM_SANITIZED _GLIBCXX_ASSERTIONS)
  endif()
endfunction()
