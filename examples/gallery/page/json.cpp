#include <nlohmann/json.hpp>

#include "figure.h"

namespace tendril::gallery {
namespace {

using Json = nlohmann::ordered_json;

Json of(const Number& number) {
  Json out{{"name", number.name}, {"value", number.value}};
  if (number.within) {
    out["at_least"] = number.within->low;
    out["at_most"] = number.within->high;
    out["holds"] = number.holds();
  }
  return out;
}

}  // namespace

std::string to_json(const std::vector<Figure>& figures) {
  Json out = Json::array();
  for (const Figure& figure : figures) {
    Json one{{"figure", figure.id}, {"title", figure.title}, {"claims", Json::array()}};
    for (const Claim& claim : figure.claims)
      one["claims"].push_back({{"claimed", claim.claimed},
                               {"measured", claim.measured},
                               {"verdict", to_string(claim.verdict)},
                               {"because", claim.because}});
    one["numbers"] = Json::array();
    for (const Number& number : figure.numbers) one["numbers"].push_back(of(number));
    one["left_out"] = figure.left_out;
    out.push_back(one);
  }
  return out.dump(1) + "\n";
}

}  // namespace tendril::gallery
