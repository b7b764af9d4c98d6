#include "worlds/parts/soil_types.h"

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/core/suggest.h"

namespace vinerow::worlds {
namespace {

/// name, peak friction, sliding friction, slip stiffness, cornering stiffness (1/rad), rolling
/// resistance.
///
/// Peak and rolling figures are the middle of the ranges that terramechanics texts give for
/// agricultural tyres (Wong, "Theory of Ground Vehicles", 4th ed., table 1.1 for peak and sliding
/// friction of roads, grass and earth; ASABE EP496/D497 for rolling resistance of firm, tilled and
/// soft ground). The stiffness of an agricultural tyre falls with the ground's firmness; the values
/// keep the peak between 7 % and 20 % slip, where field tests find it.
const std::vector<Soil>& soils() {
  static const std::vector<Soil> kSoils = {
      {"dry_grass", 0.75, 0.65, 15.0, 10.0, 0.06}, {"wet_grass", 0.45, 0.35, 12.0, 8.0, 0.07},
      {"dry_soil", 0.68, 0.65, 12.0, 8.0, 0.07},   {"wet_soil", 0.50, 0.40, 9.0, 6.0, 0.11},
      {"tilled_soil", 0.55, 0.50, 8.0, 5.0, 0.12}, {"gravel", 0.60, 0.55, 14.0, 9.0, 0.04},
      {"asphalt", 0.85, 0.75, 22.0, 15.0, 0.015},
  };
  return kSoils;
}

}  // namespace

std::vector<std::string> soil_names() {
  std::vector<std::string> names;
  for (const Soil& soil : soils()) names.push_back(soil.name);
  return names;
}

Soil find_soil(const std::string& name) {
  for (const Soil& soil : soils()) {
    if (soil.name == name) return soil;
  }
  const std::vector<std::string> known = soil_names();
  throw ConfigError(fmt::format("soil = '{}', must be one of: {}{}", name, join(known),
                                did_you_mean(name, known)));
}

}  // namespace vinerow::worlds
