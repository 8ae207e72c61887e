# One interface target with the warnings every own translation unit is built with.
add_library(tendril_warnings INTERFACE)
target_compile_options(tendril_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wold-style-cast -Wnon-virtual-dtor
  -Wdouble-promotion
  # No contraction: the same source gives the same bits whichever vector unit the compiler may assume.
  -ffp-contract=off)
if(TENDRIL_WERROR)
  target_compile_options(tendril_warnings INTERFACE -Werror)
endif()
