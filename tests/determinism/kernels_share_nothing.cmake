# cmake -DNM=... -DSETS=scalar,sse2,... -DOBJECTS=a.o,b.o,... -P kernels_share_nothing.cmake
#
# Checks that no two of src/sim/step/step_*.cpp, and no two of src/plant/lane_*.cpp, emit the same
# function: the linker would keep one of them, possibly with instructions that the machine lacks.
# Optimization hides such functions, so debug builds detect most.
cmake_minimum_required(VERSION 3.25)
string(REPLACE "," ";" objects "${OBJECTS}")
string(REPLACE "," "|" sets "${SETS}")
list(FILTER objects INCLUDE REGEX "/(step|lane)_(${sets})\\.cpp\\.o$")
list(LENGTH objects count)
string(REPLACE "," ";" sets "${SETS}")
list(LENGTH sets expected)
if(NOT count EQUAL expected)
  message(FATAL_ERROR "kernels of ${SETS} expected, not ${count}: ${OBJECTS}")
endif()
set(seen)
set(shared)
foreach(object ${objects})
  execute_process(COMMAND ${NM} --defined-only ${object} OUTPUT_VARIABLE symbols
    COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL " W [^\n]+" weak "${symbols}")
  list(REMOVE_DUPLICATES weak)
  foreach(function ${weak})
    if(function IN_LIST seen)
      list(APPEND shared "${function}")
    endif()
  endforeach()
  list(APPEND seen ${weak})
endforeach()
if(shared)
  list(JOIN shared "\n " text)
  message(FATAL_ERROR "in more than one kernel:\n ${text}")
endif()
