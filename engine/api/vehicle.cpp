#include "engine/api/vehicle.h"

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/core/suggest.h"

namespace vinerow {

double VehicleDescription::number(const std::string& name, const std::string& who) const {
  const auto found = numbers.find(name);
  if (found != numbers.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [key, value] : numbers) known.push_back(key);
  throw ConfigError(
      fmt::format("{} needs '{}', which vehicle type '{}' does not tell (it tells: {})", who, name,
                  type, join(known)));
}

int VehicleDescription::actuator_index(const std::string& name, const std::string& who) const {
  std::vector<std::string> known;
  for (std::size_t i = 0; i < actuators.size(); ++i) {
    if (actuators[i].name == name) return static_cast<int>(i);
    known.push_back(actuators[i].name);
  }
  throw ConfigError(
      fmt::format("{} drives actuator '{}', which vehicle type '{}' does not have{} (it has: {})",
                  who, name, type, did_you_mean(name, known), join(known)));
}

std::vector<Eigen::Vector2d> VehicleDescription::outline_B() const {
  if (!footprint_B.empty()) return footprint_B;
  const Eigen::Vector2d c = collision_centre_B.head<2>(), h = collision_half_extents_m.head<2>();
  return {{c.x() - h.x(), c.y() - h.y()},
          {c.x() + h.x(), c.y() - h.y()},
          {c.x() + h.x(), c.y() + h.y()},
          {c.x() - h.x(), c.y() + h.y()}};
}

}  // namespace vinerow
