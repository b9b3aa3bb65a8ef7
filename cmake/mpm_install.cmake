# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# What 'cmake --install' puts where, for every way to build.  The package finds its
# material files in share/lammps-mpm/potentials of a folder above its executable,
# library, or plugin; the build tree has this folder, too, as a link.

include_guard(GLOBAL)
include(GNUInstallDirs)
set(MPM_DATADIR ${CMAKE_INSTALL_DATADIR}/lammps-mpm)

file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share/lammps-mpm)
file(CREATE_LINK ${MPM_ROOT}/potentials ${CMAKE_BINARY_DIR}/share/lammps-mpm/potentials
  COPY_ON_ERROR SYMBOLIC)

# materials, scenes, and what these refer to, in the folders of the source tree
install(DIRECTORY ${MPM_ROOT}/potentials DESTINATION ${MPM_DATADIR} FILES_MATCHING PATTERN "*.mpm")
install(DIRECTORY ${MPM_ROOT}/examples DESTINATION ${MPM_DATADIR} USE_SOURCE_PERMISSIONS
  PATTERN build EXCLUDE PATTERN __pycache__ EXCLUDE PATTERN "log.lammps" EXCLUDE)
install(DIRECTORY ${MPM_ROOT}/tools DESTINATION ${MPM_DATADIR} USE_SOURCE_PERMISSIONS
  FILES_MATCHING PATTERN "*.py" PATTERN __pycache__ EXCLUDE PATTERN spack EXCLUDE REGEX "/(fuzz.*|mutate|count_tests|gallery)\\.py$" EXCLUDE)
install(DIRECTORY ${MPM_DIR} DESTINATION ${MPM_DATADIR}/src FILES_MATCHING PATTERN "*.h")
install(FILES ${MPM_ROOT}/README.md ${MPM_ROOT}/LICENSE ${MPM_ROOT}/CITATION.cff
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/lammps-mpm)

# the manual, where it has been built
foreach(python python3 /usr/bin/python3)
  execute_process(COMMAND ${python} -c "import sphinx" RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
  if(NOT failed)
    add_custom_target(mpm_manual COMMAND ${python} -m sphinx -q -b html ${MPM_ROOT}/doc ${CMAKE_BINARY_DIR}/doc
      COMMENT "Manual in ${CMAKE_BINARY_DIR}/doc")
    break()
  endif()
endforeach()
install(DIRECTORY ${CMAKE_BINARY_DIR}/doc/ DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/lammps-mpm/html OPTIONAL
  PATTERN .doctrees EXCLUDE PATTERN .buildinfo EXCLUDE)
