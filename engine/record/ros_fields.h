#pragma once
/// Nested parts of ROS 2 messages: time, header, pose. Internal to engine/record.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <string_view>

#include "engine/core/time.h"
#include "engine/math/pose.h"
#include "engine/record/cdr.h"
#include "engine/record/write_context.h"

namespace vinerow::record {

constexpr std::int64_t kNsPerS = 1'000'000'000;

/// builtin_interfaces/Time: nanoseconds count forward from the second below.
inline void write_time(CdrWriter& out, Time stamp) {
  std::int64_t sec = stamp.ns / kNsPerS;
  std::int64_t nanosec = stamp.ns % kNsPerS;
  if (nanosec < 0) {
    nanosec += kNsPerS;
    --sec;
  }
  out.add(static_cast<std::int32_t>(sec));
  out.add(static_cast<std::uint32_t>(nanosec));
}

inline void skip_time(CdrReader& in) {
  in.read<std::int32_t>();
  in.read<std::uint32_t>();
}

inline void write_header(CdrWriter& out, Time stamp, std::string_view frame) {
  write_time(out, stamp);
  out.add(frame);
}

inline void skip_header(CdrReader& in) {
  skip_time(in);
  in.read_text();
}

/// ROS stores x, y, z, w, which is also Eigen's order in memory.
inline void write_quaternion(CdrWriter& out, const Eigen::Quaterniond& q) {
  out.add_doubles(q.coeffs().data(), 4);
}

inline void write_pose(CdrWriter& out, const Pose& pose) {
  out.add(pose.p);
  write_quaternion(out, pose.q);
}

inline void read_pose(CdrReader& in, Pose& pose) {
  in.read(pose.p);
  in.read_doubles(pose.q.coeffs().data(), 4);
}

// Row-major 6x6 covariance of a pose, axes x y z roll pitch yaw: x, y, z and yaw are known.
constexpr std::size_t kCovarianceSize = 36;
constexpr std::size_t kCovarianceYaw = 35;

/// @param diagonal  of the position: xx, yy, zz  @param off_diagonal  xy, xz, yz
/// @returns the variance of the yaw
inline double read_pose_covariance(CdrReader& in, Eigen::Vector3d& diagonal,
                                   Eigen::Vector3d& off_diagonal) {
  double covariance[kCovarianceSize] = {};
  in.read_doubles(covariance, kCovarianceSize);
  diagonal = {covariance[0], covariance[7], covariance[14]};
  off_diagonal = {covariance[1], covariance[2], covariance[8]};
  return covariance[kCovarianceYaw];
}

inline double round_to_grid(double value) {
  // + 0.0 turns -0 into 0: zero then has one bit pattern.
  return std::round(value / kPoseGrid) * kPoseGrid + 0.0;
}

/// X_BA from X_WB and X_WA, rounded to the grid.
inline Pose pose_in_body(const Pose& X_WB, const Pose& X_WA) {
  Pose X_BA = X_WB.inverse() * X_WA;
  X_BA.p = X_BA.p.unaryExpr(&round_to_grid);
  X_BA.q.coeffs() = X_BA.q.coeffs().unaryExpr(&round_to_grid);
  return X_BA;
}

/// Square and root of a standard deviation. The pair is exact in IEEE binary arithmetic for values
/// whose square neither overflows nor underflows (S. Boldo, "Stupid is as stupid does: taking the
/// square root of the square of a floating-point number", ENTCS 317, 2015), so covariances are
/// stored without loss.
inline double variance(double std) {
  return std * std;
}
inline double std_of_variance(double value) {
  return std::sqrt(value);
}

}  // namespace vinerow::record
