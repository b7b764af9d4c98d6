#include "controllers/estimation/parts/heading_source.h"

#include <algorithm>
#include <cmath>

#include "controllers/estimation/parts/mounting.h"
#include "engine/api/parameter_table.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

const ParameterTable<HeadingParams>& heading_table() {
  using P = HeadingParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .choice("heading", &P::mode,
                  {{"truth", P::Mode::kTruth},
                   {"gyro", P::Mode::kGyro},
                   {"gyro_course", P::Mode::kGyroCourse}},
                  "gyro: integrated yaw rate of the IMU; gyro_course: the same, corrected by the "
                  "course of the satellite velocity; truth: without error, for studies")
          .text("imu", &P::imu, "signal of the IMU (gyro, gyro_course)")
          .number("course_time_s", "s", &P::course_time_s, kPositive,
                  "time constant with which gyro_course follows the course")
          .number("course_speed_mps", "m/s", &P::course_speed_mps, kPositive,
                  "speed below which the course is not used")
          .degrees("start_yaw_std_deg", &P::start_yaw_std_rad, between(0.0, 180.0),
                   "1 sigma of the heading at the start (gyro, gyro_course)");
  return table;
}

HeadingSource::HeadingSource(const HeadingParams& params, const EstimatorContext& context)
    : params_(params),
      period_s_(context.period.s()),
      start_error_rad_(params.start_yaw_std_rad * context.random("heading").normal()),
      q_BI_(mounting_of(context, params.imu).q) {}

void HeadingSource::connect(Ports& ports) {
  truth_ = ports.read<Odometry>("truth");
  if (params_.mode != Mode::kTruth) imu_ = ports.read<ImuSample>(params_.imu);
}

void HeadingSource::step(const GnssFix* fix) {
  if (params_.mode == Mode::kTruth) {
    if (!truth_.has_value()) return;
    q_WB_ = truth_.value().X_WB.q;
    w_WB_B_ = truth_.value().w_WB_B;
    yaw_rad_ = yaw_from_quaternion(q_WB_);
    ready_ = true;
    return;
  }
  if (!imu_.has_value() || !truth_.has_value()) return;
  w_WB_B_ = q_BI_ * imu_.value().w_WS_S;
  if (!ready_) {
    yaw_rad_ = yaw_from_quaternion(truth_.value().X_WB.q) + start_error_rad_;
    ready_ = true;
  } else {
    yaw_rad_ += 0.5 * (w_WB_B_.z() + previous_rate_radps_) * period_s_;
  }
  previous_rate_radps_ = w_WB_B_.z();
  since_fix_s_ += period_s_;
  if (params_.mode == Mode::kGyroCourse && fix != nullptr) {
    if (fix->v_W.head<2>().norm() > params_.course_speed_mps) {
      const double course = std::atan2(fix->v_W.y(), fix->v_W.x());
      const double share = std::min(1.0, since_fix_s_ / params_.course_time_s);
      yaw_rad_ += share * wrap_angle(course - yaw_rad_);
    }
    since_fix_s_ = 0.0;
  }
  yaw_rad_ = wrap_angle(yaw_rad_);
  q_WB_ = quaternion_from_rpy({0.0, 0.0, yaw_rad_});
}

void HeadingSource::restart(double yaw_rad) {
  if (params_.mode == Mode::kTruth) return;
  yaw_rad_ = wrap_angle(yaw_rad);
  q_WB_ = quaternion_from_rpy({0.0, 0.0, yaw_rad_});
}

}  // namespace vinerow::controllers
