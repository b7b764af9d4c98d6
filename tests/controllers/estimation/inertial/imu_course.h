#pragma once
/// A body on a smooth course in closed form, and what an inertial unit on it reads.

#include <Eigen/Core>
#include <cmath>

#include "controllers/estimation/inertial/error_state.h"
#include "engine/core/random.h"
#include "engine/core/time.h"
#include "engine/math/pose.h"

namespace vinerow::test {

constexpr double kGravity_mps2 = 9.80665;

struct CoursePoint {
  controllers::NavState state;  ///< biases zero
  Eigen::Vector3d w_B, f_B;
};

/// a sin(w t + phase), with two derivatives.
struct Swing {
  double amplitude = 0.0, rate = 0.0, phase = 0.0;
  double at(double t) const { return amplitude * std::sin(rate * t + phase); }
  double d(double t) const { return amplitude * rate * std::cos(rate * t + phase); }
  double dd(double t) const { return -rate * rate * at(t); }
};

/// Swings along each axis of W and in roll, pitch and yaw, and a steady turn.
struct ImuCourse {
  Swing x, y, z, roll, pitch, yaw;
  double turn_radps = 0.0;

  CoursePoint at(double t) const {
    CoursePoint point;
    point.state.p_WI = {x.at(t), y.at(t), z.at(t)};
    point.state.v_WI = {x.d(t), y.d(t), z.d(t)};
    const RollPitchYaw rpy = {roll.at(t), pitch.at(t), yaw.at(t) + turn_radps * t};
    point.state.q_WB = quaternion_from_rpy(rpy);
    // R = Rz Ry Rx: w_B = e_x roll' + Rx' e_y pitch' + Rx' Ry' e_z yaw'.
    const double dr = roll.d(t), dp = pitch.d(t), dy = yaw.d(t) + turn_radps;
    const double sr = std::sin(rpy.roll_rad), cr = std::cos(rpy.roll_rad);
    const double sp = std::sin(rpy.pitch_rad), cp = std::cos(rpy.pitch_rad);
    point.w_B = {dr - dy * sp, dp * cr + dy * sr * cp, -dp * sr + dy * cr * cp};
    const Eigen::Vector3d a_W(x.dd(t), y.dd(t), z.dd(t));
    point.f_B = point.state.q_WB.conjugate() * (a_W + Eigen::Vector3d(0, 0, kGravity_mps2));
    return point;
  }
};

/// A quadrotor that wanders: some m/s2 in all directions, so that every state can be seen.
inline ImuCourse lively_course() {
  return {
      {8, 0.35, 0}, {6, 0.45, 1.0}, {1.5, 0.3, 0.4}, {0.15, 0.7, 0}, {0.12, 0.8, 2}, {0.8, 0.25, 0},
      0.1};
}
/// A circle of 5 m in the plane at 2 m/s, looking ahead.
inline ImuCourse circle() {
  ImuCourse course;
  course.x = {5, 0.4, 0};
  course.y = {5, 0.4, -0.5 * 3.14159265358979323846};
  course.turn_radps = 0.4;
  return course;
}

inline Eigen::Vector3d normal3(RandomStream& random) {
  const double a = random.normal(), b = random.normal(), c = random.normal();
  return {a, b, c};
}

/// Tick i of a rate.
constexpr Time tick_at(std::int64_t i, std::int64_t period_ns) {
  return {i * period_ns};
}

}  // namespace vinerow::test
