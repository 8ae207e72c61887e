# Fails unless the lines between the [readme] marks of EXAMPLE stand in README, without their indentation.
file(READ ${EXAMPLE} example)
file(READ ${README} readme)
string(REGEX MATCH "// \\[readme\\]\n(.*)  // \\[readme\\]" found "${example}")
string(REPLACE "\n  " "\n" lines "\n${CMAKE_MATCH_1}")
string(FIND "${readme}" "${lines}" place)
if(NOT found OR place EQUAL -1)
  message(FATAL_ERROR "README.md does not show the marked lines of ${EXAMPLE}:\n${lines}")
endif()
