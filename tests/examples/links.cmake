# A program that links neither Embree nor libpng, beside one that does (else the check could not fail):
#   cmake -DWITHOUT=<program> -DWITH=<program> -P links.cmake
cmake_minimum_required(VERSION 3.25)

function(linked program out)
  execute_process(COMMAND ldd ${program} RESULT_VARIABLE code OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "ldd ${program}: ${text}")
  endif()
  string(REGEX MATCHALL "lib(embree|png)[^ \n]*" found "${text}")
  set(${out} "${found}" PARENT_SCOPE)
endfunction()

linked(${WITH} found)
if(NOT found MATCHES "embree" OR NOT found MATCHES "png")
  message(FATAL_ERROR "${WITH} should link Embree and libpng, and links: ${found}")
endif()
linked(${WITHOUT} found)
if(found)
  message(FATAL_ERROR "${WITHOUT} links: ${found}")
endif()
