# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# MPM_DEMO=on, for tools/demo.sh: an lmp from those two fifths of LAMMPS that this package
# and the scene of the demonstration need, before the rest has been compiled.  Styles of the
# kinds below are left out, unless a file that is needed includes their header.  The object
# files are those of the stock build, whose paths go to demo_objects.txt.

set(MPM_DEMO_KINDS pair compute fix kspace angle bond dihedral improper)
set(MPM_DEMO_STYLES compute_reduce compute_temp compute_pressure compute_pe compute_ke fix_halt fix_nve)

# headers of styles that are not ours, and their files
set(optional)
foreach(kind ${MPM_DEMO_KINDS})
  file(STRINGS ${LAMMPS_BUILD_DIR}/styles/style_${kind}.h lines REGEX "^#include")
  string(REGEX REPLACE "#include \"([^\"]*)\\.h\"" "\\1" names "${lines}")
  list(APPEND optional ${names})
endforeach()

# all files of LAMMPS by name, and those that are needed in any case
set(todo ${MPM_SOURCES} ${MPM_HEADERS})
set(names ${MPM_DEMO_STYLES})
foreach(dir ${LAMMPS_INCLUDE_DIRS})
  if(dir MATCHES "^${LAMMPS_DIR}/src")
    file(GLOB files ${dir}/*.cpp ${dir}/*.h)
    foreach(file ${files})
      get_filename_component(name ${file} NAME_WE)
      list(APPEND files_of_${name} ${file})
      if(file MATCHES "\\.cpp$" AND dir MATCHES "/src(/GRAPHICS|/PLUGIN)?$" AND NOT name IN_LIST optional)
        list(APPEND names ${name})
      endif()
    endforeach()
  endif()
endforeach()

# and whatever these include, and so on
while(names OR todo)
  foreach(name ${names})
    if(NOT needed_${name})
      set(needed_${name} ON)
      list(APPEND todo ${files_of_${name}})
    endif()
  endforeach()
  set(names)
  foreach(file ${todo})
    file(STRINGS ${file} lines REGEX "^#include \"[A-Za-z0-9_]+\\.h\"")
    string(REGEX REPLACE "#include \"([A-Za-z0-9_]+)\\.h\"[^;]*" "\\1" found "${lines}")
    list(APPEND names ${found})
  endforeach()
  list(REMOVE_DUPLICATES names)
  set(todo)
endwhile()

# stock list of a kind of style without those that are not needed
function(mpm_demo_list kind out)
  file(STRINGS ${LAMMPS_BUILD_DIR}/styles/style_${kind}.h lines REGEX "^#include")
  set(text)
  foreach(line ${lines})
    string(REGEX REPLACE "#include \"([^\"]*)\\.h\"" "\\1" name "${line}")
    if(needed_${name})
      string(APPEND text "${line}\n")
    endif()
  endforeach()
  set(${out} "${text}" PARENT_SCOPE)
endfunction()
foreach(kind ${MPM_DEMO_KINDS})
  if(NOT MPM_STYLE_${kind})
    mpm_demo_list(${kind} text)
    mpm_write(${MPM_STYLES_DIR}/style_${kind}.h "${text}")
  endif()
endforeach()

# object files of the stock build but for those in the argument, which are compiled with our lists
function(mpm_demo_objects compiled_here out)
  foreach(source ${compiled_here})
    get_filename_component(name ${source} NAME_WE)
    set(needed_${name} OFF)
  endforeach()
  file(STRINGS ${LAMMPS_BUILD_DIR}/CMakeFiles/lammps.dir/link.txt line LIMIT_COUNT 1)
  string(REGEX MATCHALL "CMakeFiles/lammps\\.dir/[^ \"]*\\.o" objects "${line}")
  set(list)
  set(text)
  foreach(object ${objects})
    get_filename_component(name ${object} NAME_WE)
    if(needed_${name})
      list(APPEND list ${LAMMPS_BUILD_DIR}/${object})
      string(APPEND text "${object}\n")
    endif()
  endforeach()
  mpm_write(${CMAKE_BINARY_DIR}/demo_objects.txt "${text}")
  set(${out} ${list} PARENT_SCOPE)
endfunction()
