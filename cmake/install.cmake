# `cmake --install build/install --prefix ~/.local`: the command, the library for find_package(taut),
# the files of share/taut, documents, the page of the manual and completions.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# taut::taut is all of the library at once.
add_library(taut_library INTERFACE)
add_library(taut::taut ALIAS taut_library)
set_target_properties(taut_library PROPERTIES EXPORT_NAME taut)
get_property(layers GLOBAL PROPERTY TAUT_LAYERS)
list(TRANSFORM layers PREPEND taut_ OUTPUT_VARIABLE layer_targets)
target_link_libraries(taut_library INTERFACE ${layer_targets})
set_target_properties(taut_options PROPERTIES EXPORT_NAME options)

if(NOT TAUT_INSTALL)
  return()
endif()

set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/taut)
install(TARGETS taut_library taut_options ${layer_targets} EXPORT taut
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT taut NAMESPACE taut:: FILE tautTargets.cmake DESTINATION ${config_dir})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/taut DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.h")
if(TARGET taut)
  install(TARGETS taut RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  if(TARGET taut_words)
    set(words ${PROJECT_BINARY_DIR}/apps/cli/words)
    install(FILES ${words}/taut.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
    install(FILES ${words}/taut DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
    install(FILES ${words}/_taut DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
    install(FILES ${words}/taut.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
  endif()
  install(DIRECTORY ${PROJECT_BINARY_DIR}/web DESTINATION ${CMAKE_INSTALL_DATADIR}/taut OPTIONAL)
endif()
if(EXISTS ${PROJECT_SOURCE_DIR}/share) # not in the sources of a wheel
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/share/ DESTINATION ${CMAKE_INSTALL_DATADIR}/taut)
endif()

# `cmake --install build/install --component virtual_robot --prefix ~/.local`: the emulated boards and
# their firmware. Only when asked for by that name: the program contains libsimavr, so it is under the
# GPL, and no package of taut is to have it by the way.
set(alone COMPONENT virtual_robot EXCLUDE_FROM_ALL)
if(TARGET taut_virtual_robot)
  install(TARGETS taut_virtual_robot RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} ${alone})
  install(FILES LICENSE NOTICE DESTINATION ${CMAKE_INSTALL_DOCDIR} ${alone})
endif()
if(TARGET taut_firmware)
  get_target_property(elf taut_firmware TAUT_ELF)
  string(REGEX REPLACE "\\.elf$" ".hex" hex ${elf})
  install(FILES ${elf} ${hex} DESTINATION ${CMAKE_INSTALL_DATADIR}/taut/firmware ${alone})
endif()

# What is to be read, with the licence that goes with every copy.
install(FILES LICENSE NOTICE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs examples DESTINATION ${CMAKE_INSTALL_DOCDIR}
  PATTERN "__pycache__" EXCLUDE) # left by programs that were run here

include(cmake/pkg_config.cmake)
if(TAUT_SELF_CONTAINED)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/self_contained.cmake DESTINATION ${config_dir})
  install(DIRECTORY ${TAUT_SELF_CONTAINED}/lib/ DESTINATION ${CMAKE_INSTALL_LIBDIR} FILES_MATCHING PATTERN "*.a")
  set(static_libraries TRUE)
else()
  set(static_libraries FALSE)
endif()
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/tautConfig.cmake.in
  ${PROJECT_BINARY_DIR}/tautConfig.cmake INSTALL_DESTINATION ${config_dir}
  PATH_VARS CMAKE_INSTALL_DATADIR)
# Before 1.0, a minor version may break programs.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/tautConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/tautConfig.cmake ${PROJECT_BINARY_DIR}/tautConfigVersion.cmake
  DESTINATION ${config_dir})
