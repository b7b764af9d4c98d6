#include "engine/api/vehicle.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/core/suggest.h"

namespace vinerow {
namespace {

/// "wheels and two steered axles"
std::string say_kinds(const VehicleDescription& vehicle) {
  std::vector<std::string> kinds;
  if (vehicle.wheeled) kinds.emplace_back("wheels");
  if (vehicle.steered) kinds.emplace_back("two steered axles");
  if (vehicle.ackermann) kinds.emplace_back("a steered front axle");
  if (vehicle.rotorcraft) kinds.emplace_back("rotors");
  if (vehicle.fixed_wing) kinds.emplace_back("wings");
  if (kinds.empty()) return "neither wheels nor rotors nor wings";
  std::string text = kinds.front();
  for (std::size_t i = 1; i < kinds.size(); ++i) {
    text += (i + 1 == kinds.size() ? " and " : ", ") + kinds[i];
  }
  return text;
}

template <typename Kind>
const Kind& need_kind(const VehicleDescription& vehicle, const std::optional<Kind>& kind,
                      const char* what, const std::string& who) {
  if (kind) return *kind;
  throw ConfigError(fmt::format("{} needs a vehicle {}; vehicle type '{}' has {}", who, what,
                                vehicle.type, say_kinds(vehicle)));
}

}  // namespace

const WheeledVehicle& VehicleDescription::need_wheeled(const std::string& who) const {
  return need_kind(*this, wheeled, "with wheels", who);
}

const SteeredVehicle& VehicleDescription::need_steered(const std::string& who) const {
  return need_kind(*this, steered, "with two steered axles", who);
}

const AckermannVehicle& VehicleDescription::need_ackermann(const std::string& who) const {
  return need_kind(*this, ackermann, "with a steered front axle", who);
}

const Rotorcraft& VehicleDescription::need_rotorcraft(const std::string& who) const {
  return need_kind(*this, rotorcraft, "with rotors", who);
}

const FixedWingAircraft& VehicleDescription::need_fixed_wing(const std::string& who) const {
  return need_kind(*this, fixed_wing, "with wings", who);
}

double VehicleDescription::need(const std::optional<double>& value, const char* name,
                                const std::string& who) const {
  if (value) return *value;
  throw ConfigError(
      fmt::format("{} needs '{}', which vehicle type '{}' does not have", who, name, type));
}

double VehicleDescription::need_positive(double value, const char* name,
                                         const std::string& who) const {
  if (value > 0.0 && std::isfinite(value)) return value;
  throw ConfigError(
      fmt::format("{} needs '{}' > 0, but vehicle type '{}' has {:g}", who, name, type, value));
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
