#include "controllers/autopilot/outputs/output_mixer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "controllers/parts/ground_drive/differential_drive.h"
#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/math/axle_roll.h"

namespace vinerow::controllers {
namespace {

/// A mixer whose actuators are those of the vehicle, in its order.
class VehicleMixer : public OutputMixer {
 public:
  VehicleMixer(const VehicleDescription& vehicle, std::vector<OutputFunction> functions)
      : functions_(std::move(functions)), actuators_(vehicle.actuators) {}

  const std::vector<OutputFunction>& functions() const final { return functions_; }
  NamedValues make_actuators() const final {
    NamedValues result;
    for (const ActuatorSpec& actuator : actuators_) result.names.push_back(actuator.name);
    result.values.assign(actuators_.size(), 0.0);
    return result;
  }

 protected:
  const std::vector<ActuatorSpec>& actuators() const { return actuators_; }

 private:
  std::vector<OutputFunction> functions_;
  std::vector<ActuatorSpec> actuators_;
};

/// Left and right wheels of a rover that steers by speed difference.
class SkidMixer final : public VehicleMixer {
 public:
  /// @param mixes  the autopilot gives throttle and steering: left = throttle + steering,
  ///               right = throttle - steering, scaled down together where one exceeds 1
  SkidMixer(const VehicleDescription& vehicle, bool mixes, const std::string& who)
      : VehicleMixer(vehicle, mixes ? std::vector<OutputFunction>{{"throttle"}, {"steering"}}
                                    : std::vector<OutputFunction>{{"left"}, {"right"}}),
        mixes_(mixes) {
    vehicle.need_wheeled(who);
    for (const ActuatorSpec& actuator : actuators()) {
      sides_.push_back(side_of_wheel(actuator.name));
      if (sides_.back() == 0.0) {
        throw ConfigError(fmt::format(
            "{}: the mixer '{}' drives left and right wheels; '{}' of vehicle type '{}' is neither",
            who, mixes ? "throttle_steering" : "skid", actuator.name, vehicle.type));
      }
    }
  }

  void mix(std::span<const double> values, NamedValues& to) const override {
    double left = values[0], right = values[1];
    if (mixes_) {
      const double throttle = values[0], steering = values[1];
      const double largest = std::max(1.0, std::abs(throttle) + std::abs(steering));
      left = (throttle + steering) / largest;
      right = (throttle - steering) / largest;
    }
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      to.values[i] = (sides_[i] < 0.0 ? left : right) * actuators()[i].max;
    }
  }

 private:
  bool mixes_;
  std::vector<double> sides_;
};

/// Steered axles by their own outputs, wheels by one throttle. The wheels turn about the point in
/// which the lines of the axles meet.
class SteeredMixer final : public VehicleMixer {
 public:
  SteeredMixer(const VehicleDescription& vehicle, bool steers_both_axles, const std::string& who)
      : VehicleMixer(vehicle, functions_for(steers_both_axles)) {
    const WheeledVehicle& wheels = vehicle.need_wheeled(who);
    if (steers_both_axles) {
      const SteeredVehicle& axles = vehicle.need_steered(who);
      front_m_ = axles.front_axle_m;
      rear_m_ = axles.rear_axle_m;
    } else {
      rear_m_ = vehicle.need_ackermann(who).rear_axle_m;
      front_m_ = wheels.wheel_base_m - rear_m_;
    }
    half_track_m_ = 0.5 * wheels.track_m;
    for (std::size_t i = 0; i < actuators().size(); ++i) {
      const std::string& name = actuators()[i].name;
      if (name == "axle_front_steer_rad") {
        front_actuator_ = static_cast<int>(i);
      } else if (name == "axle_rear_steer_rad") {
        rear_actuator_ = static_cast<int>(i);
      } else if (const double side = side_of_wheel(name); side != 0.0) {
        const bool is_front = name.find("_f") != std::string::npos;
        wheels_.push_back({static_cast<int>(i), is_front, side});
      } else {
        throw ConfigError(fmt::format("{}: its mixer does not know the actuator '{}'", who, name));
      }
    }
  }

  void mix(std::span<const double> values, NamedValues& to) const override {
    // Steering is positive to the right in an autopilot, to the left here.
    const bool steers_both = values.size() == 3;
    const double front = -values[0] * actuators()[front_actuator_].max;
    const double rear = steers_both ? -values[1] * actuators()[rear_actuator_].max : 0.0;
    to.values[front_actuator_] = front;
    if (steers_both) to.values[rear_actuator_] = rear;
    // With curvature k and drift s of the axles, the wheel at (x, y) moves with (1 - k y, s + k x)
    // per forward speed of B.
    const AxleRoll roll = calc_axle_roll(front_m_, rear_m_, {front, rear});
    const double throttle = values.back();
    double largest = 0.0;
    for (const Wheel& wheel : wheels_) largest = std::max(largest, rolling(wheel, roll));
    for (const Wheel& wheel : wheels_) {
      // The fastest wheel turns with the throttle's share of its limit.
      to.values[wheel.actuator] =
          throttle * actuators()[wheel.actuator].max * rolling(wheel, roll) / largest;
    }
  }

