# cmake -DPROBE=... -DPROGRAM=test [-DEXPERIMENT=file -DWORK_DIR=folder] -P masked_libm.cmake
#
# glibc selects variants of sin, exp and others by processor: variants with fused multiply-add differ in
# the last bits from the variants of older machines. This test masks them, as on an older machine:
#   PROGRAM               a test program passes with the mask, too
#   PROGRAM, EXPERIMENT   `taut run` of the experiment ends in the same state, with the same inputs
# First the probe shows that the mask changes the C library's results: otherwise the test is void.
set(mask GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4)

function(run_probe result)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env ${ARGN} ${PROBE} OUTPUT_VARIABLE out
    RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "${PROBE} failed")
  endif()
  set(${result} ${out} PARENT_SCOPE)
endfunction()
run_probe(plain)
run_probe(masked ${mask})
if(plain STREQUAL masked)
  message(STATUS "skipped: this machine's C library has nothing to mask")
  return()
endif()

if(NOT EXPERIMENT)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env ${mask} ${PROGRAM} RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "${PROGRAM} fails with glibc's FMA variants masked")
  endif()
  return()
endif()

foreach(kind plain masked)
  set(env "")
  if(kind STREQUAL masked)
    set(env ${mask})
  endif()
  execute_process(COMMAND ${CMAKE_COMMAND} -E env ${env} ${PROGRAM} run ${EXPERIMENT} --quiet --out
    ${WORK_DIR}/${kind} RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "taut run ${EXPERIMENT} failed")
  endif()
  file(READ ${WORK_DIR}/${kind}/summary.json summary)
  string(JSON hash_${kind} GET "${summary}" state_hash)
  file(READ ${WORK_DIR}/${kind}/inputs.yaml inputs)
  string(REGEX REPLACE "^# run [^\n]*\n" "" inputs "${inputs}")  # differs from run to run
  string(SHA256 inputs_${kind} "${inputs}")
endforeach()
if(NOT hash_plain STREQUAL hash_masked OR NOT inputs_plain STREQUAL inputs_masked)
  message(FATAL_ERROR "with glibc's FMA variants masked: state ${hash_masked}, not ${hash_plain}; "
    "inputs ${inputs_masked}, not ${inputs_plain}")
endif()
message(STATUS "state ${hash_plain} either way")
