# Overlay port of vcpkg: builds the source tree that contains it (docs/install.md). Not run yet.
get_filename_component(source "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
vcpkg_check_features(OUT_FEATURE_OPTIONS features FEATURES command TAUT_BUILD_APPS)
vcpkg_find_acquire_program(PKGCONFIG)
vcpkg_cmake_configure(SOURCE_PATH "${source}"
  OPTIONS ${features} "-DPKG_CONFIG_EXECUTABLE=${PKGCONFIG}" -DTAUT_BUILD_TESTS=OFF -DTAUT_BUILD_WEB=OFF
    -DTAUT_BUILD_PYTHON=OFF -DTAUT_WARNINGS_AS_ERRORS=OFF -DTAUT_USE_MPI=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME taut CONFIG_PATH lib/cmake/taut)
if("command" IN_LIST FEATURES)
  vcpkg_copy_tools(TOOL_NAMES taut AUTO_CLEAN)
endif()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${source}/LICENSE" "${source}/NOTICE")
