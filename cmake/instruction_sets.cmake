# The step is compiled once an instruction set, with the width of its registers; which one runs is
# chosen when a batch is made. The compiler says what it builds for: names of processors differ from
# system to system, and in a cross build they are the wrong ones.
include(CheckCXXSourceCompiles)
foreach(target x86_64 aarch64 wasm32)
  check_cxx_source_compiles("#ifndef __${target}__\n#error\n#endif\nint main() {}" TAUT_ON_${target})
endforeach()
set(known scalar)  # one world at a time, on any machine
if(TAUT_ON_x86_64)
  list(APPEND known sse2 avx2 avx512)
elseif(TAUT_ON_aarch64)
  list(APPEND known neon)
elseif(TAUT_ON_wasm32)
  list(APPEND known simd128)
endif()
if(TAUT_BROWSER)
  set(known_default scalar)  # a page steps one world
else()
  set(known_default ${known})
endif()
set(TAUT_INSTRUCTION_SETS ${known_default} CACHE STRING
  "What the step is compiled for; of these, the widest that a machine has runs there")
foreach(set IN LISTS TAUT_INSTRUCTION_SETS)
  if(NOT set IN_LIST known)
    message(FATAL_ERROR "TAUT_INSTRUCTION_SETS: this compiler's target has no \"${set}\", only ${known}")
  endif()
endforeach()
if(NOT scalar IN_LIST TAUT_INSTRUCTION_SETS)
  message(FATAL_ERROR "TAUT_INSTRUCTION_SETS: \"scalar\" is always needed, for single worlds")
endif()

# For all that is part of the step. -fno-math-errno lets sqrt be one instruction; neither changes a
# result.
set(TAUT_STEP_FLAGS -fno-math-errno -fno-trapping-math)
if(TAUT_BROWSER)
  set(TAUT_STEP_LEVEL -Os CACHE STRING "How the step is optimised: small for a page, -O3 for speed")
  list(APPEND TAUT_STEP_FLAGS ${TAUT_STEP_LEVEL})
endif()
set(TAUT_FLAGS_simd128 -msimd128)
set(TAUT_FLAGS_avx2 -mavx2)
# g++ 12 makes fused multiply-adds of straight-line code that alternates + and - (vfmsubadd), whatever
# -ffp-contract says, where the target has them: other bits. Lanes are vectors by type and lose nothing.
set(TAUT_FLAGS_avx512 -mavx512f -mavx512dq -mavx512vl -mprefer-vector-width=512 -fno-tree-slp-vectorize)

# TAUT_HAS_AVX2 and the like, for text that names a kernel.
set(TAUT_HAS ${TAUT_INSTRUCTION_SETS})
list(TRANSFORM TAUT_HAS TOUPPER)
list(TRANSFORM TAUT_HAS PREPEND TAUT_HAS_)

# taut_kernels(target prefix [set ...]): adds PREFIX_SET.cpp for these instruction sets to the target, and defines their
# TAUT_HAS_*.
function(taut_kernels target prefix)
  foreach(set IN LISTS ARGN)
    target_sources(${target} PRIVATE ${prefix}_${set}.cpp)
    set_source_files_properties(${prefix}_${set}.cpp PROPERTIES COMPILE_OPTIONS
      "${TAUT_STEP_FLAGS};${TAUT_FLAGS_${set}}")
    string(TOUPPER TAUT_HAS_${set} has)
    target_compile_definitions(${target} PRIVATE ${has})
  endforeach()
endfunction()
