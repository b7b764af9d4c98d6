#pragma once
/// Where an estimator takes attitude and turning rate from.

#include <string>
#include <vector>

#include "engine/api/messages/sensors.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/api/stepped_parts.h"

namespace vinerow {

/// `heading` of the estimators:
///   truth        the true attitude (paper B: heading without error)
///   gyro         yaw rate of the IMU summed up from the true heading at the start; level ground
///   assumed gyro_course  the same, drawn to the course of the satellite velocity while driving
struct HeadingParams {
  enum class Mode { kTruth, kGyro, kGyroCourse } mode = Mode::kTruth;
  std::string imu = "imu";        ///< signal
  double course_time_s = 5.0;     ///< how fast kGyroCourse follows the course
  double course_speed_mps = 0.3;  ///< slower than this the course is not used
};

/// `heading`, `imu`, `course_time_s`, `course_speed_mps`
const ParameterTable<HeadingParams>& heading_table();

class HeadingSource {
 public:
  static std::vector<std::string> reads();

  HeadingSource(const HeadingParams& params, Duration period);

  void connect(Ports& ports);
  /// Advances to `now`. @param fix  a new satellite fix, or nullptr
  void step(const GnssFix* fix);

  bool ready() const { return ready_; }
  const Eigen::Quaterniond& q_WB() const { return q_WB_; }
  const Eigen::Vector3d& w_WB_B() const { return w_WB_B_; }
  double yaw_rad() const { return yaw_rad_; }

 private:
  using Mode = HeadingParams::Mode;
  HeadingParams params_;
  double period_s_;
  bool ready_ = false;
  double yaw_rad_ = 0.0;
  double previous_rate_radps_ = 0.0;
  double since_fix_s_ = 0.0;
  Eigen::Quaterniond q_WB_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d w_WB_B_ = Eigen::Vector3d::Zero();
  SignalReader<Odometry> truth_;
  SignalReader<ImuSample> imu_;
};

}  // namespace vinerow
