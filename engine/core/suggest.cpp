#include "engine/core/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace vinerow {
namespace {

/// Units at the end of keys, and what users write instead.
constexpr std::array<std::string_view, 46> kUnits{
    "m",    "mm",  "cm",  "km",  "s",    "ms",   "ns",    "min", "h",  "rad", "deg", "mps",
    "mps2", "kmh", "kph", "mph", "kn",   "rpm",  "radps", "dps", "Hz", "kHz", "MHz", "N",
    "Nm",   "Pa",  "kPa", "bar", "kg",   "g",    "t",     "J",   "kJ", "Wh",  "W",   "kW",
    "V",    "A",   "Ah",  "dB",  "dBHz", "rtHz", "K",     "m2",  "m3", "ha"};

/// "speed" for "speed_mps", "speed_kmh" and "speed_m_s"; a name without a unit is unchanged.
std::string_view without_unit(std::string_view name) {
  while (true) {
    const std::size_t underscore = name.rfind('_');
    if (underscore == std::string_view::npos || underscore == 0) return name;
    const std::string_view last = name.substr(underscore + 1);
    if (std::find(kUnits.begin(), kUnits.end(), last) == kUnits.end()) return name;
    name = name.substr(0, underscore);
  }
}

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  // Optimal string alignment distance, three rows.
  std::vector<int> before_last(b.size() + 1), last(b.size() + 1), current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replace = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({last[j] + 1, current[j - 1] + 1, replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        current[j] = std::min(current[j], before_last[j - 2] + 1);
      }
    }
    std::swap(before_last, last);
    std::swap(last, current);
  }
  return last[b.size()];
}

std::string nearest_name(std::string_view wrong, std::span<const std::string> known) {
  std::string nearest;
  int best = -1;
  // Prefer the same quantity in another unit, or without one, however long the unit is.
  for (const std::string& name : known) {
    if (without_unit(wrong) != without_unit(name)) continue;
    const int distance = edit_distance(wrong, name);
    if (best < 0 || distance < best) {
      best = distance;
      nearest = name;
    }
  }
  if (best >= 0) return nearest;
  for (const std::string& name : known) {
    const int distance = edit_distance(wrong, name);
    const int allowed = static_cast<int>(std::max(wrong.size(), name.size())) / 3 + 1;
    if (distance <= allowed && (best < 0 || distance < best)) {
      best = distance;
      nearest = name;
    }
  }
  return nearest;
}

std::string did_you_mean(std::string_view wrong, std::span<const std::string> known) {
  const std::string nearest = nearest_name(wrong, known);
  return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

std::string join(std::span<const std::string> names, std::string_view separator) {
  return fmt::format("{}", fmt::join(names.begin(), names.end(), separator));
}

}  // namespace vinerow
