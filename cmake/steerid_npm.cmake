# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

# steerid_npm_packages(FOLDER FROM STAMP WHAT): the npm packages of FROM/package-lock.json in a copy in FOLDER, so that
# node_modules never stands in the source tree. STAMP names the variable with the file to depend on; WHAT stands in the
# build's message.
function(steerid_npm_packages FOLDER FROM STAMP WHAT)
  set(packages ${FOLDER}/node_modules/.package-lock.json)
  # The commands run in this folder, so it has to be there first.
  file(MAKE_DIRECTORY ${FOLDER})
  add_custom_command(OUTPUT ${packages}
    COMMAND ${CMAKE_COMMAND} -E copy ${FROM}/package.json ${FROM}/package-lock.json ${FOLDER}
    COMMAND ${STEERID_NPM} ci --ignore-scripts --prefer-offline --no-audit --no-fund --loglevel=error
    COMMAND ${CMAKE_COMMAND} -E touch ${packages}
    DEPENDS ${FROM}/package.json ${FROM}/package-lock.json
    WORKING_DIRECTORY ${FOLDER}
    COMMENT "Fetching ${WHAT}'s packages (npm ci)" VERBATIM)
  set(${STAMP} ${packages} PARENT_SCOPE)
endfunction()
