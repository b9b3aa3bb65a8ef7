# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# Target mpm_python: LAMMPS's Python module in the folder python of the build tree, with a
# shared library that has the package in it.  All object files are compiled for shared
# libraries, so that it takes seconds: the stock liblammps.a without those files that the
# overlay has compiled with its own lists of styles, and the objects of this package.

set(module ${CMAKE_BINARY_DIR}/python/lammps)
set(rest ${CMAKE_BINARY_DIR}/liblammps_rest.a)
set(members)
foreach(source ${LAMMPS_STYLE_SOURCES})
  get_filename_component(name ${source} NAME)
  list(APPEND members ${name}.o)
endforeach()
add_custom_command(OUTPUT ${rest} DEPENDS ${LAMMPS_BUILD_DIR}/liblammps.a
  COMMAND ${CMAKE_COMMAND} -E copy ${LAMMPS_BUILD_DIR}/liblammps.a ${rest}
  COMMAND ${CMAKE_AR} d ${rest} ${members}
  COMMENT "LAMMPS without its lists of styles")

add_library(mpm_python SHARED EXCLUDE_FROM_ALL $<TARGET_OBJECTS:lammps_styles> ${MPM_OBJECTS} ${rest})
mpm_depends_on_core(mpm_python)
set_target_properties(mpm_python PROPERTIES OUTPUT_NAME lammps PREFIX lib SUFFIX .so LINKER_LANGUAGE CXX
  LIBRARY_OUTPUT_DIRECTORY ${module})
target_link_libraries(mpm_python PRIVATE -Wl,--whole-archive ${rest} -Wl,--no-whole-archive ${link}
  ${MPM_LIBRARIES})
target_link_options(mpm_python PRIVATE LINKER:--strip-debug)

file(GLOB_RECURSE files RELATIVE ${LAMMPS_DIR}/python/lammps ${LAMMPS_DIR}/python/lammps/*.py)
foreach(file ${files})
  configure_file(${LAMMPS_DIR}/python/lammps/${file} ${module}/${file} COPYONLY)
endforeach()

install(DIRECTORY ${CMAKE_BINARY_DIR}/python DESTINATION ${CMAKE_INSTALL_LIBDIR}/lammps-mpm
  FILES_MATCHING PATTERN "*.py" PATTERN "liblammps.so")
