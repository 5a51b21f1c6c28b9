# cmake -DOBJDUMP=... -DSETS=scalar,sse2,... -DOBJECTS=a.o,b.o,... -P kernels_fuse_nothing.cmake
#
# Checks that no kernel contains a fused multiply-add, which rounds once instead of twice and so gives
# other bits than machines without it. Compiler options forbid it; g++ 12 still generates some
# (cmake/instruction_sets.cmake).
cmake_minimum_required(VERSION 3.25)
string(REPLACE "," ";" objects "${OBJECTS}")
string(REPLACE "," "|" sets "${SETS}")
list(FILTER objects INCLUDE REGEX "/(step|lane)_(${sets})\\.cpp\\.o$")
if(NOT objects)
  message(FATAL_ERROR "there is no kernel of ${SETS} among ${OBJECTS}")
endif()
foreach(object ${objects})
  execute_process(COMMAND ${OBJDUMP} -d --no-show-raw-insn ${object} OUTPUT_VARIABLE code
    COMMAND_ERROR_IS_FATAL ANY)
  # x86-64: vfmadd, vfnmsub, vfmaddsub ...; AArch64: fmadd, fmla, fnmsub ...
  string(REGEX MATCHALL "\tv?fn?m(add|sub|la|ls)[^\n]*" fused "${code}")
  list(LENGTH fused count)
  if(count GREATER 0)
    list(SUBLIST fused 0 3 some)
    list(JOIN some "\n " text)
    message(FATAL_ERROR "${object} has ${count} fused multiply-adds:\n ${text}")
  endif()
endforeach()
