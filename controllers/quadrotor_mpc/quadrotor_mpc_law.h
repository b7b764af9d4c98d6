#pragma once
/// Control law of `quadrotor_mpc` without signals: estimate and reference in, wrench out.
///
///   minimise  sum_k |x_k - r_k|_Q^2 + |u_k - v_k|_R^2 + |x_N - r_N|_P^2,   k = 0..N-1
///   over      u_k = (thrust minus weight, torques), the wanted wrench of each tick
///   subject to x_{k+1} = A x_k + B u_k + d      HoverModel with rotor lag, 16 states, in frame H
///              the box of thrust and torques                               hard
///              tilt <= max_tilt; |side|, |altitude|, |speed error| <= limits    soft
///
/// P solves the Riccati equation, so without active limits the law is the infinite-horizon LQR with
/// preview. All limits on states are soft: the problem has a solution in every state.
/// The mixer converts the wrench to rotor speeds; the law mixes too, to predict the rotors.
/// Source: paper A (Mammarella et al. 2022), section 4.2.

#include <string>
#include <vector>

#include "controllers/parts/rotorcraft/flight_disturbance.h"
#include "controllers/parts/rotorcraft/hover_frame.h"
#include "controllers/parts/rotorcraft/rotor_prediction.h"
#include "controllers/parts/solvers/linear_mpc.h"
#include "controllers/quadrotor_mpc/flight_targets.h"
#include "controllers/quadrotor_mpc/quadrotor_mpc_params.h"

namespace vinerow::controllers {

/// The problem that the law solves, for its constructor and for tests.
LinearMpcProblem make_quadrotor_problem(const RotorcraftModel& craft, const RotorMixer& mixer,
                                        const QuadrotorMpcParams& params, const std::string& who);

class QuadrotorMpcLaw {
 public:
  /// @throws ConfigError if there is no model or no Riccati solution, or if limits leave no range
  QuadrotorMpcLaw(const RotorcraftModel& craft, const QuadrotorMpcParams& params,
                  const std::string& who);

  /// Rotors at rest, no estimated disturbance.
  void reset();
  /// Rotors at hover speed, no estimated disturbance: for a start in the air.
  void reset_hovering();

  /// One tick. No heap. @param preview  horizon + 1 points, one per tick, the first one now
  /// @param learn  false while the ground carries the vehicle
  /// @returns the wanted wrench; if the estimate is not finite, the previous one
  const Wrench& step(const Odometry& odometry, const std::vector<TrajectoryPoint>& preview,
                     bool learn);

  QpStatus status() const { return status_; }
  const LinearMpc& mpc() const { return mpc_; }
  /// Of the last step: the state in H, and the errors that the soft limits bound.
  const HoverState& state() const { return state_; }
  double speed_error_mps() const { return speed_error_mps_; }
  const FlightDisturbance& disturbance() const { return disturbance_; }

 private:
  void pull_reference();

  RotorcraftModel craft_;
  QuadrotorMpcParams params_;
  double weight_N_, max_thrust_N_;
  RotorMixer mixer_;
  Eigen::Vector3d max_torque_Nm_;
  RotorPrediction rotors_;
  FlightDisturbance disturbance_;
  FlightTargets targets_;
  LinearMpc mpc_;
  Eigen::MatrixXd disturbance_input_;  ///< 16 x 6: held accelerations to states
  HoverState state_;
  double speed_error_mps_ = 0.0;
  QpStatus status_ = QpStatus::kSolved;
  Wrench wanted_;
  Eigen::VectorXd x_, d_, no_input_;
  std::vector<double> speeds_radps_;
};

}  // namespace vinerow::controllers
