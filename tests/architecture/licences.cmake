# Which CGAL licences a program takes on by including every public header of lib and bind:
#   cmake -DCONFIG=<file> -DWORK=<folder> [-DEXTRA_HEADER=<name>] -P licences.cmake
# CONFIG sets COMPILER, FLAGS and HEADERS. The compiler lists the files reached; a CGAL file under the GPL alone is a
# failure, since whoever embeds the library would take it on. CGAL's own check (CGAL_LICENSE_ERROR) must agree.
cmake_minimum_required(VERSION 3.25)
include(${CONFIG})

set(source ${WORK}/all_public_headers.cpp)
set(text "")
foreach(header IN LISTS HEADERS EXTRA_HEADER)
  string(APPEND text "#include <${header}>\n")
endforeach()
file(WRITE ${source} "${text}")

execute_process(COMMAND ${COMPILER} ${FLAGS} -M ${source}
  OUTPUT_VARIABLE reached ERROR_VARIABLE errors RESULT_VARIABLE code)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "the public headers do not preprocess:\n${errors}")
endif()
string(REGEX MATCHALL "[^ \n\\]+" reached "${reached}")

set(licences "")
set(refused "")
foreach(file IN LISTS reached)
  if(NOT file MATCHES "/CGAL/")
    continue()
  endif()
  file(STRINGS ${file} tag REGEX "SPDX-License-Identifier" LIMIT_COUNT 1)
  string(REGEX REPLACE ".*SPDX-License-Identifier: *" "" licence "${tag}")
  if(licence STREQUAL "")
    set(licence "no SPDX tag")
  endif()
  string(MAKE_C_IDENTIFIER "${licence}" key)
  list(APPEND licences ${key})
  set(name_${key} "${licence}")
  list(APPEND files_${key} ${file})
  if(licence MATCHES "(^|[^L])GPL" AND NOT licence MATCHES "LGPL")
    list(APPEND refused ${file})
  endif()
endforeach()

list(REMOVE_DUPLICATES licences)
message(NOTICE "CGAL headers reached by the public headers, by licence:")
foreach(key IN LISTS licences)
  list(LENGTH files_${key} count)
  message(NOTICE "  ${count}  ${name_${key}}")
endforeach()
if(refused)
  list(JOIN refused "\n  " refused)
  message(FATAL_ERROR "GPL headers reached:\n  ${refused}")
endif()

execute_process(COMMAND ${COMPILER} ${FLAGS} -DCGAL_LICENSE_ERROR -fsyntax-only ${source}
  ERROR_VARIABLE errors RESULT_VARIABLE code)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "CGAL's own licence check refuses the public headers:\n${errors}")
endif()
