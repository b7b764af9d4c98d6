/// Mapping of the reference trajectory of flying vehicles.

#include <algorithm>
#include <cmath>

#include "engine/record/ros_fields.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::record {
namespace {

constexpr double kMaxSeconds = 2'147'483'647;  ///< limit of builtin_interfaces/Duration

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
        std::clamp(static_cast<double>(i) * value.dt_s, -kMaxSeconds, kMaxSeconds);
    write_time(out, Time{std::llround(from_start_s * 1e9)});  // a Duration has the same two fields
  }
}

}  // namespace vinerow::record
