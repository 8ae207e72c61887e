# One interface target with the warnings every own translation unit is built with.
add_library(tendril_warnings INTERFACE)
target_compile_options(tendril_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wold-style-cast -Wnon-virtual-dtor
  -Wdouble-promotion
  # GCC 12 sees overlapping copies inside std::string's operator+ (GCC bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  # No contraction: the same source gives the same bits whichever vector unit the compiler may assume.
  # The loops of the dynamics ask for it themselves.
  -ffp-contract=off)
if(TENDRIL_WERROR)
  target_compile_options(tendril_warnings INTERFACE -Werror)
endif()
