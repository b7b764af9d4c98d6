#pragma once
/// Steering angle and wheel speeds of a car: steered front axle, fixed rear axle.
///
/// The rear wheels do not slide, so the vehicle turns about a point on the line of their axle. With
/// origin B a distance b ahead of that axle, the wheel base L and the curvature k = w / v:
///
///   tan(delta) = L k,      rim speed of the wheel at (x, y) = v sqrt((1 - k y)^2 + (k (x + b))^2)
///
/// where v is the forward speed of B and delta the angle of a virtual wheel in the middle of the
/// front axle. B itself slides inwards in a turn: v_y = b w.

#include <vector>

#include "controllers/parts/ground_drive/twist_drive.h"

namespace vinerow::controllers {

class AckermannDrive final : public TwistDrive {
 public:
  /// Finds the actuators axle_front_steer_rad and wheel_<place>_speed_radps, places fl, fr, rl, rr.
  /// Some of the wheels may be missing: they roll freely.
  /// @throws ConfigError if there is another actuator, or a number of the description is missing
  AckermannDrive(const VehicleDescription& description, const std::string& who);

  NamedValues make_actuators() const override;
  /// At zero speed the front axle keeps its angle, as in a stopped car.
  void mix(const VelocityCommand& command, NamedValues& actuators) const override;
  VelocityCommand limit(const VelocityCommand& command) const override;
  bool turns_on_the_spot() const override { return false; }

 private:
  struct Actuator {
    std::string name;
    bool is_wheel = true;
    Eigen::Vector2d p_R = {0, 0};  ///< of the wheel, from the middle of the rear axle
    double max_radps = 0.0;
  };
  /// Rim speed of a wheel per speed of B. @param curvature_per_m  w / v
  static double rim_per_speed(const Actuator& wheel, double curvature_per_m);
  double curvature_of(const VelocityCommand& command) const;

  std::vector<Actuator> actuators_;
  double wheel_base_m_ = 1.0;
  double wheel_radius_m_ = 0.2;
  double max_curvature_per_m_ = 1.0;
};

}  // namespace vinerow::controllers
