#pragma once

#include <string>
#include <vector>

namespace tendril::runner {

/// What a scene can be made of. Values are midway in the range that the source gives.
struct NamedMaterial {
  const char* name;
  double young;    ///< [Pa]
  double poisson;  ///< Poisson's ratio
  double density;  ///< [kg/m^3]
  double loss;     ///< loss coefficient: a free swing loses 2 pi times it of its energy each period
  const char* what;
  const char* source;
};

/// All of them.
const std::vector<NamedMaterial>& materials();

/// The one of that name; InvalidInput naming --material.
const NamedMaterial& find_material(const std::string& name);

}  // namespace tendril::runner
