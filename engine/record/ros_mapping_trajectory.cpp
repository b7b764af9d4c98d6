/// Mapping of what a flying vehicle is to follow.

#include <algorithm>
#include <cmath>

#include "engine/record/ros_fields.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::record {
namespace {

// Least bytes of one element of the sequence: bounds a damaged count.
constexpr std::size_t kLeastPoint = 11 * sizeof(double);

constexpr double kMostSeconds = 2'147'483'647;  ///< that builtin_interfaces/Duration holds

}  // namespace

void RosMapping<ReferenceTrajectory>::write(CdrWriter& out, const WriteContext& to,
                                            const ReferenceTrajectory& value) {
  write_header(out, to.stamp, to.frames.world);
  out.add_count(1);
  out.add(std::string_view("base_link"));
  out.add_count(value.points.size());
  for (std::size_t i = 0; i < value.points.size(); ++i) {
    const TrajectoryPoint& point = value.points[i];
    out.add_count(1);
    write_pose(out, {quaternion_from_rpy({0, 0, point.yaw_rad}), point.p_W});
    out.add_count(1);
    out.add(point.v_W);
    out.add(Eigen::Vector3d(0, 0, point.yaw_rate_radps));
    out.add_count(1);
    out.add(point.a_W);
    out.add_zero_doubles(3);
    const double from_start_s =
        std::clamp(static_cast<double>(i) * value.dt_s, -kMostSeconds, kMostSeconds);
    write_time(out, Time{std::llround(from_start_s * 1e9)});  // a Duration has the same two fields
  }
}

void RosMapping<ReferenceTrajectory>::write_exact(CdrWriter& out, const WriteContext& to,
                                                  const ReferenceTrajectory& value) {
  write_header(out, to.stamp, to.frames.world);
  out.add(static_cast<std::uint8_t>(value.phase));
  out.add(value.distance_m);
  out.add(value.remaining_m);
  out.add(value.dt_s);
  out.add_count(value.points.size());
  for (const TrajectoryPoint& point : value.points) {
    out.add(point.p_W);
    out.add(point.v_W);
    out.add(point.a_W);
    out.add(point.yaw_rad);
    out.add(point.yaw_rate_radps);
  }
}

bool RosMapping<ReferenceTrajectory>::read(CdrReader& in, const FrameNames&,
                                           ReferenceTrajectory& value) {
  skip_header(in);
  const auto phase = in.read<std::uint8_t>();
  if (phase > static_cast<std::uint8_t>(ReferenceTrajectory::Phase::kHover)) return false;
  value.phase = static_cast<ReferenceTrajectory::Phase>(phase);
  value.distance_m = in.read<double>();
  value.remaining_m = in.read<double>();
  value.dt_s = in.read<double>();
  value.points.resize(in.read_count(kLeastPoint));
  for (TrajectoryPoint& point : value.points) {
    in.read(point.p_W);
    in.read(point.v_W);
    in.read(point.a_W);
    point.yaw_rad = in.read<double>();
    point.yaw_rate_radps = in.read<double>();
  }
  return in.ok();
}

}  // namespace vinerow::record
