# One way of using tendril from outside, from an empty folder to a program that ran:
#   cmake -DCONFIG=<file> -DCASE=<installed|subdirectory|core_only|refused> [-DCOMPONENTS=... -DEXPECTED=...]
#         -DWORK=<folder> -DPREFIX=<folder> -P consumer.cmake
# CONFIG sets SOURCE and BUILD (the tree and its build), NINJA, and COMMON (compiler, flags, build type).
cmake_minimum_required(VERSION 3.25)
include(${CONFIG})
set(here ${CMAKE_CURRENT_LIST_DIR})
set(ENV{CCACHE_NOHASHDIR} 1)  # each case compiles the same sources; its folder must not tell them apart
file(REMOVE_RECURSE ${WORK})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(NOT code EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\nfailed with ${code}:\n${text}")
  endif()
endfunction()

function(configure_and_build source)
  run(${CMAKE_COMMAND} -S ${source} -B ${WORK}/build -G Ninja ${COMMON} ${ARGN})
  run(${CMAKE_COMMAND} --build ${WORK}/build)
endfunction()

# The consumers of the named components run, find the library and say so.
function(run_consumers)
  foreach(component IN LISTS ARGN)
    execute_process(COMMAND ${WORK}/build/${component}_consumer RESULT_VARIABLE code OUTPUT_VARIABLE text)
    if(NOT code EQUAL 0 OR NOT text STREQUAL "${component} works\n")
      message(FATAL_ERROR "${component}_consumer returned ${code} and printed '${text}'")
    endif()
  endforeach()
endfunction()

# No file that entered the compilation belongs to CGAL or Boost. Eigen does: the listing is not empty.
function(check_dependencies)
  execute_process(COMMAND ${NINJA} -C ${WORK}/build -t deps OUTPUT_VARIABLE files RESULT_VARIABLE code)
  if(NOT code EQUAL 0 OR NOT files MATCHES "/Eigen/")
    message(FATAL_ERROR "the dependencies of the build cannot be read: ${files}")
  endif()
  if(files MATCHES "[^\n]*(/CGAL/|/boost/)[^\n]*")
    message(FATAL_ERROR "core was compiled with ${CMAKE_MATCH_0}")
  endif()
endfunction()

if(CASE STREQUAL "installed")
  run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix --component core)
  if(COMPONENTS STREQUAL "axis")
    run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix --component bind)
  endif()
  if(NOT COMPONENTS STREQUAL "core")
    run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix --component ${COMPONENTS})
  endif()
  configure_and_build(${here}/installed -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCOMPONENTS=${COMPONENTS})
  run_consumers(${COMPONENTS})
elseif(CASE STREQUAL "subdirectory")
  configure_and_build(${here}/subdirectory -DTENDRIL_SOURCE=${SOURCE} -DTENDRIL_BIND=OFF)
  run_consumers(core)
elseif(CASE STREQUAL "core_only")
  file(REMOVE_RECURSE ${PREFIX})
  configure_and_build(${SOURCE} -DTENDRIL_BIND=OFF -DTENDRIL_TESTS=OFF -DTENDRIL_EXAMPLES=OFF
    -DCMAKE_DISABLE_FIND_PACKAGE_CGAL=ON -DCMAKE_DISABLE_FIND_PACKAGE_Boost=ON)
  check_dependencies()
  run(${CMAKE_COMMAND} --install ${WORK}/build --prefix ${PREFIX} --component core)
  file(REMOVE_RECURSE ${WORK})
  configure_and_build(${here}/installed -DCMAKE_PREFIX_PATH=${PREFIX} -DCOMPONENTS=core
    -DCMAKE_DISABLE_FIND_PACKAGE_CGAL=ON -DCMAKE_DISABLE_FIND_PACKAGE_Boost=ON)
  check_dependencies()
  run_consumers(core)
elseif(CASE STREQUAL "refused")
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${here}/installed -B ${WORK}/build -G Ninja ${COMMON}
      -DCMAKE_PREFIX_PATH=${PREFIX} -DCOMPONENTS=${COMPONENTS}
    RESULT_VARIABLE code OUTPUT_VARIABLE text ERROR_VARIABLE text)
  string(REGEX REPLACE "[ \n]+" " " text "${text}")
  string(FIND "${text}" "${EXPECTED}" at)
  if(code EQUAL 0 OR at EQUAL -1)
    message(FATAL_ERROR "COMPONENTS ${COMPONENTS} should be refused with '${EXPECTED}', got ${code}: ${text}")
  endif()
else()
  message(FATAL_ERROR "no case '${CASE}'")
endif()