 private:
  struct Wheel {
    int actuator = 0;
    bool is_front = false;
    double side = 0.0;  ///< +1 right
  };

  static std::vector<OutputFunction> functions_for(bool steers_both_axles) {
    if (steers_both_axles) return {{"front_steering"}, {"rear_steering"}, {"throttle"}};
    return {{"steering"}, {"throttle"}};
  }
  double rolling(const Wheel& wheel, const AxleRoll& roll) const {
    const double x = wheel.is_front ? front_m_ : -rear_m_, y = -wheel.side * half_track_m_;
    const double k = roll.curvature_per_m;
    return std::hypot(1.0 - k * y, roll.drift + k * x);
  }

  double front_m_ = 0.5, rear_m_ = 0.5, half_track_m_ = 0.5;
  int front_actuator_ = 0, rear_actuator_ = 0;
  std::vector<Wheel> wheels_;
};

/// Four motors in an X, named by their places.
class QuadrotorMixer final : public VehicleMixer {
 public:
  QuadrotorMixer(const VehicleDescription& vehicle, const std::string& who)
      : VehicleMixer(vehicle, {{"motor_front_left", true},
                               {"motor_front_right", true},
                               {"motor_rear_left", true},
                               {"motor_rear_right", true}}) {
    const std::vector<RotorPlace>& rotors = vehicle.need_rotorcraft(who).rotors;
    std::array<int, 4> found{};
    for (std::size_t i = 0; i < rotors.size(); ++i) {
      const bool is_rear = rotors[i].p_B.x() < 0.0, is_right = rotors[i].p_B.y() < 0.0;
      const int place = 2 * is_rear + is_right;
      ++found[place];
      function_.push_back(place);
    }
    if (std::any_of(found.begin(), found.end(), [](int count) { return count != 1; }) ||
        actuators().size() != 4) {
      throw ConfigError(fmt::format(
          "{}: the mixer 'quadrotor_x' needs one rotor in each quarter; vehicle type '{}' has {} "
          "rotors",
          who, vehicle.type, rotors.size()));
    }
  }

  /// Speed goes with the output, thrust with its square.
  void mix(std::span<const double> values, NamedValues& to) const override {
    for (std::size_t i = 0; i < function_.size(); ++i) {
      to.values[i] = values[function_[i]] * actuators()[i].max;
    }
  }

 private:
  std::vector<int> function_;  ///< of each rotor
};

/// Aircraft with two elevons and a propeller. An autopilot's elevon is positive upwards, ours
/// downwards.
class ElevonMixer final : public VehicleMixer {
 public:
  ElevonMixer(const VehicleDescription& vehicle, const std::string& who)
      : VehicleMixer(vehicle,
                     {{"elevon_left", false}, {"elevon_right", false}, {"throttle", true}}) {
    vehicle.need_fixed_wing(who);
    left_ = vehicle.actuator_index("elevon_left_rad", who);
    right_ = vehicle.actuator_index("elevon_right_rad", who);
    throttle_ = vehicle.actuator_index("throttle", who);
  }

  void mix(std::span<const double> values, NamedValues& to) const override {
    to.values[left_] = -values[0] * actuators()[left_].max;
    to.values[right_] = -values[1] * actuators()[right_].max;
    to.values[throttle_] = values[2] * actuators()[throttle_].max;
  }

 private:
  int left_ = 0, right_ = 0, throttle_ = 0;
};

std::string default_mixer(const VehicleDescription& vehicle) {
  if (vehicle.rotorcraft) return "quadrotor_x";
  if (vehicle.fixed_wing) return "elevons";
  if (vehicle.steered) return "four_wheel_steering";
  return vehicle.ackermann ? "ackermann" : "skid";
}

}  // namespace

std::vector<std::string> output_mixer_names() {
  return {"skid",   "throttle_steering", "ackermann", "four_wheel_steering", "quadrotor_x",
          "elevons"};
}

std::unique_ptr<OutputMixer> make_output_mixer(const VehicleDescription& vehicle,
                                               const std::string& name, const std::string& who) {
  const std::string chosen = name.empty() ? default_mixer(vehicle) : name;
  if (chosen == "skid" || chosen == "throttle_steering") {
    return std::make_unique<SkidMixer>(vehicle, chosen == "throttle_steering", who);
  }
  if (chosen == "ackermann" || chosen == "four_wheel_steering") {
    return std::make_unique<SteeredMixer>(vehicle, chosen == "four_wheel_steering", who);
  }
  if (chosen == "quadrotor_x") return std::make_unique<QuadrotorMixer>(vehicle, who);
  VINEROW_DEMAND(chosen == "elevons");
  return std::make_unique<ElevonMixer>(vehicle, who);
}

}  // namespace vinerow::controllers
