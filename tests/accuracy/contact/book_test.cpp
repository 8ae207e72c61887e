#include "accuracy/contact/cases.h"
#include "accuracy/held.h"

namespace tendril::accuracy {
namespace {

class ContactBook : public testing::TestWithParam<Entry> {};

TEST_P(ContactBook, Holds) {
  expect_to_hold(GetParam().run());
}

#ifdef TENDRIL_LONG
const std::vector<Entry>& book() {
  return contact::long_contact_entries();
}
#else
const std::vector<Entry>& book() {
  return contact::contact_entries();
}
#endif

INSTANTIATE_TEST_SUITE_P(Validation, ContactBook, testing::ValuesIn(book()),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace tendril::accuracy
