# cmake -DNM=... -DSETS=scalar,sse2,... -DOBJECTS=a.o,b.o,... -P kernels_need_no_library.cmake
#
# Checks that the code of a step, pairs of shapes included, calls no library: no heap, no container, no
# exception, no libm. Allowed are copies and fills of memory by compilers, calls by sanitizers, and g++'s
# reference to its exception handling in noexcept functions that call functions without noexcept.
cmake_minimum_required(VERSION 3.25)
string(REPLACE "," ";" objects "${OBJECTS}")
string(REPLACE "," "|" sets "${SETS}")
list(FILTER objects INCLUDE REGEX "/(step_(${sets})|shape_[a-z_]+)\\.cpp\\.o$")
list(LENGTH objects count)
string(REPLACE "," ";" sets "${SETS}")
list(LENGTH sets expected)
math(EXPR expected "${expected} + 4")
if(count LESS expected)
  message(FATAL_ERROR "kernels of ${SETS} and 4 files of shapes expected, not ${count}: ${OBJECTS}")
endif()
set(foreign)
foreach(object ${objects})
  execute_process(COMMAND ${NM} --undefined-only --demangle ${object} OUTPUT_VARIABLE symbols
    COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "[UVvw] [^\n]+" symbols "${symbols}")
  foreach(symbol ${symbols})
    if(NOT symbol MATCHES "^. (taut::(sim::|base::AssertionFailed)|mem(cpy|set|move)$|_GLOBAL_OFFSET_TABLE_$|__stack_chk_fail$|__gxx_personality_v0$|__(asan|ubsan|tsan)_)")
      cmake_path(GET object FILENAME name)
      list(APPEND foreign "${name}: ${symbol}")
    endif()
  endforeach()
endforeach()
if(foreign)
  list(JOIN foreign "\n " text)
  message(FATAL_ERROR "not of the step:\n ${text}")
endif()
