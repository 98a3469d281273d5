# The dashboard, built by npm and embedded as assets.cpp; without npm, a page that says how to.
option(KW_UI "Build the dashboard (needs npm)" ON)
set(WEB_SOURCE ${CMAKE_CURRENT_LIST_DIR})
set(WEB ${CMAKE_CURRENT_BINARY_DIR}/web)
set(WEB_ASSETS ${WEB}/assets.cpp)
file(MAKE_DIRECTORY ${WEB})

if(KW_UI)
  find_program(NPM npm)
  find_program(NODE node)
  if(NOT NPM OR NOT NODE)
    message(FATAL_ERROR "The dashboard needs npm: deploy/install-deps build, or -DKW_UI=OFF")
  endif()
  # Several build trees may use one source tree at once, so npm works in the build tree's copy.
  set(copied package.json package-lock.json tsconfig.json build.mjs index.html icon.svg style.css)
  list(TRANSFORM copied PREPEND ${WEB_SOURCE}/ OUTPUT_VARIABLE sources)
  set(files index.html icon.svg app.js style.css)
  list(TRANSFORM files PREPEND ${WEB}/dist/ OUTPUT_VARIABLE page)
  add_custom_command(
    OUTPUT ${WEB}/installed
    COMMAND ${CMAKE_COMMAND} -E copy_if_different
            ${WEB_SOURCE}/package.json ${WEB_SOURCE}/package-lock.json ${WEB}
    COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
    COMMAND ${CMAKE_COMMAND} -E touch ${WEB}/installed
    DEPENDS ${WEB_SOURCE}/package.json ${WEB_SOURCE}/package-lock.json
    WORKING_DIRECTORY ${WEB}
    COMMENT "Installing what builds the dashboard")
  add_custom_command(
    OUTPUT ${page}
    COMMAND ${CMAKE_COMMAND} -E copy_if_different ${sources} ${WEB}
    COMMAND ${CMAKE_COMMAND} -E create_symlink ${WEB_SOURCE}/src ${WEB}/src
    COMMAND ${NODE} node_modules/typescript/bin/tsc
    COMMAND ${NODE} build.mjs dist dist.d ${WEB}/dist/index.html
    DEPENDS ${WEB}/installed ${sources}
    DEPFILE ${WEB}/dist.d
    WORKING_DIRECTORY ${WEB}
    COMMENT "Building the dashboard")
else()
  set(page ${WEB_SOURCE}/without_ui.txt)
endif()

# The first file is what "/" answers.
add_custom_command(
  OUTPUT ${WEB_ASSETS}
  COMMAND Python3::Interpreter ${WEB_SOURCE}/embed.py ${WEB_ASSETS} ${page}
  DEPENDS ${WEB_SOURCE}/embed.py ${page}
  COMMENT "Embedding the dashboard")
