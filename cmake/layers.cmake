# taut_layer(name SOURCES ... USES layer ... LIBRARIES target ...)
#
# One static library a folder of src/. USES names the layers it may include; script/lint checks
# the includes themselves against layers.txt.
add_library(taut_options INTERFACE)
add_library(taut::options ALIAS taut_options)
target_compile_features(taut_options INTERFACE cxx_std_20)
# The same bits everywhere: no fused multiply-add behind the code's back, and no "fast" maths.
target_compile_options(taut_options INTERFACE -ffp-contract=off -fno-fast-math)

# -Wno-restrict: g++ 12 warns falsely about "text" + std::string (GCC bug 105651).
add_library(taut_warnings INTERFACE)
target_compile_options(taut_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  -Wno-sign-conversion -Wno-psabi $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  $<$<BOOL:${TAUT_WARNINGS_AS_ERRORS}>:-Werror>)

# taut_outside_step(target LEVEL): for a target whose code does not run in a step. It is optimized at LEVEL
# instead of -O3 (-O1 compiles in two thirds of the time), and its files are compiled sixteen at a time
# (unity build), which halves the time again: headers are parsed and templates instantiated once for
# all of them. Files with options of their own, and those with SKIP_UNITY_BUILD_INCLUSION, are compiled one
# by one. Editors and clang-tidy need a build file by file: preset "tidy".
option(TAUT_UNITY_BUILD "Compile several files at a time" ON)
function(taut_outside_step target level)
  if(NOT TAUT_BROWSER)  # there the level is small size, -Oz, for all (cmake/browser.cmake)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:${level}>)
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${TAUT_UNITY_BUILD} UNITY_BUILD_BATCH_SIZE 16)
endfunction()

function(taut_layer name)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES;LIBRARIES" ${ARGN})
  add_library(taut_${name} STATIC ${ARG_SOURCES})
  add_library(taut::${name} ALIAS taut_${name})
  set_target_properties(taut_${name} PROPERTIES EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY TAUT_LAYERS ${name})
  target_include_directories(taut_${name}
    PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>
    PRIVATE ${PROJECT_SOURCE_DIR}/src)
  foreach(layer IN LISTS ARG_USES)
    target_link_libraries(taut_${name} PUBLIC taut::${layer})
  endforeach()
  target_link_libraries(taut_${name} PUBLIC taut::options PRIVATE ${ARG_LIBRARIES}
    $<BUILD_INTERFACE:taut_warnings>)
endfunction()
