#pragma once
/// Source of an estimator's attitude and angular rate.

#include <string>
#include <vector>

#include "engine/api/messages/sensors.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/api/stepped_parts.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

/// `heading` of the estimators:
///   gyro_course  integral of the IMU yaw rate from the heading at the start,
///                corrected by the course of the satellite velocity while driving; assumes level
///                ground
///   gyro         the integral alone
///   truth        the true attitude (paper B: heading without error), for studies; never by default
/// The heading at the start is drawn once about the truth with `start_yaw_std_deg`.
struct HeadingParams {
  enum class Mode { kTruth, kGyro, kGyroCourse } mode = Mode::kGyroCourse;
  std::string imu = "imu";        ///< signal
  double course_time_s = 5.0;     ///< time constant with which kGyroCourse follows the course
  double course_speed_mps = 0.3;  ///< below this speed the course is not used
  double start_yaw_std_rad = rad_from_deg(1.0);
};

/// `heading`, `imu`, `course_time_s`, `course_speed_mps`, `start_yaw_std_deg`
const ParameterTable<HeadingParams>& heading_table();

class HeadingSource {
 public:
  /// The stream "heading" of the part draws the heading error at the start.
  HeadingSource(const HeadingParams& params, const EstimatorContext& context);

  void connect(Ports& ports);
  /// Advances to `now`. @param fix  a new satellite fix, or nullptr
  void step(const GnssFix* fix);

  /// Replaces the integrated heading; no effect if it is the truth. @pre ready()
  void restart(double yaw_rad);

  bool ready() const { return ready_; }
  const Eigen::Quaterniond& q_WB() const { return q_WB_; }
  const Eigen::Vector3d& w_WB_B() const { return w_WB_B_; }
  double yaw_rad() const { return yaw_rad_; }

 private:
  using Mode = HeadingParams::Mode;
  HeadingParams params_;
  double period_s_;
  double start_error_rad_;
  Eigen::Quaterniond q_BI_;  ///< of the inertial unit
  bool ready_ = false;
  double yaw_rad_ = 0.0;
  double previous_rate_radps_ = 0.0;
  double since_fix_s_ = 0.0;
  Eigen::Quaterniond q_WB_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d w_WB_B_ = Eigen::Vector3d::Zero();
  SignalReader<Odometry> truth_;
  SignalReader<ImuSample> imu_;
};

}  // namespace vinerow::controllers
