#pragma once
/// Parameters of the estimator `error_state_kalman`.

#include <string>

#include "controllers/estimation/inertial/error_state_kalman.h"
#include "controllers/estimation/parts/initial_pose.h"
#include "engine/api/part.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

struct ErrorStateOptions {
  ErrorStateKalmanParams filter;
  std::string imu = "imu", gps = "gps";                  ///< signals
  std::string barometer, magnetometer, wheels, heading;  ///< signals; empty: none

  bool starts_level = false;  ///< from levelling instead of a draw about the truth
  double levelling_s = 1.0;
  double start_yaw_rad = 0.0;
  double start_std_m = 0.5;
  double start_height_std_m = 0.0;  ///< 0: as start_std_m; read() copies that value
  double start_velocity_std_mps = 0.05;
  double start_tilt_std_rad = rad_from_deg(1.0);
  double start_yaw_std_rad = rad_from_deg(2.0);
  double gyro_bias_std_radps = rad_from_deg(0.02);
  double accel_bias_std_mps2 = 0.02;

  double gate_sigma = 5.0;
  double restart_after_s = 5.0;
  double gnss_std_m = 0.0;             ///< 0: as the receiver states
  double gnss_velocity_std_mps = 0.0;  ///< 0: as the receiver states, else not used
  double gnss_correlation_s = 0.0;
  double barometer_std_m = 0.5;
  double barometer_correlation_s = 10.0;
  double magnetometer_std_rad = rad_from_deg(3.0);
  double magnetometer_correlation_s = 1.0;
  double heading_correlation_s = 0.0;
  double declination_rad = 0.0;
  double wheel_std_mps = 0.1;
  double lateral_std_mps = 0.1;
  double vertical_std_mps = 0.1;
  double wheel_correlation_s = 2.0;
  Eigen::Vector3d constraint_point_B = Eigen::Vector3d::Zero();
  enum class Standing { kOff, kWheels, kImu } stationary = Standing::kOff;
  double standing_s = 0.5;
  double standing_std_mps = 0.01;
  InitialPoseParams initial_pose;

  /// @throws ConfigError if zero_velocity is wheels and no wheels are named
  static ErrorStateOptions read(const ParameterSet& parameters, const std::string& who);
  static void add_parameters(PartSpec& spec);
};

}  // namespace vinerow::controllers
