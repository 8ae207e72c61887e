# The player of runs: a page that travels inside the program. It draws by three.js, which esbuild bundles with what lies
# in the folder `page`; npm fetches both into the build folder, once. Where it cannot, the program does without.
option(TENDRIL_PLAYER "Build the player of `tendril run --player` (needs npm, and what its lock file names)" ON)
set(page_folder ${CMAKE_CURRENT_LIST_DIR}/page)
set(page_packages ${CMAKE_CURRENT_BINARY_DIR}/player)
set(page_lock ${page_folder}/package-lock.json)
set(has_player OFF)
if(TENDRIL_PLAYER)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${page_lock})
  find_program(TENDRIL_NODE NAMES node nodejs)
  execute_process(COMMAND bash ${PROJECT_SOURCE_DIR}/.cmake/npm.sh ${page_folder} ${page_packages})
  execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${page_lock} ${page_packages}/fetched.json
    RESULT_VARIABLE differs OUTPUT_QUIET ERROR_QUIET)
  if(TENDRIL_NODE AND differs EQUAL 0)
    set(has_player ON)
  else()
    message(STATUS "the player needs node, npm and what it fetches: `tendril run --player` is left out")
  endif()
endif()

set_property(GLOBAL PROPERTY TENDRIL_HAS_PLAYER ${has_player})
set(TENDRIL_HAS_PLAYER ${has_player} CACHE INTERNAL "Whether the program has it: for scripts")
if(has_player)
  file(GLOB page_parts CONFIGURE_DEPENDS ${page_folder}/*.js ${page_folder}/*.css ${page_folder}/*.html)
  add_custom_command(OUTPUT page_text.cpp
    COMMAND ${TENDRIL_NODE} ${page_folder}/bundle.mjs ${page_packages}/node_modules ${CMAKE_CURRENT_BINARY_DIR}/page_text.cpp
    DEPENDS ${page_parts} ${page_folder}/bundle.mjs ${page_packages}/fetched.json
    COMMENT "Bundling the player's page" VERBATIM)
  target_sources(tendril_runner PRIVATE player/pack.cpp player/page.cpp ${CMAKE_CURRENT_BINARY_DIR}/page_text.cpp)
else()
  target_sources(tendril_runner PRIVATE absent/player.cpp)
endif()
