#include "player/page.h"

#include <tendril/base/error.h>

namespace tendril::runner {

void require_player() {
  throw InvalidInput("--player", "this program was built without its player",
                     "a build that finds npm and can fetch what TENDRIL_PLAYER needs (on Debian: apt-get "
                     "install nodejs npm, then configure again)");
}

std::string player_page(const Film&, const Camera&, const std::string&, const std::string&) {
  require_player();
  return {};
}

}  // namespace tendril::runner
