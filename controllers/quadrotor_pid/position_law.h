#pragma once
/// Position law from the reference to the wanted force of the rotors: position P, velocity PID,
/// feed-forward of velocity, acceleration and drag in still air, limits of tilt and thrust.
///
///   v_wanted = v_ref + k_p (p_ref - p)                       the second term bounded
///   a_wanted = a_ref + k_v (v_wanted - v) + I - k_d dv/dt
///   F        = m (a_wanted + g z) + drag v_ref
///
/// All in W, so the heading has no influence. The vertical part of F comes first; the horizontal
/// part gets what tilt and thrust limits leave, and keeps its direction. The integral does not grow
/// in the direction that the limits cut off.

#include <Eigen/Core>

#include "controllers/parts/rotorcraft/rotorcraft.h"
#include "engine/api/messages/flight.h"

namespace vinerow::controllers {

struct PositionParams {
  /// Gains: horizontal, vertical.
  Eigen::Vector2d position_p_per_s = {1.3, 1.5};
  Eigen::Vector2d velocity_p_per_s = {3.5, 4.0};
  Eigen::Vector2d velocity_i_per_s2 = {2.0, 2.0};
  Eigen::Vector2d velocity_d = {0.0, 0.0};
  double velocity_filter_s = 0.05;  ///< low pass of dv/dt
  /// Bounds of k_p (p_ref - p): horizontal (length), vertical.
  Eigen::Vector2d correction_speed_mps = {2.0, 1.0};
  double tilt_limit_rad = 0.4363;
  double min_thrust_N = 4.0, max_thrust_N = 40.0;
  double period_s = 0.004;
};

class PositionLaw {
 public:
  PositionLaw(const RotorcraftModel& craft, const PositionParams& params);

  void reset();
  /// One cycle. No heap. @param p_W,v_W  of the vehicle @param integrate  false: the integral is
  /// held
  /// @param lost_thrust_N  wanted minus reached thrust of the last cycle
  /// @returns force of the rotors in W, N; its z part > 0
  Eigen::Vector3d step(const TrajectoryPoint& at, const Eigen::Vector3d& p_W,
                       const Eigen::Vector3d& v_W, double lost_thrust_N, bool integrate);
  const Eigen::Vector3d& integral_mps2() const { return integral_; }

 private:
  Eigen::Vector3d limit(const Eigen::Vector3d& F_W) const;
  void integrate(const Eigen::Vector3d& v_error, const Eigen::Vector3d& wanted_N,
                 const Eigen::Vector3d& limited_N, double lost_thrust_N);

  RotorcraftModel craft_;
  PositionParams params_;
  Eigen::Vector3d integral_ = Eigen::Vector3d::Zero();  ///< m/s2
  Eigen::Vector3d v_before_ = Eigen::Vector3d::Zero(), slope_ = Eigen::Vector3d::Zero();
  bool has_before_ = false;
};

}  // namespace vinerow::controllers
