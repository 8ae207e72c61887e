#include <tendril/base/version.h>

#define TENDRIL_TEXT_OF(number) #number
#define TENDRIL_TEXT(number) TENDRIL_TEXT_OF(number)

namespace tendril {

const char* version() {
  return TENDRIL_TEXT(TENDRIL_VERSION_MAJOR) "." TENDRIL_TEXT(TENDRIL_VERSION_MINOR) "." TENDRIL_TEXT(
      TENDRIL_VERSION_PATCH);
}

}  // namespace tendril
