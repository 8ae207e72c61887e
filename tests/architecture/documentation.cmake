# Fails when doxygen finds a name in the public headers of FOLDERS without documentation, or a \param that is none, and
# when a header or source of ROOT cites a key that BIBLIOGRAPHY lacks. CONFIG sets DOXYGEN, FOLDERS, ROOT, BIBLIOGRAPHY.
cmake_minimum_required(VERSION 3.25)
include(${CONFIG})
if(EXTRA_FOLDER)
  list(APPEND FOLDERS ${EXTRA_FOLDER})
endif()
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})

list(TRANSFORM FOLDERS REPLACE "(.+)" "\"\\1\"" OUTPUT_VARIABLE quoted)
list(JOIN quoted " " input)
file(READ ${CMAKE_CURRENT_LIST_DIR}/Doxyfile doxyfile)
file(WRITE ${WORK}/Doxyfile "${doxyfile}
INPUT = ${input}
OUTPUT_DIRECTORY = \"${WORK}/out\"
WARN_LOGFILE = \"${WORK}/warnings.txt\"
")
execute_process(COMMAND ${DOXYGEN} ${WORK}/Doxyfile RESULT_VARIABLE result ERROR_VARIABLE errors)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "doxygen: ${errors}")
endif()
file(GLOB documented ${WORK}/out/xml/*8h.xml)
list(LENGTH documented headers)
if(headers LESS 10)
  message(FATAL_ERROR "doxygen read ${headers} headers only: ${FOLDERS}")
endif()
file(READ ${WORK}/warnings.txt warnings)
# Explicit instantiations have the documentation of their templates.
string(REGEX REPLACE "[^\n]*: warning: Member [A-Za-z_]+< [^\n]*\n" "" warnings "${warnings}")
# Headers that are being rewritten, and documented with it.
foreach(pending force forces simulation system)
  string(REGEX REPLACE "[^\n]*/tendril/dynamics/${pending}\\.h:[0-9]+: warning: (Member|Compound)[^\n]*\n" "" warnings "${warnings}")
  string(REGEX REPLACE "[^\n]*/tendril/dynamics/${pending}\\.h:[0-9]+: warning: The following[^\n]*\n(  parameter[^\n]*\n)*" ""
    warnings "${warnings}")
endforeach()

set(unknown "")
file(READ ${BIBLIOGRAPHY} bibliography)
string(REPLACE "[" "<" bibliography "${bibliography}")
string(REPLACE "]" ">" bibliography "${bibliography}")
file(GLOB_RECURSE sources ${ROOT}/lib/*.h ${ROOT}/lib/*.cpp ${ROOT}/bind/*.h ${ROOT}/bind/*.cpp ${ROOT}/collision/*.h
  ${ROOT}/collision/*.cpp)
if(EXTRA_FOLDER)
  file(GLOB more ${EXTRA_FOLDER}/*.h)
  list(APPEND sources ${more})
endif()
foreach(source IN LISTS sources)
  file(READ ${source} text)
  string(REPLACE "[" "<" text "${text}")
  string(REPLACE "]" ">" text "${text}")
  string(REPLACE ";" "," text "${text}")
  string(REGEX REPLACE "\n *///? *" " " text "${text}")
  string(REGEX MATCHALL "<[A-Za-z][A-Za-z. -]* (19|20)[0-9][0-9]>" keys "${text}")
  foreach(key IN LISTS keys)
    string(FIND "${bibliography}" "**${key}**" place)
    if(place EQUAL -1)
      string(APPEND unknown "${source}: cites ${key}, which is not in the bibliography\n")
    endif()
  endforeach()
endforeach()

if(warnings OR unknown)
  message("${warnings}${unknown}")
  message(FATAL_ERROR "the names above lack documentation, or the keys an entry")
endif()
message("${headers} public headers documented")
