#include "scene/read/force_reader.h"

#include "scene/json/names.h"
#include "scene/read/rod_reader.h"

#include <tendril/dynamics/forces.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace tendril::scene {
namespace {

/// What may stand beside the type of each force; the schema knows only all of them together.
const std::map<std::string, std::vector<std::string>>& keys_of_types() {
  static const std::map<std::string, std::vector<std::string>> keys{
      {"gravity", {"acceleration"}},
      {"wind",
       {"mean", "gust", "gust_frequency", "waves", "seed", "air_density", "normal_drag", "tangential_drag",
        "switched"}},
      {"force", {"curve_pair", "node", "direction", "signal"}},
      {"torque", {"curve_pair", "node", "direction", "signal"}},
      {"pull", {"curve_pair", "node", "target", "stiffness"}},
  };
  return keys;
}

void refuse_other_keys(const JsonNode& force, const std::string& type) {
  const auto& allowed = keys_of_types().at(type);
  for (const auto& item : force.value().items()) {
    if (item.key() == "type" || std::find(allowed.begin(), allowed.end(), item.key()) != allowed.end())
      continue;
    std::string list;
    for (const std::string& key : allowed) list += list.empty() ? key : ", " + key;
    force.at(item.key()).refuse("not a key of the force '" + type + "'", "one of: " + list);
  }
}

Signal read_signal(const JsonNode& signal) {
  if (signal.is_number()) return Signal::constant(signal.number());
  if (signal.has("sinusoid") == signal.has("table"))
    signal.refuse("sinusoid and table", "one of them, not both");
  if (signal.has("sinusoid")) {
    const JsonNode wave = signal.at("sinusoid");
    return Signal::sinusoid(wave.at("amplitude").number(), wave.at("frequency").not_negative(),
                            wave.number_or("phase", 0.0), wave.number_or("mean", 0.0));
  }
  const JsonNode table = signal.at("table");
  std::vector<std::pair<double, double>> entries;
  for (std::size_t i = 0; i < table.size(); ++i) {
    entries.emplace_back(table.at(i).at(0).number(), table.at(i).at(1).number());
  }
  return table.locate([&] { return Signal::table(entries); });
}

/// A default has a meaning in metres, kilograms and seconds alone.
void refuse_without_units(const JsonNode& force, const std::string& key, const std::string& otherwise) {
  force.refuse("'" + key + "' is not given, and its " + otherwise + " cannot be said in the scene's units",
               "'" + key + "', or units of length, mass and time by their usual words, such as mm, kg and s");
}

WindOptions read_wind(const JsonNode& force, const std::optional<Units>& units) {
  WindOptions wind;
  if (units) {
    wind.air_density *= std::pow(units->length, 3) / units->mass;
    wind.gust_frequency *= units->time;
  }
  wind.mean = force.at("mean").vec3();
  wind.gust = force.number_or("gust", wind.gust);
  wind.gust_frequency = force.number_or("gust_frequency", wind.gust_frequency);
  if (!units && !force.has("air_density")) refuse_without_units(force, "air_density", "1.2 kg/m^3");
  if (!units && wind.gust > 0.0 && !force.has("gust_frequency"))
    refuse_without_units(force, "gust_frequency", "1 Hz");
  if (force.has("waves")) wind.waves = static_cast<int>(force.at("waves").integer(1, 1000));
  if (force.has("seed")) wind.seed = static_cast<std::uint64_t>(force.at("seed").integer(0, 1L << 52));
  wind.air_density = force.number_or("air_density", wind.air_density);
  wind.normal_drag = force.number_or("normal_drag", wind.normal_drag);
  wind.tangential_drag = force.number_or("tangential_drag", wind.tangential_drag);
  if (force.has("switched")) wind.switched = read_signal(force.at("switched"));
  return wind;
}

}  // namespace

std::shared_ptr<const Force> read_force(const JsonNode& force, const std::vector<Rod>& rods,
                                        const std::vector<std::string>& names,
                                        const std::optional<Units>& units) {
  const std::string type = force.at("type").text();
  refuse_other_keys(force, type);
  return force.locate([&]() -> std::shared_ptr<const Force> {
    if (type == "gravity") return std::make_shared<Gravity>(force.at("acceleration").vec3());
    if (type == "wind") return std::make_shared<Wind>(read_wind(force, units));
    const std::size_t rod = read_name(force.at("curve_pair"), names);
    const std::size_t node = read_node(force.at("node"), rods[rod]);
    if (type == "pull") {
      return std::make_shared<PullTowards>(rod, node, force.at("target").vec3(),
                                           force.at("stiffness").positive());
    }
    const auto kind = type == "force" ? PointLoad::Kind::force : PointLoad::Kind::torque;
    return std::make_shared<PointLoad>(
        kind, rod, node, force.at("direction").vec3(),
        force.has("signal") ? read_signal(force.at("signal")) : Signal::constant(1.0));
  });
}

}  // namespace tendril::scene
