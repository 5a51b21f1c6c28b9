# Libraries of a self-contained build (script/portable): static archives from Debian's sources, in the
# folder TAUT_SELF_CONTAINED that script/publishing/static_libraries.sh fills. The command is linked
# without any shared library, so it runs on any Linux; the Python module needs the C library only.
# Part of the archive, too: its tautConfig.cmake includes this file.
set(TAUT_USE_MPI OFF)  # MPI comes with the cluster

# static_library(TARGET ARCHIVE...): an imported target of archives in lib/
function(static_library target)
  if(TARGET ${target})
    return()
  endif()
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${target} SYSTEM INTERFACE ${TAUT_SELF_CONTAINED}/include)
  foreach(archive IN LISTS ARGN)
    set(path ${TAUT_SELF_CONTAINED}/lib/${archive})
    if(NOT EXISTS ${path})
      message(FATAL_ERROR "${path} is missing (script/portable builds it)")
    endif()
    target_link_libraries(${target} INTERFACE ${path})
  endforeach()
endfunction()
static_library(ZLIB::ZLIB libz.a)
static_library(PNG::PNG libpng16.a libz.a)
static_library(fmt::fmt libfmt.a)
static_library(yaml-cpp libyaml-cpp.a)
target_compile_definitions(yaml-cpp INTERFACE YAML_CPP_STATIC_DEFINE)
static_library(tinyxml2::tinyxml2 libtinyxml2.a)
set(QRCODEGEN_FOUND TRUE)
static_library(PkgConfig::QRCODEGEN libqrcodegencpp.a)
static_library(PkgConfig::HDF5 libhdf5.a libz.a)
target_link_libraries(PkgConfig::HDF5 INTERFACE ${CMAKE_DL_LIBS} m)
static_library(PkgConfig::NLOPT libnlopt.a)
target_link_libraries(PkgConfig::NLOPT INTERFACE m)
static_library(PkgConfig::SQLITE libsqlite3.a)
