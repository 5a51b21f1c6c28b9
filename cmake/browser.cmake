# What the browser's build stands on, of which Debian has no libraries for WebAssembly: headers of its
# packages for this machine, which are the same for all, and yaml-cpp from its source package
# (script/wasm fetches that).
set(headers ${PROJECT_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${headers})
foreach(name IN ITEMS fmt nlohmann)
  # Not all of /usr/include, which has another C library's headers.
  file(CREATE_LINK /usr/include/${name} ${headers}/${name} SYMBOLIC)
endforeach()
add_library(headers_of_this_machine INTERFACE)
target_include_directories(headers_of_this_machine SYSTEM INTERFACE ${headers})
target_compile_definitions(headers_of_this_machine INTERFACE FMT_HEADER_ONLY)
add_library(fmt::fmt ALIAS headers_of_this_machine)
add_library(nlohmann_json::nlohmann_json ALIAS headers_of_this_machine)

set(TAUT_YAML_SOURCE "" CACHE PATH "Source of yaml-cpp, as Debian has it")
file(GLOB yaml_sources ${TAUT_YAML_SOURCE}/src/*.cpp)
if(NOT yaml_sources)
  message(FATAL_ERROR "TAUT_YAML_SOURCE has no source of yaml-cpp; script/wasm sees to that")
endif()
add_library(yaml-cpp STATIC ${yaml_sources})
target_include_directories(yaml-cpp SYSTEM PUBLIC ${TAUT_YAML_SOURCE}/include)
target_compile_definitions(yaml-cpp PUBLIC YAML_CPP_STATIC_DEFINE)
target_compile_options(yaml-cpp PRIVATE -w -fexceptions)

# What a page has to load is to be small. emscripten takes -Oz to mean that LLVM is to inline nothing,
# by which what templates and small members are compiled to grows up to threefold.
set(CMAKE_CXX_FLAGS_RELEASE "-Oz -flto -sINLINING_LIMIT=0 -DNDEBUG -fno-exceptions")
set(CMAKE_POSITION_INDEPENDENT_CODE OFF)

# Exceptions make what a page loads a third larger. They are thrown and caught in two files and the YAML
# library, which have them (src/description/CMakeLists.txt); whatever else would throw ends the program.
add_link_options(-fexceptions -flto -Oz)
