#include "controllers/estimation/heading_source.h"

#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"

namespace vinerow {

std::vector<ParameterSpec> HeadingSource::parameters() {
  return {
      choice_parameter("heading", "truth", {"truth", "gyro", "gyro_course"},
                       "truth: without error; gyro: summed yaw rate of the IMU; gyro_course: that, "
                       "drawn to the course of the satellite velocity"),
      text_parameter("imu", "imu", "signal of the IMU (gyro, gyro_course)"),
      positive_parameter("course_time_s", "s", 5.0, "how fast gyro_course follows the course"),
      positive_parameter("course_speed_mps", "m/s", 0.3, "slower than this the course is not used"),
  };
}

std::vector<std::string> HeadingSource::reads() {
  return {"truth", "<imu>"};
}

HeadingSource::HeadingSource(const ParameterSet& parameters, Duration period)
    : imu_name_(parameters.text("imu")),
      course_time_s_(parameters.number("course_time_s")),
      course_speed_mps_(parameters.number("course_speed_mps")),
      period_s_(period.s()) {
  const std::string& mode = parameters.text("heading");
  mode_ = mode == "truth" ? Mode::kTruth : mode == "gyro" ? Mode::kGyro : Mode::kGyroCourse;
}

void HeadingSource::connect(Ports& ports) {
  truth_ = ports.read<Odometry>("truth");
  if (mode_ != Mode::kTruth) imu_ = ports.read<ImuSample>(imu_name_);
}

void HeadingSource::step(const GnssFix* fix) {
  if (mode_ == Mode::kTruth) {
    if (!truth_.has_value()) return;
    q_WB_ = truth_.value().X_WB.q;
    w_WB_B_ = truth_.value().w_WB_B;
    yaw_rad_ = yaw_from_quaternion(q_WB_);
    ready_ = true;
    return;
  }
  if (!imu_.has_value() || !truth_.has_value()) return;
  w_WB_B_ = imu_.value().w_WS_S;
  if (!ready_) {
    yaw_rad_ = yaw_from_quaternion(truth_.value().X_WB.q);
    ready_ = true;
  } else {
    yaw_rad_ += 0.5 * (w_WB_B_.z() + previous_rate_radps_) * period_s_;
  }
  previous_rate_radps_ = w_WB_B_.z();
  since_fix_s_ += period_s_;
  if (mode_ == Mode::kGyroCourse && fix != nullptr) {
    if (fix->v_W.head<2>().norm() > course_speed_mps_) {
      const double course = std::atan2(fix->v_W.y(), fix->v_W.x());
      const double share = std::min(1.0, since_fix_s_ / course_time_s_);
      yaw_rad_ += share * wrap_angle(course - yaw_rad_);
    }
    since_fix_s_ = 0.0;
  }
  yaw_rad_ = wrap_angle(yaw_rad_);
  q_WB_ = quaternion_from_rpy({0.0, 0.0, yaw_rad_});
}

}  // namespace vinerow
