# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# Adds the package to LAMMPS's own build, without a change to LAMMPS:
#   cmake -S lammps/cmake -B build -D CMAKE_PROJECT_lammps_INCLUDE=<repo>/cmake/mpm_inject.cmake
# Included by LAMMPS's project().  LAMMPS collects style headers in global
# properties that it only appends to; sources are added at the end of its
# CMakeLists.txt.

if(CMAKE_VERSION VERSION_LESS 3.20)
  message(FATAL_ERROR "The MPM package needs CMake 3.20 or newer")
endif()
include(${CMAKE_CURRENT_LIST_DIR}/mpm_sources.cmake)

foreach(kind ${MPM_STYLE_KINDS})
  string(TOUPPER ${kind} property)
  string(REPLACE ATOM ATOM_VEC property ${property})
  set_property(GLOBAL APPEND PROPERTY ${property} ${MPM_STYLE_${kind}})
endforeach()

function(mpm_inject)
  set(MPM_LAMMPS_INCLUDES $<TARGET_PROPERTY:lammps,INCLUDE_DIRECTORIES>)
  set(MPM_LAMMPS_DEFINITIONS $<TARGET_PROPERTY:lammps,COMPILE_DEFINITIONS>)
  mpm_add_objects()
  get_property(MPM_OBJECTS GLOBAL PROPERTY MPM_OBJECTS)
  mpm_installed_packages(${LAMMPS_STYLE_HEADERS_DIR} ${CMAKE_CURRENT_BINARY_DIR}/mpm_styles)
  target_sources(lammps PRIVATE ${MPM_OBJECTS})
  mpm_depends_on_core(lammps)
  target_link_libraries(lammps PRIVATE ${MPM_LIBRARIES})
  target_include_directories(lammps BEFORE PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/mpm_styles)
  target_include_directories(lammps PRIVATE ${MPM_DIR} ${MPM_STYLE_ROOMS})
  include(${MPM_ROOT}/cmake/mpm_install.cmake)
  message(STATUS "MPM package added to LAMMPS, kernels for: ${MPM_ISA_SETS}")
endfunction()
cmake_language(DEFER CALL mpm_inject)
