# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# Included by LAMMPS's project() in the stock build of tools/build.sh
# (-D CMAKE_PROJECT_lammps_INCLUDE).  Two things: precompiled headers, which
# make the build three times faster, and mpm_lammps.cmake in the build tree,
# which tells the overlay build how LAMMPS was compiled.

function(mpm_stock_build)
  foreach(header pointers atom comm compute domain error fix force group memory modify neighbor
          neigh_list pair update)
    target_precompile_headers(lammps PRIVATE ${LAMMPS_SOURCE_DIR}/${header}.h)
  endforeach()
  target_precompile_headers(lammps PRIVATE <algorithm> <cmath> <cstring> <map> <set> <string> <vector>)

  file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/mpm_lammps.cmake CONTENT
"set(LAMMPS_DIR \"${LAMMPS_DIR}\")
set(LAMMPS_SIZES \"${LAMMPS_SIZES}\")
set(LAMMPS_DEFINITIONS \"$<TARGET_PROPERTY:lammps,COMPILE_DEFINITIONS>\")
set(LAMMPS_INCLUDE_DIRS \"$<TARGET_PROPERTY:lammps,INCLUDE_DIRECTORIES>\")
")
endfunction()
cmake_language(DEFER CALL mpm_stock_build)
