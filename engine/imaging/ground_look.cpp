#include "engine/imaging/ground_look.h"

#include <map>
#include <string>

namespace vinerow::imaging {

GroundLook look_of(const Soil& soil) {
  // Wet soil reflects about half as much as dry soil; gravel and asphalt have almost no grass.
  static const std::map<std::string, GroundLook> kLooks = {
      {"wet_grass", {{0.60f, 0.58f, 0.56f}, 0.0f, 0.80f, -0.45f}},
      {"dry_soil", {{1.05f, 1.02f, 1.00f}, 0.60f, 1.0f, 0.20f}},
      {"wet_soil", {{0.42f, 0.37f, 0.33f}, 0.60f, 0.75f, -0.30f}},
      {"tilled_soil", {{0.82f, 0.78f, 0.75f}, 0.95f, 1.0f, 0.0f}},
      {"gravel", {{1.15f, 1.28f, 1.45f}, 0.95f, 1.0f, 0.10f}},
      {"asphalt", {{0.42f, 0.56f, 0.80f}, 1.0f, 1.0f, 0.0f}},
  };
  const auto found = kLooks.find(soil.name);
  return found == kLooks.end() ? GroundLook{} : found->second;
}

}  // namespace vinerow::imaging
