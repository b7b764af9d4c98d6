/// Mappings of what has wings: what it is to hold, its speed through the air, the pictures it
/// takes.

#include "engine/record/ros_fields.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::record {

void RosMapping<AirReference>::write(CdrWriter& out, const WriteContext& to,
                                     const AirReference& value) {
  write_header(out, to.stamp, to.frames.world);
  out.add(static_cast<std::uint8_t>(value.phase));
  out.add(value.power);
  out.add(value.airspeed_mps);
  out.add(value.course_rad);
  out.add(value.heading_rad);
  out.add(value.heading_rate_radps);
  out.add(value.bank_rad);
  out.add(value.height_m);
  out.add(value.climb_angle_rad);
  out.add(value.wind_W);
  out.add(value.cross_track_m);
  out.add(value.waypoint);
  out.add(value.distance_m);
  out.add(value.remaining_m);
}

bool RosMapping<AirReference>::read(CdrReader& in, const FrameNames&, AirReference& value) {
  skip_header(in);
  const auto phase = in.read<std::uint8_t>();
  if (phase > static_cast<std::uint8_t>(AirReference::Phase::kDone)) return false;
  value.phase = static_cast<AirReference::Phase>(phase);
  value.power = in.read<std::uint8_t>() != 0;
  value.airspeed_mps = in.read<double>();
  value.course_rad = in.read<double>();
  value.heading_rad = in.read<double>();
  value.heading_rate_radps = in.read<double>();
  value.bank_rad = in.read<double>();
  value.height_m = in.read<double>();
  value.climb_angle_rad = in.read<double>();
  in.read(value.wind_W);
  value.cross_track_m = in.read<double>();
  value.waypoint = in.read<std::int32_t>();
  value.distance_m = in.read<double>();
  value.remaining_m = in.read<double>();
  return in.ok();
}

void RosMapping<AirData>::write(CdrWriter& out, const WriteContext& to, const AirData& value) {
  write_header(out, to.stamp, to.frames.body);
  out.add(value.v_air_B);
}

bool RosMapping<AirData>::read(CdrReader& in, const FrameNames&, AirData& value) {
  skip_header(in);
  in.read(value.v_air_B);
  return in.ok();
}

void RosMapping<CameraShot>::write(CdrWriter& out, const WriteContext& to,
                                   const CameraShot& value) {
  write_header(out, to.stamp, to.frames.world);
  out.add(value.index);
  write_pose(out, value.X_WS);
  for (const Eigen::Vector3d& corner : value.corners_W) out.add(corner);
  out.add(value.on_ground);
  out.add(value.distance_m);
  out.add(value.gsd_m);
}

bool RosMapping<CameraShot>::read(CdrReader& in, const FrameNames&, CameraShot& value) {
  skip_header(in);
  value.index = in.read<std::int32_t>();
  read_pose(in, value.X_WS);
  for (Eigen::Vector3d& corner : value.corners_W) in.read(corner);
  value.on_ground = in.read<std::uint8_t>() != 0;
  value.distance_m = in.read<double>();
  value.gsd_m = in.read<double>();
  return in.ok();
}

}  // namespace vinerow::record
