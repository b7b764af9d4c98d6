#include "tools/report/units.h"

#include <algorithm>
#include <array>
#include <utility>

namespace vinerow::tools::report {
namespace {

/// Name endings and units. A longer ending comes before the endings that it ends with.
constexpr auto kUnits = std::to_array<std::pair<const char*, const char*>>({{"_ml_per_m2", "ml/m²"},
                                                                            {"_per_m", "1/m"},
                                                                            {"_mps2", "m/s²"},
                                                                            {"_radps", "rad/s"},
                                                                            {"_mps", "m/s"},
                                                                            {"_rad", "rad"},
                                                                            {"_deg", "°"},
                                                                            {"_hours", "h"},
                                                                            {"_m2", "m²"},
                                                                            {"_m3", "m³"},
                                                                            {"_mm", "mm"},
                                                                            {"_cm", "cm"},
                                                                            {"_ha", "ha"},
                                                                            {"_MB", "MB"},
                                                                            {"_Nm", "N·m"},
                                                                            {"_Hz", "Hz"},
                                                                            {"_kg", "kg"},
                                                                            {"_ms", "ms"},
                                                                            {"_us", "µs"},
                                                                            {"_Wh", "Wh"},
                                                                            {"_J", "J"},
                                                                            {"_W", "W"},
                                                                            {"_N", "N"},
                                                                            {"_L", "L"},
                                                                            {"_m", "m"},
                                                                            {"_s", "s"}});

/// Entry whose ending the name has, or null.
const std::pair<const char*, const char*>* ending_of(const std::string& name) {
  const auto found = std::find_if(kUnits.begin(), kUnits.end(),
                                  [&](const auto& unit) { return name.ends_with(unit.first); });
  return found == kUnits.end() ? nullptr : &*found;
}

}  // namespace

std::string unit_of(const std::string& name) {
  // Here the unit precedes the quantity.
  if (name.find("litres_") != std::string::npos) return name.ends_with("_per_ha") ? "l/ha" : "l";
  const auto* ending = ending_of(name);
  return ending ? ending->second : "";
}

std::string words_of(const std::string& name) {
  const auto* ending = ending_of(name);
  std::string words =
      ending ? name.substr(0, name.size() - std::string(ending->first).size()) : name;
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string sentence_case(std::string words) {
  // A name with an underscore, such as build_map, keeps its spelling.
  const std::string first = words.substr(0, words.find_first_of(" :"));
  if (first.find('_') != std::string::npos) return words;
  if (!words.empty() && words[0] >= 'a' && words[0] <= 'z') words[0] -= 'a' - 'A';
  return words;
}

}  // namespace vinerow::tools::report
