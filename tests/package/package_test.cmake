# cmake -DKIND=find_package|add_subdirectory|core_as_subdirectory -DBINARY_DIR=... -DSOURCE_DIR=... -DWORK_DIR=...
#       -DCXX=... -DCXX_FLAGS=... -DBUILD_TYPE=... -DVERSION=... -P package_test.cmake
#
# Builds and runs a program outside of the tree with an installed taut, or with taut as a subfolder. The flags
# equal the flags of the build under test, except for the core.
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(failed)
    string(REPLACE ";" " " command "${ARGV}")
    message(FATAL_ERROR "${command}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

set(prefix ${WORK_DIR}/prefix)
set(build ${WORK_DIR}/build)
file(REMOVE_RECURSE ${WORK_DIR})
set(configure ${CMAKE_COMMAND} -S ${SOURCE_DIR}/tests/package/consumer -B ${build} -G Ninja
  -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_CXX_FLAGS=${CXX_FLAGS} -DCMAKE_BUILD_TYPE=${BUILD_TYPE}
  -DTAUT_WARNINGS_AS_ERRORS=ON)

if(KIND STREQUAL find_package)
  run(${CMAKE_COMMAND} --install ${BINARY_DIR} --prefix ${prefix})
  run(${configure} -DCMAKE_PREFIX_PATH=${prefix} -DTAUT_WANTED_VERSION=${VERSION})
  set(model ${prefix}/share/taut/models/tetraspine3.yaml)
  # the installed command works with the installed files
  run(${prefix}/bin/taut --version)
  if(NOT output MATCHES "taut ${VERSION}")
    message(FATAL_ERROR "the installed command says it is \"${output}\", not taut ${VERSION}")
  endif()
  run(${prefix}/bin/taut check ${prefix}/share/taut/experiments/push_20n.yaml)
  # files for shells, man and readers
  foreach(file IN ITEMS share/man/man1/taut.1 share/bash-completion/completions/taut
      share/zsh/site-functions/_taut share/fish/vendor_completions.d/taut.fish
      share/doc/taut/LICENSE share/doc/taut/NOTICE share/doc/taut/docs/cli.md
      share/doc/taut/examples/tip_over.cpp)
    if(NOT EXISTS ${prefix}/${file})
      message(FATAL_ERROR "${file} is not installed")
    endif()
    file(SIZE ${prefix}/${file} size)
    if(size EQUAL 0)
      message(FATAL_ERROR "${file} is empty")
    endif()
  endforeach()
  run(${prefix}/bin/taut list models)
  string(FIND "${output}" "models, in ${prefix}/share/taut/models" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "the installed command lists \"${output}\"")
  endif()
  # no installed file refers to the build or source folder
  file(GLOB_RECURSE texts ${prefix}/*.cmake ${prefix}/*.h ${prefix}/*.yaml ${prefix}/share/man/*
    ${prefix}/share/bash-completion/* ${prefix}/share/zsh/* ${prefix}/share/fish/*)
  foreach(file IN LISTS texts)
    file(READ ${file} text)
    foreach(folder IN ITEMS ${BINARY_DIR} ${SOURCE_DIR})
      string(FIND "${text}" "${folder}/" at)
      if(NOT at EQUAL -1)
        message(FATAL_ERROR "${file} mentions ${folder}")
      endif()
    endforeach()
  endforeach()
  # the Python module is a separate component, for the python3 of the build
  file(GLOB_RECURSE strangers ${prefix}/*_core*)
  if(strangers)
    message(FATAL_ERROR "${strangers} is installed with taut")
  endif()
  if(PYTHON)
    run(${CMAKE_COMMAND} --install ${BINARY_DIR} --component python --prefix ${WORK_DIR}/python)
    run(${CMAKE_COMMAND} -E env PYTHONPATH=${WORK_DIR}/python/lib/python3/dist-packages ${PYTHON} -c
      "print((t := __import__('taut')).__version__, t.__file__, t.load('${model}'))")
    if(NOT output MATCHES "${VERSION} ${WORK_DIR}/python/.*12 cables")
      message(FATAL_ERROR "the installed module says \"${output}\"")
    endif()
  endif()
  # GPL parts are a separate component, with their firmware
  file(GLOB_RECURSE strangers ${prefix}/*virtual_robot ${prefix}/*simavr* ${prefix}/*.elf)
  if(strangers)
    message(FATAL_ERROR "${strangers} is installed with taut")
  endif()
  if(EXISTS ${BINARY_DIR}/taut_virtual_robot)
    set(robot ${WORK_DIR}/robot)
    run(${CMAKE_COMMAND} --install ${BINARY_DIR} --component virtual_robot --prefix ${robot})
    file(GLOB_RECURSE installed RELATIVE ${robot} ${robot}/*)
    if(NOT installed STREQUAL "bin/taut_virtual_robot;share/doc/taut/LICENSE;share/doc/taut/NOTICE;\
share/taut/firmware/taut_board.elf;share/taut/firmware/taut_board.hex")
      message(FATAL_ERROR "the virtual robot is installed as ${installed}")
    endif()
    set(short ${robot}/bin/taut_virtual_robot --run --duration_s 0.1 --quiet
      --experiment ${prefix}/share/taut/experiments/push_20n_motors.yaml)
    run(${short} --out ${WORK_DIR}/on_boards)
    # the virtual robot used the installed firmware, not the firmware of the build
    file(REMOVE_RECURSE ${robot}/share/taut/firmware)
    execute_process(COMMAND ${short} --out ${WORK_DIR}/none RESULT_VARIABLE status ERROR_VARIABLE said)
    if(NOT status EQUAL 2 OR NOT said MATCHES "firmware ELF is missing")
      message(FATAL_ERROR "without its firmware the virtual robot ends with ${status}: ${said}")
    endif()
  endif()
elseif(KIND STREQUAL core_as_subdirectory)
  # Without optimization, to reduce the compile time
  run(${configure} -DTAUT_SOURCE_DIR=${SOURCE_DIR} -DTAUT_INSTRUCTION_SETS=scalar
    -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0)
  run(${CMAKE_COMMAND} --build ${build} --target core)
  run(${build}/core)
  if(NOT output MATCHES "taut ${VERSION}: 1 cable")
    message(FATAL_ERROR "the program printed \"${output}\"")
  endif()
  return()
else()
  run(${configure} -DTAUT_SOURCE_DIR=${SOURCE_DIR})
  set(model ${SOURCE_DIR}/share/models/tetraspine3.yaml)
endif()
run(${CMAKE_COMMAND} --build ${build} --target consumer)
run(${build}/consumer ${model} ${WORK_DIR}/consumer.h5)
if(NOT output MATCHES "taut ${VERSION}: 12 cables")
  message(FATAL_ERROR "the consumer said \"${output}\"")
endif()
message(STATUS "${output}")
