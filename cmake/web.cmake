# The viewer's pages, beside the command in <build>/web. Without node and npm there are none; all
# else is built all the same.
find_program(TAUT_NODE node DOC "Builds the viewer's pages")
find_program(TAUT_NPM npm DOC "Builds the viewer's pages")
if(TAUT_NODE AND TAUT_NPM)
  file(GLOB_RECURSE web_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/web/src/*)
  foreach(name IN ITEMS index.html package.json package-lock.json tsconfig.json vite.config.ts)
    list(APPEND web_sources ${PROJECT_SOURCE_DIR}/web/${name})
  endforeach()
  add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/web/index.html
    COMMAND ${PROJECT_SOURCE_DIR}/script/web ${PROJECT_BINARY_DIR}/web
    DEPENDS ${web_sources} ${PROJECT_SOURCE_DIR}/script/web
    COMMENT "Building the viewer's pages" VERBATIM)
  add_custom_target(taut_web ALL DEPENDS ${PROJECT_BINARY_DIR}/web/index.html)
else()
  message(STATUS "The viewer's pages are not built: that takes node and npm (apt-get install nodejs npm)")
endif()
