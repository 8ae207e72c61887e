#pragma once

#include <tendril/dynamics/system.h>

#include <sstream>
#include <string>

namespace tendril {

/// What went wrong, as part of a sentence.
const char* describe(Evaluation::Outcome outcome);

/// The parts one after the other, numbers as in C.
template <typename... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  (out << ... << parts);
  return out.str();
}

}  // namespace tendril
