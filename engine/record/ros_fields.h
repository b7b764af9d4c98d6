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
