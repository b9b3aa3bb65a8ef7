# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# mpmplugin.so for 'plugin load' or LAMMPS_PLUGIN_PATH.  It takes LAMMPS's symbols
# from the running lmp (not linked with liblammps: that would be a second copy) and
# must never be unloaded while an atom style of ours is in use (-z nodelete).

set(dir ${CMAKE_BINARY_DIR}/plugin_styles)
foreach(kind ${MPM_STYLE_KINDS})
  mpm_style_includes(${kind} text)
  mpm_write(${dir}/mpm_style_${kind}.h "${text}")
endforeach()

mpm_object_library(mpm_plugin_objects ${MPM_PLUGIN_SOURCES})
target_include_directories(mpm_plugin_objects PRIVATE ${dir})

get_property(MPM_OBJECTS GLOBAL PROPERTY MPM_OBJECTS)
add_library(mpmplugin MODULE $<TARGET_OBJECTS:mpm_plugin_objects> ${MPM_OBJECTS})
mpm_depends_on_core(mpmplugin)
set_target_properties(mpmplugin PROPERTIES PREFIX "" SUFFIX ".so" LINKER_LANGUAGE CXX
  LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
target_link_libraries(mpmplugin PRIVATE ${MPM_LIBRARIES})
if(APPLE)
  target_link_options(mpmplugin PRIVATE -undefined dynamic_lookup)
else()
  target_link_options(mpmplugin PRIVATE -Wl,-z,nodelete)
endif()
install(TARGETS mpmplugin LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/lammps-mpm OPTIONAL)
