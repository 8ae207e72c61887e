# The example run_scene on a scene, held to the trajectory of the program's run of it:
#   cmake -DEXAMPLE=<program> -DPROGRAM=<program> -DSCENE=<file> -DWORK=<folder> -P run_scene.cmake
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${WORK})
execute_process(COMMAND ${EXAMPLE} ${SCENE} RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE error)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "the example returned ${code}: ${said}${error}")
endif()
execute_process(COMMAND ${PROGRAM} run ${SCENE} --out ${WORK} --no-pictures --no-frames
  RESULT_VARIABLE code ERROR_VARIABLE error OUTPUT_QUIET)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "the program returned ${code}: ${error}")
endif()

# The rod's end is node 10; both print numbers that read back to the same bits.
file(STRINGS ${WORK}/trajectory.csv rows REGEX "^[^,]*,0,10,")
set(expected "")
foreach(row IN LISTS rows)
  string(REGEX REPLACE "^([^,]*),0,10,([^,]*,[^,]*,[^,]*),.*" "rod at \\1: \\2\n" line "${row}")
  string(APPEND expected "${line}")
endforeach()
string(REGEX REPLACE "finished: [0-9]+ steps\n$" "" told "${said}")
list(LENGTH rows outputs)
if(NOT outputs EQUAL 11 OR told STREQUAL said OR NOT told STREQUAL expected)
  message(FATAL_ERROR "the example printed\n${said}where the program's ${outputs} outputs say\n${expected}")
endif()
