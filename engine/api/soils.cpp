#include "engine/api/soils.h"

#include <fmt/format.h>

#include <array>

#include "engine/core/error.h"
#include "engine/core/suggest.h"

namespace vinerow {
namespace {

// name, peak and sliding friction, slip stiffness, cornering stiffness per rad, rolling resistance.
const std::array<Soil, 8> kSoils = {{
    {"concrete", 0.85, 0.75, 20.0, 13.0, 0.012},
    {"gravel", 0.60, 0.55, 13.0, 8.7, 0.030},
    {"dry_soil", 0.68, 0.65, 13.6, 9.0, 0.050},
    {"wet_soil", 0.55, 0.45, 8.3, 5.5, 0.090},
    {"tilled_soil", 0.50, 0.45, 5.0, 3.3, 0.120},
    {"dry_grass", 0.75, 0.65, 15.0, 10.0, 0.060},
    {"wet_grass", 0.40, 0.32, 8.0, 5.3, 0.075},
    {"sand", 0.45, 0.42, 4.0, 2.7, 0.200},
}};

}  // namespace

std::span<const Soil> built_in_soils() {
  return kSoils;
}

std::vector<std::string> soil_names() {
  std::vector<std::string> names;
  for (const Soil& soil : kSoils) names.push_back(soil.name);
  return names;
}

const Soil& soil_by_name(const std::string& name) {
  for (const Soil& soil : kSoils) {
    if (soil.name == name) return soil;
  }
  const std::vector<std::string> known = soil_names();
  throw ConfigError(
      fmt::format("unknown soil '{}'{} (known: {})", name, did_you_mean(name, known), join(known)));
}

}  // namespace vinerow
