# cmake -DCOMPILER=... -DKIND=host|avr -DSOURCE_DIR=... -DWORK_DIR=... -P control_freestanding.cmake
#
# Every header of include/taut/control and include/taut/board compiles alone as C++14 without a standard library, and a
# program that uses all of it needs no library, except the compiler's software arithmetic on an AVR: no libm, no heap,
# no exceptions.
if(NOT COMPILER)
  message(STATUS "skipped: no avr-g++ here (Debian: gcc-avr)")
  return()
endif()
set(flags -std=c++14 -ffreestanding -fno-exceptions -fno-rtti -fno-threadsafe-statics
  -ffp-contract=off -Os -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wdouble-promotion -Werror
  -I${SOURCE_DIR}/include)
if(KIND STREQUAL avr)
  list(APPEND flags -mmcu=atmega328p)
endif()

file(MAKE_DIRECTORY ${WORK_DIR})
file(GLOB headers ${SOURCE_DIR}/include/taut/control/*.h ${SOURCE_DIR}/include/taut/board/*.h)
list(LENGTH headers count)
if(count LESS 15)
  message(FATAL_ERROR "only ${count} headers in include/taut/control and include/taut/board")
endif()
foreach(header IN LISTS headers)
  execute_process(COMMAND ${COMPILER} ${flags} -fsyntax-only -x c++ -include ${header} /dev/null
    RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "${header} does not compile alone as freestanding C++14")
  endif()
endforeach()

set(source ${SOURCE_DIR}/tests/unit/control/control_freestanding.cpp)
set(object ${WORK_DIR}/control_${KIND}.o)
execute_process(COMMAND ${COMPILER} ${flags} -c ${source} -o ${object} RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "${source} does not compile")
endif()
execute_process(COMMAND ${COMPILER} -print-prog-name=nm OUTPUT_VARIABLE nm
  OUTPUT_STRIP_TRAILING_WHITESPACE)
execute_process(COMMAND ${nm} -u ${object} RESULT_VARIABLE failed OUTPUT_VARIABLE needed)
string(REGEX MATCHALL "U [^\n]+" needed "${needed}")
if(KIND STREQUAL avr)
  # the compiler's software + - * /, comparisons and conversions: __addsf3, __floatdisf
  list(FILTER needed EXCLUDE REGEX
    "^U __(do_copy_data|tablejump2__|unordsf2|usmulhisi3|(add|sub|mul|div|neg|cmp|fix|float|[gln][et]|eq)[a-z0-9_]*)$")
else()
  # g++ assumes memcpy and similar functions even so, and copies structures with it on AArch64
  list(FILTER needed EXCLUDE REGEX "^U (_GLOBAL_OFFSET_TABLE_|__stack_chk_fail|mem(cpy|move|set|cmp))$")
endif()
if(failed OR needed)
  message(FATAL_ERROR "the controllers need something from outside: ${needed}")
endif()
message(STATUS "${count} headers and control_freestanding.cpp are freestanding (${KIND})")
