/// Mapping of point clouds.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

#include "engine/record/ros_fields.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::record {
namespace {

// Constants of sensor_msgs/msg/PointField.
constexpr std::uint8_t kUint8 = 2, kUint16 = 4, kFloat32 = 7;

/// A point as the log has it. Velodyne's and Ouster's drivers name x, y, z, intensity, ring and
/// time alike.
struct PackedPoint {
  float x, y, z, intensity, time;
  std::uint16_t ring;
  std::uint8_t return_number, unused;
};
static_assert(sizeof(PackedPoint) == 24);

struct PackedField {
  const char* name;
  std::uint32_t offset;
  std::uint8_t type;
};
constexpr std::array kFields = {
    PackedField{"x", offsetof(PackedPoint, x), kFloat32},
    PackedField{"y", offsetof(PackedPoint, y), kFloat32},
    PackedField{"z", offsetof(PackedPoint, z), kFloat32},
    PackedField{"intensity", offsetof(PackedPoint, intensity), kFloat32},
    PackedField{"time", offsetof(PackedPoint, time), kFloat32},
    PackedField{"ring", offsetof(PackedPoint, ring), kUint16},
    PackedField{"return_number", offsetof(PackedPoint, return_number), kUint8}};

}  // namespace

void RosMapping<PointCloud>::write(CdrWriter& out, const WriteContext& to,
                                   const PointCloud& value) {
  // A part may leave its lists of different length; only whole points count.
  const std::size_t count =
      std::min({value.x.size(), value.y.size(), value.z.size(), value.intensity.size(),
                value.time_s.size(), value.ring.size(), value.return_number.size()});
  write_header(out, to.stamp, to.frames.own);
  out.add(std::uint32_t{1});  // height: points in no order
  out.add(static_cast<std::uint32_t>(count));
  out.add_count(kFields.size());
  for (const PackedField& field : kFields) {
    out.add(std::string_view(field.name));
    out.add(field.offset);
    out.add(field.type);
    out.add(std::uint32_t{1});
  }
  out.add(false);  // is_bigendian
  out.add(static_cast<std::uint32_t>(sizeof(PackedPoint)));
  out.add(static_cast<std::uint32_t>(count * sizeof(PackedPoint)));
  out.add_count(count * sizeof(PackedPoint));
  std::uint8_t* bytes = out.extend_octets(count * sizeof(PackedPoint));
  for (std::size_t i = 0; i < count; ++i) {
    const PackedPoint point{value.x[i],
                            value.y[i],
                            value.z[i],
                            value.intensity[i],
                            value.time_s[i],
                            value.ring[i],
                            value.return_number[i],
                            0};
    std::memcpy(bytes + i * sizeof point, &point, sizeof point);
  }
  out.add(true);  // is_dense: no point is invalid
}

bool RosMapping<PointCloud>::read(CdrReader& in, const FrameNames&, PointCloud& value) {
  skip_header(in);
  const auto height = in.read<std::uint32_t>();
  const auto width = in.read<std::uint32_t>();
  // Only clouds of the form above are read: those of our own logs.
  constexpr std::size_t kSmallestField = 16;
  bool is_ours = height == 1 && in.read_count(kSmallestField) == kFields.size();
  for (std::size_t i = 0; is_ours && i < kFields.size(); ++i) {
    is_ours = in.read_text() == kFields[i].name && in.read<std::uint32_t>() == kFields[i].offset &&
              in.read<std::uint8_t>() == kFields[i].type && in.read<std::uint32_t>() == 1;
  }
  is_ours = is_ours && !in.read_bool() && in.read<std::uint32_t>() == sizeof(PackedPoint);
  if (!is_ours) return false;
  in.read<std::uint32_t>();  // row_step
  const std::size_t bytes = in.read_count(1);
  if (!in.ok() || bytes != std::size_t{width} * sizeof(PackedPoint)) return false;
  for (std::vector<float>* list : {&value.x, &value.y, &value.z, &value.intensity, &value.time_s}) {
    list->resize(width);
  }
  value.ring.resize(width);
  value.return_number.resize(width);
  for (std::size_t i = 0; i < width; ++i) {
    std::array<std::uint8_t, sizeof(PackedPoint)> raw{};
    in.read_octets(raw.data(), raw.size());
    PackedPoint point{};
    std::memcpy(&point, raw.data(), sizeof point);
    value.x[i] = point.x;
    value.y[i] = point.y;
    value.z[i] = point.z;
    value.intensity[i] = point.intensity;
    value.time_s[i] = point.time;
    value.ring[i] = point.ring;
    value.return_number[i] = point.return_number;
  }
  in.read_bool();
  return in.ok();
}

}  // namespace vinerow::record
