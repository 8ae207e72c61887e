#include <tendril/base/error.h>
#include <tendril/base/file.h>

#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>

#include "accuracy/case.h"
#ifdef TENDRIL_CONTACT
#include "accuracy/contact/cases.h"
#endif

namespace tendril::accuracy {
namespace {

/// All that this build has.
std::vector<Entry> book() {
  std::vector<Entry> all = entries();
#ifdef TENDRIL_CONTACT
  const std::vector<Entry>& more = contact::contact_entries();
  all.insert(all.end(), more.begin(), more.end());
#endif
  return all;
}

int print_book(const char* folder) {
  std::vector<Case> cases;
  bool holds = true;
  std::fputs(table_heading().c_str(), stdout);
  for (const Entry& entry : book()) {
    cases.push_back(entry.run());
    std::fputs(to_table(cases.back()).c_str(), stdout);
    for (const std::string& note : cases.back().notes) std::printf("     %s\n", note.c_str());
    std::fflush(stdout);
    for (const Quantity& quantity : cases.back().quantities)
      for (const Verdict& verdict : judge(quantity)) holds = holds && verdict.holds;
  }
  if (folder) {
    std::filesystem::create_directories(folder);
    const std::string page = std::string(folder) + "/validation.html";
    write_file_whole(page, to_html(cases));
    std::printf("%s\n", page.c_str());
  }
  return holds ? 0 : 1;
}

}  // namespace
}  // namespace tendril::accuracy

/// Runs every case of the validation book and prints what each is held to; with --out also writes the page.
/// The exit code is 1 when something does not hold.
int main(int count, char** arguments) {
  const char* folder = nullptr;
  if (count == 3 && std::strcmp(arguments[1], "--out") == 0) folder = arguments[2];
  if (count != 1 && !folder) {
    std::fprintf(stderr, "usage: validation_book [--out DIR]\n");
    return 2;
  }
  try {
    return tendril::accuracy::print_book(folder);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
