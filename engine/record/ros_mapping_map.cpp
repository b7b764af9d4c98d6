/// Mappings of what planners know and search: grid, tree, local command.

#include "engine/record/ros_fields.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::record {
namespace {

constexpr std::int32_t kLineListMarker = 5;
constexpr float kTreeLineWidth_m = 0.03f;
constexpr std::int8_t kTaken = 100;
const Pose kNoPose;

}  // namespace

void RosMapping<LocalCommand>::write(CdrWriter& out, const WriteContext& to,
                                     const LocalCommand& value) {
  write_header(out, to.stamp, to.frames.body);
  out.add(static_cast<std::uint8_t>(value.mode));
  out.add(value.v_mps);
  out.add(value.front_axle_rad);
  out.add(value.rear_axle_rad);
  out.add(value.clearance_m);
}

bool RosMapping<LocalCommand>::read(CdrReader& in, const FrameNames&, LocalCommand& value) {
  skip_header(in);
  const auto mode = in.read<std::uint8_t>();
  if (mode > static_cast<std::uint8_t>(LocalCommand::Mode::kStop)) return false;
  value.mode = static_cast<LocalCommand::Mode>(mode);
  value.v_mps = in.read<double>();
  value.front_axle_rad = in.read<double>();
  value.rear_axle_rad = in.read<double>();
  value.clearance_m = in.read<double>();
  return in.ok();
}

void RosMapping<LineList>::write(CdrWriter& out, const WriteContext& to, const LineList& value) {
  write_header(out, to.stamp, to.frames.world);
  out.add(std::string_view(to.frames.own));
  out.add(std::int32_t{0});
  out.add(kLineListMarker);
  out.add(std::int32_t{0});
  write_pose(out, kNoPose);
  out.add(Eigen::Vector3d(kTreeLineWidth_m, 0, 0));
  for (const float channel : {0.2f, 0.6f, 1.0f, 0.6f}) out.add(channel);
  out.add(std::int32_t{0});
  out.add(std::uint32_t{0});
  out.add(false);
  out.add_count(value.points_W.size());
  for (const Eigen::Vector3d& p : value.points_W) out.add(p);
  out.add_count(0);
  out.add(std::string_view());
  write_header(out, Time{}, std::string_view());
  out.add(std::string_view());
  out.add_count(0);
  out.add_count(0);
  out.add(std::string_view());
  out.add(std::string_view());
  out.add(std::string_view());
  out.add_count(0);
  out.add(false);
}

bool RosMapping<LineList>::read(CdrReader& in, const FrameNames&, LineList& value) {
  skip_header(in);
  in.read_text();
  for (int i = 0; i < 3; ++i) in.read<std::int32_t>();
  Pose pose;
  read_pose(in, pose);
  in.skip_doubles(3);
  for (int i = 0; i < 4; ++i) in.read<float>();
  in.read<std::int32_t>();
  in.read<std::uint32_t>();
  in.read_bool();
  value.points_W.resize(in.read_count(3 * sizeof(double)));
  for (Eigen::Vector3d& p : value.points_W) in.read(p);
  return in.ok();
}

void RosMapping<OccupancyGrid>::write(CdrWriter& out, const WriteContext& to,
                                      const OccupancyGrid& value) {
  write_header(out, to.stamp, to.frames.world);
  write_time(out, to.stamp);
  out.add(static_cast<float>(value.cell_m));
  out.add(static_cast<std::uint32_t>(value.columns));
  out.add(static_cast<std::uint32_t>(value.rows));
  write_pose(out, {Eigen::Quaterniond::Identity(),
                   Eigen::Vector3d(value.corner_W.x(), value.corner_W.y(), 0)});
  out.add_count(value.cells.size());
  for (const std::uint8_t cell : value.cells) out.add(cell != 0 ? kTaken : std::int8_t{0});
}

void RosMapping<OccupancyGrid>::write_exact(CdrWriter& out, const WriteContext& to,
                                            const OccupancyGrid& value) {
  write_header(out, to.stamp, to.frames.world);
  out.add(value.cell_m);
  out.add(value.corner_W.x());
  out.add(value.corner_W.y());
  out.add(static_cast<std::uint32_t>(value.columns));
  out.add(static_cast<std::uint32_t>(value.rows));
  out.add_count(value.cells.size());
  for (const std::uint8_t cell : value.cells) out.add(cell);
}

bool RosMapping<OccupancyGrid>::read(CdrReader& in, const FrameNames&, OccupancyGrid& value) {
  skip_header(in);
  value.cell_m = in.read<double>();
  value.corner_W.x() = in.read<double>();
  value.corner_W.y() = in.read<double>();
  const auto columns = in.read<std::uint32_t>(), rows = in.read<std::uint32_t>();
  value.cells.resize(in.read_count(1));
  for (std::uint8_t& cell : value.cells) cell = in.read<std::uint8_t>();
  if (std::uint64_t{columns} * rows != value.cells.size()) return false;
  value.columns = static_cast<int>(columns);
  value.rows = static_cast<int>(rows);
  return in.ok();
}

}  // namespace vinerow::record
