#include "obj_line.h"

namespace tendril::bind {
namespace {

constexpr std::string_view kPassed[] = {
    "o",     "g",   "s",        "mg",       "usemtl",     "usemap",    "mtllib", "maplib",
    "bevel", "lod", "c_interp", "d_interp", "shadow_obj", "trace_obj", "ctech",  "stech",
};
constexpr std::string_view kSkipped[] = {
    "p",    "l",    "vp",   "cstype", "deg",  "bmat", "step", "curv", "curv2",
    "surf", "parm", "trim", "hole",   "scrv", "sp",   "end",  "con",
};

}  // namespace

ObjKeyword obj_keyword(std::string_view word) {
  if (word == "v") return ObjKeyword::vertex;
  if (word == "f" || word == "fo") return ObjKeyword::face;  // the latter in files of before 1992
  if (word == "vn") return ObjKeyword::normal;
  if (word == "vt") return ObjKeyword::texture;
  const auto is_in = [word](const auto& list) {
    return std::find(std::begin(list), std::end(list), word) != std::end(list);
  };
  return is_in(kPassed) ? ObjKeyword::passed : is_in(kSkipped) ? ObjKeyword::skipped : ObjKeyword::unknown;
}

}  // namespace tendril::bind
