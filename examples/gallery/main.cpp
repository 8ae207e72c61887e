// The experiments of [Chan 2008] as a page: runs them, prints the table, writes index.html and
// gallery.json.   tendril_gallery [--out DIR] [--only FIGURE]
#include <tendril/base/error.h>
#include <tendril/base/file.h>

#include <cstdio>
#include <cstring>
#include <filesystem>

#include "page/figure.h"

namespace tendril::gallery {
namespace {

struct Wish {
  std::string folder, only;
};

bool read(int count, char** arguments, Wish& wish) {
  for (int i = 1; i < count; i += 2) {
    if (i + 1 == count) return false;
    if (std::strcmp(arguments[i], "--out") == 0)
      wish.folder = arguments[i + 1];
    else if (std::strcmp(arguments[i], "--only") == 0)
      wish.only = arguments[i + 1];
    else
      return false;
  }
  return true;
}

/// Prints what a figure came to; false where a number is out of its bounds.
bool print(const Figure& figure) {
  bool holds = true;
  for (const Claim& claim : figure.claims)
    std::printf("%-5s %-7s %s\n", figure.id.c_str(), to_string(claim.verdict), claim.measured.c_str());
  for (const Number& number : figure.numbers) {
    if (number.holds()) continue;
    std::printf("%-5s OUT OF BOUNDS: %s is %.6g\n", figure.id.c_str(), number.name.c_str(), number.value);
    holds = false;
  }
  std::fflush(stdout);
  return holds;
}

int make(const Wish& wish) {
  std::vector<Figure> figures;
  bool holds = true;
  for (const Entry& entry : entries()) {
    if (!wish.only.empty() && wish.only != entry.id) continue;
    std::fprintf(stderr, "%s ...\n", entry.id);
    figures.push_back(entry.run());
    holds = print(figures.back()) && holds;
  }
  if (figures.empty()) throw InvalidInput("--only", wish.only, "the number of a figure, as 4.1");
  if (!wish.folder.empty()) {
    std::filesystem::create_directories(wish.folder);
    write_file_whole(wish.folder + "/gallery.json", to_json(figures));
    write_file_whole(wish.folder + "/index.html", to_html(figures));
    std::printf("%s/index.html\n", wish.folder.c_str());
  }
  return holds ? 0 : 1;
}

}  // namespace
}  // namespace tendril::gallery

int main(int count, char** arguments) try {
  tendril::gallery::Wish wish;
  if (!tendril::gallery::read(count, arguments, wish))
    return std::fputs("usage: tendril_gallery [--out DIR] [--only FIGURE]\n", stderr), 2;
  return tendril::gallery::make(wish);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
