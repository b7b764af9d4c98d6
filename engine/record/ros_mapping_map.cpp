/// Mappings of planner data: occupancy grid and search tree.

#include <algorithm>

#include "engine/record/ros_fields.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::record {
namespace {

// Constants of the ROS 2 definitions.
constexpr std::int32_t kMarkerLineList = 5;
constexpr std::int32_t kMarkerAdd = 0;
constexpr std::uint8_t kOccupied = 100;  ///< per cent

// Appearance of a search tree in a viewer; chosen for legibility.
constexpr double kLineWidth_m = 0.03;
constexpr float kLineColour[4] = {0.2f, 0.6f, 1.0f, 0.6f};  // red, green, blue, alpha

}  // namespace

void RosMapping<LineList>::write(CdrWriter& out, const WriteContext& to, const LineList& value) {
  write_header(out, to.stamp, to.frames.world);
  out.add(std::string_view(to.frames.own));  // ns
  out.add(std::int32_t{0});                  // id
  out.add(kMarkerLineList);
  out.add(kMarkerAdd);
  write_pose(out, Pose{});
  out.add(Eigen::Vector3d(kLineWidth_m, 0, 0));  // scale
  for (const float channel : kLineColour) out.add(channel);
  out.add(std::int32_t{0});  // lifetime: until it is replaced
  out.add(std::uint32_t{0});
  out.add(false);  // frame_locked
  out.add_count(value.points_W.size());
  out.add(std::span(value.points_W));
  out.add_count(0);                               // colors
  out.add(std::string_view());                    // texture_resource
  write_header(out, Time{}, std::string_view());  // texture
  out.add(std::string_view());
  out.add_count(0);
  out.add_count(0);             // uv_coordinates
  out.add(std::string_view());  // text
  out.add(std::string_view());  // mesh_resource
  out.add(std::string_view());  // mesh_file
  out.add_count(0);
  out.add(false);  // mesh_use_embedded_materials
}

bool RosMapping<LineList>::read(CdrReader& in, const FrameNames&, LineList& value) {
  skip_header(in);
  in.read_text();
  for (int i = 0; i < 3; ++i) in.read<std::int32_t>();
  in.skip_doubles(3 + 4 + 3);  // pose, scale
  for (int i = 0; i < 4; ++i) in.read<float>();
  skip_time(in);  // lifetime
  in.read_bool();
  value.points_W.resize(in.read_count(3 * sizeof(double)));
  in.read(std::span(value.points_W));
  return in.ok();
}

void RosMapping<OccupancyGrid>::write(CdrWriter& out, const WriteContext& to,
                                      const OccupancyGrid& value) {
  write_header(out, to.stamp, to.frames.world);
  write_time(out, to.stamp);  // map_load_time
  out.add(static_cast<float>(value.cell_m));
  out.add(static_cast<std::uint32_t>(value.columns));
  out.add(static_cast<std::uint32_t>(value.rows));
  Pose origin;
  origin.p.head<2>() = value.corner_W;
  write_pose(out, origin);
  out.add_count(value.cells.size());
  std::transform(value.cells.begin(), value.cells.end(), out.extend_octets(value.cells.size()),
                 [](std::uint8_t cell) { return cell != 0 ? kOccupied : std::uint8_t{0}; });
}

}  // namespace vinerow::record
