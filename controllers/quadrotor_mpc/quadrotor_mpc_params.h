#pragma once
/// Parameters of controller `quadrotor_mpc`, read once.

#include <Eigen/Core>

#include "engine/api/parameter_table_fwd.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

/// Weights of the cost, per tick of 0.05 s; other periods scale them, so that the cost per second
/// is the same. Axes of H: along the wanted heading, left, up.
struct MpcWeights {
  Eigen::Vector3d position = {40, 60, 120};     ///< 1/m2
  Eigen::Vector3d velocity = {8, 8, 12};        ///< 1/(m/s)2
  Eigen::Vector3d angle = {4, 4, 20};           ///< roll, pitch, yaw, 1/rad2
  Eigen::Vector3d rate = {0.3, 0.3, 1};         ///< 1/(rad/s)2
  Eigen::Vector4d input = {0.02, 0.6, 0.6, 2};  ///< thrust 1/N2, torques 1/(N m)2
};

struct MpcLimits {
  double tilt_rad = rad_from_deg(25.0);
  double lateral_m = 0.25;
  double altitude_m = 0.15;
  double speed_mps = 0.3;
};

struct QuadrotorMpcParams {
  int horizon = 20;
  double period_s = 0.05;
  MpcWeights weights;
  MpcLimits limits;
  double deviation_weight = 1e3;  ///< of soft rows: lateral, altitude, speed; per tick of 0.05 s
  double tilt_weight = 1e6;
  double torque_share = 0.7;
  double min_thrust = 0.3, max_thrust = 2.0;  ///< in weights
  double disturbance_s = 0.3;
  bool learns_torque = true;
};

/// All but period_s.
const ParameterTable<QuadrotorMpcParams>& quadrotor_mpc_table();

}  // namespace vinerow::controllers
