#include <gtest/gtest.h>
#include <tendril/base/version.h>

#include <string>

namespace tendril {
namespace {

TEST(Version, OfTheLibraryIsThatOfTheProject) {
  EXPECT_STREQ(version(), TENDRIL_PROJECT_VERSION);
}

TEST(Version, OfTheHeadersIsThatOfTheProject) {
  EXPECT_EQ(std::to_string(TENDRIL_VERSION_MAJOR) + '.' + std::to_string(TENDRIL_VERSION_MINOR) + '.' +
                std::to_string(TENDRIL_VERSION_PATCH),
            TENDRIL_PROJECT_VERSION);
}

}  // namespace
}  // namespace tendril
