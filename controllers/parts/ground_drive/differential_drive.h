#pragma once
/// Wheel speeds of a vehicle steered by speed difference.
///
/// Source: paper B, eq. 1-2. The paper prints l/r for the yaw term with l the track width. The
/// usual model, used here, has half the track width, and a commanded yaw rate equals the driven
/// one: omega_r = (v + w l/2) / r, omega_l = (v - w l/2) / r.

#include <vector>

#include "controllers/parts/ground_drive/twist_drive.h"

namespace vinerow::controllers {

class DifferentialDrive final : public TwistDrive {
 public:
  DifferentialDrive() = default;
  /// Finds the wheels by their actuators' names, wheel_<place>_speed_radps. The place is left,
  /// right, l, r, or ends so (fl, rl, fr, rr, front_left, ...).
  /// @throws ConfigError if an actuator is not such a wheel, if a side lacks wheels, or if the
  ///         description lacks track_m or wheel_radius_m
  /// @param who  part name in errors, e.g. "rover.controller (pure_pursuit)"
  DifferentialDrive(const VehicleDescription& description, const std::string& who);

  NamedValues make_actuators() const override;
  void mix(const VelocityCommand& command, NamedValues& actuators) const override;
  VelocityCommand limit(const VelocityCommand& command) const override;
  bool turns_on_the_spot() const override { return true; }

  double track_m() const { return track_m_; }
  double wheel_radius_m() const { return wheel_radius_m_; }

 private:
  struct Wheel {
    std::string name;
    double side = 0.0;  ///< +1 right, -1 left
    double max_radps = 0.0;
  };
  std::vector<Wheel> wheels_;
  double track_m_ = 1.0;
  double wheel_radius_m_ = 0.2;
};

/// +1 for a right wheel's actuator name, -1 for a left one, 0 otherwise.
double side_of_wheel(const std::string& actuator);

}  // namespace vinerow::controllers
