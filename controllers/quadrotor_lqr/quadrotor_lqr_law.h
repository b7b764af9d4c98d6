#pragma once
/// Linear quadratic regulator of a rotorcraft about hover, in the frame that is turned with the
/// wanted heading (HoverFrame), with feed-forward of the reference and estimated disturbances.
///
///   u = u_ref - K (x - x_ref)
///
/// x_ref, u_ref are the tilts, thrust and torques that the reference's acceleration, the drag and
/// the estimated disturbances require, so K has no steady error to correct in a steady wind. K is
/// the solution of the discrete Riccati equation of the sampled HoverModel, with 16 states if the
/// rotors lag (their wrench is predicted), else 12. Weights of inputs are per acceleration, so one
/// set of weights gives vehicles of any mass and inertia the same closed loop.
///
/// Exact LQR inside the limits. Outside, the torque rows of K are read as a wanted tilt for
/// position and velocity, tilt_wanted = tilt_ref - (K_tilt)^-1 K_p,v e, and a gain on the tilt's
/// error. That tilt is clamped to its limit, and errors of position and heading to those corrected
/// at the limits of speed.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "controllers/parts/rotorcraft/flight_disturbance.h"
#include "controllers/parts/rotorcraft/flight_limits.h"
#include "controllers/parts/rotorcraft/hover_frame.h"
#include "controllers/parts/rotorcraft/rotor_prediction.h"

namespace vinerow::controllers {

struct LqrParams {
  /// Weights of squared errors. Horizontal, vertical:
  Eigen::Vector2d position_per_m2 = {50.0, 120.0};
  Eigen::Vector2d velocity_per_mps2 = {8.0, 12.0};
  /// Roll and pitch, yaw:
  Eigen::Vector2d angle_per_rad2 = {4.0, 20.0};
  Eigen::Vector2d rate_per_radps2 = {0.3, 1.0};
  /// Of thrust per mass ((m/s2)^-2), of roll and pitch torque and of yaw torque per inertia
  /// ((rad/s2)^-2).
  double thrust_weight = 0.08;
  Eigen::Vector2d torque_weight = {0.0015, 0.019};
  double disturbance_s = 0.5;  ///< time constant of the estimate; 0: no estimate
  double period_s = 0.02;
};

class QuadrotorLqrLaw {
 public:
  /// @throws ConfigError "<who>: no LQR gain: ..." if none exists for the weights and the model
  QuadrotorLqrLaw(const RotorcraftModel& craft, const RotorMixer& mixer, const FlightLimits& limits,
                  const LqrParams& params, const std::string& who);

  /// Resets the disturbances; the rotors are at rest or at hover speed.
  void reset(bool hovering);
  /// One cycle. No heap. @param learn  false: the disturbances stay constant
  /// @returns the wanted wrench in B
  Wrench step(const TrajectoryPoint& at, const Odometry& odometry, bool learn);
  /// The rotor speeds of the mixer, for the prediction of the rotors.
  void command(const std::vector<double>& speeds_radps);

  /// 4 x 16 or 4 x 12.
  const Eigen::MatrixXd& gain() const { return gain_; }

 private:
  void set_up_limits(const FlightLimits& limits);
  Eigen::Vector2d limit_tilt(const Eigen::Vector2d& tilt_rad) const;

  RotorcraftModel craft_;
  FlightLimits limits_;
  double period_s_;
  RotorPrediction rotors_;
  std::vector<double> hover_radps_;
  FlightDisturbance disturbance_;
  Eigen::MatrixXd gain_;
  Eigen::Matrix<double, 2, 4> tilt_of_errors_;  ///< roll, pitch per x, y, v_x, v_y
  Eigen::Vector3d max_error_m_ = Eigen::Vector3d::Zero();
  double max_yaw_error_rad_ = 0.0;
  Eigen::VectorXd error_;
};

}  // namespace vinerow::controllers
