/// Mapping of point clouds.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/record/ros_fields.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::record {
namespace {

// Constants of sensor_msgs/msg/PointField.
constexpr std::uint8_t kUint8 = 2, kUint16 = 4, kUint32 = 6, kFloat32 = 7;

/// A point of a list. Velodyne's driver names x, y, z, intensity, ring and time alike.
struct PackedPoint {
  float x, y, z, intensity, time;
  std::uint16_t ring;
  std::uint8_t return_number, unused;
};
static_assert(sizeof(PackedPoint) == 24);

/// A point of an organised cloud. Ouster's driver names and stores x, y, z, intensity, t, range,
/// ring and reflectivity alike; t, range and reflectivity follow from the others.
struct OrganisedPoint {
  float x, y, z, intensity;
  std::uint32_t t;      ///< ns from the stamp
  std::uint32_t range;  ///< mm; 0: nothing was seen
  float time;
  std::uint16_t ring, reflectivity;  ///< reflectivity: percent, at most 255
  std::uint8_t return_number, unused[3];
};
static_assert(sizeof(OrganisedPoint) == 36);

/// Follows a point of a cloud with labels.
struct PointLabel {
  std::uint32_t instance;
  std::uint8_t label, unused[3];
};
static_assert(sizeof(PointLabel) == 8);

struct PackedField {
  const char* name;
  std::uint32_t offset;
  std::uint8_t type;
};

template <class Point>
constexpr auto fields_of() {
  constexpr std::array kShared = {
      PackedField{"x", offsetof(Point, x), kFloat32},
      PackedField{"y", offsetof(Point, y), kFloat32},
      PackedField{"z", offsetof(Point, z), kFloat32},
      PackedField{"intensity", offsetof(Point, intensity), kFloat32},
      PackedField{"time", offsetof(Point, time), kFloat32},
      PackedField{"ring", offsetof(Point, ring), kUint16},
      PackedField{"return_number", offsetof(Point, return_number), kUint8}};
  if constexpr (std::is_same_v<Point, PackedPoint>) {
    return kShared;
  } else {
    std::array<PackedField, kShared.size() + 3> all{};
    std::copy(kShared.begin(), kShared.end(), all.begin());
    all[kShared.size()] = {"t", offsetof(Point, t), kUint32};
    all[kShared.size() + 1] = {"range", offsetof(Point, range), kUint32};
    all[kShared.size() + 2] = {"reflectivity", offsetof(Point, reflectivity), kUint16};
    return all;
  }
}

/// @param i  of the cloud
PackedPoint pack_listed(const PointCloud& cloud, std::size_t i) {
  return {cloud.x[i],
          cloud.y[i],
          cloud.z[i],
          cloud.intensity[i],
          cloud.time_s[i],
          cloud.ring[i],
          cloud.return_number[i],
          0};
}

/// Nearest whole number from 0 to `most`.
std::uint32_t whole(double value, double most) {
  return value > 0.0 ? static_cast<std::uint32_t>(std::llround(std::min(value, most))) : 0u;
}

OrganisedPoint pack_organised(const PointCloud& cloud, std::size_t i) {
  constexpr double kMost = std::numeric_limits<std::uint32_t>::max();
  OrganisedPoint point{};
  point.t = whole(1e9 * double{cloud.time_s[i]}, kMost);
  point.time = cloud.time_s[i];
  point.ring = cloud.ring[i];
  point.return_number = cloud.return_number[i];
  if (point.return_number == 0) {
    point.x = point.y = point.z = std::numeric_limits<float>::quiet_NaN();
    return point;
  }
  point.x = cloud.x[i];
  point.y = cloud.y[i];
  point.z = cloud.z[i];
  point.intensity = cloud.intensity[i];
  const Eigen::Vector3d p(cloud.x[i], cloud.y[i], cloud.z[i]);
  point.range = whole(1e3 * p.norm(), kMost);
  constexpr double kMostReflectivity = 255.0;
  point.reflectivity = static_cast<std::uint16_t>(whole(point.intensity, kMostReflectivity));
  return point;
}

/// Fields of a point, with those of its label.
template <class Point>
std::vector<PackedField> fields_of(bool has_labels) {
  constexpr auto kFields = fields_of<Point>();
  std::vector<PackedField> fields(kFields.begin(), kFields.end());
  if (has_labels) {
    fields.push_back({"label", sizeof(Point) + offsetof(PointLabel, label), kUint8});
    fields.push_back({"instance", sizeof(Point) + offsetof(PointLabel, instance), kUint32});
  }
  return fields;
}

template <class Point>
std::size_t size_of_point(bool has_labels) {
  return sizeof(Point) + (has_labels ? sizeof(PointLabel) : 0);
}

/// Fields and points, after height and width.
template <class Point, class Pack>
void write_points(CdrWriter& out, const PointCloud& value, std::size_t count, std::size_t width,
                  Pack&& pack) {
  const bool has_labels =
      count > 0 && value.label.size() >= count && value.instance.size() >= count;
  const std::vector<PackedField> fields = fields_of<Point>(has_labels);
  out.add_count(fields.size());
  for (const PackedField& field : fields) {
    out.add(std::string_view(field.name));
    out.add(field.offset);
    out.add(field.type);
    out.add(std::uint32_t{1});
  }
  const std::size_t size = size_of_point<Point>(has_labels);
  out.add(false);  // is_bigendian
  out.add(static_cast<std::uint32_t>(size));
  out.add(static_cast<std::uint32_t>(width * size));
  out.add_count(count * size);
  std::uint8_t* bytes = out.extend_octets(count * size);
  for (std::size_t i = 0; i < count; ++i, bytes += size) {
    const Point point = pack(value, i);
    std::memcpy(bytes, &point, sizeof point);
    if (!has_labels) continue;
    const PointLabel label{value.instance[i], value.label[i], {}};
    std::memcpy(bytes + sizeof point, &label, sizeof label);
  }
}

/// What follows the field count. Only clouds as write() makes them are read: those of our own logs.
template <class Point>
bool read_points(CdrReader& in, std::size_t count, bool has_labels, PointCloud& value) {
  bool is_ours = true;
  for (const PackedField& field : fields_of<Point>(has_labels)) {
    is_ours = is_ours && in.read_text() == field.name && in.read<std::uint32_t>() == field.offset &&
              in.read<std::uint8_t>() == field.type && in.read<std::uint32_t>() == 1;
  }
  const std::size_t size = size_of_point<Point>(has_labels);
  is_ours = is_ours && !in.read_bool() && in.read<std::uint32_t>() == size;
  if (!is_ours) return false;
  in.read<std::uint32_t>();  // row_step
  const std::size_t bytes = in.read_count(1);
  if (!in.ok() || bytes % size != 0 || bytes / size != count) return false;
  for (std::vector<float>* list : {&value.x, &value.y, &value.z, &value.intensity, &value.time_s}) {
    list->resize(count);
  }
  value.ring.resize(count);
  value.return_number.resize(count);
  value.label.resize(has_labels ? count : 0);
  value.instance.resize(has_labels ? count : 0);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<std::uint8_t, sizeof(Point)> raw{};
    in.read_octets(raw.data(), raw.size());
    Point point{};
    std::memcpy(&point, raw.data(), sizeof point);
    if (value.rows > 0 && point.return_number == 0) point.x = point.y = point.z = 0.0F;
    value.x[i] = point.x;
    value.y[i] = point.y;
    value.z[i] = point.z;
    value.intensity[i] = point.intensity;
    value.time_s[i] = point.time;
    value.ring[i] = point.ring;
    value.return_number[i] = point.return_number;
    if (!has_labels) continue;
    std::array<std::uint8_t, sizeof(PointLabel)> raw_label{};
    in.read_octets(raw_label.data(), raw_label.size());
    PointLabel label{};
    std::memcpy(&label, raw_label.data(), sizeof label);
    value.label[i] = label.label;
    value.instance[i] = label.instance;
  }
  in.read_bool();
  return in.ok();
}

}  // namespace

void RosMapping<PointCloud>::write(CdrWriter& out, const WriteContext& to,
                                   const PointCloud& value) {
  // A part may leave its lists of different length; only whole points count.
  const std::size_t count =
      std::min({value.x.size(), value.y.size(), value.z.size(), value.intensity.size(),
                value.time_s.size(), value.ring.size(), value.return_number.size()});
  write_header(out, to.stamp, to.frames.own);
  const bool is_organised = value.rows > 0 && count % value.rows == 0;
  const std::size_t rows = is_organised ? value.rows : 1;
  out.add(static_cast<std::uint32_t>(rows));
  out.add(static_cast<std::uint32_t>(count / rows));
  if (!is_organised) {
    write_points<PackedPoint>(out, value, count, count, pack_listed);
    out.add(true);  // is_dense: no point is invalid
    return;
  }
  write_points<OrganisedPoint>(out, value, count, count / rows, pack_organised);
  out.add(std::find(value.return_number.begin(), value.return_number.end(), 0) ==
          value.return_number.end());
}

bool RosMapping<PointCloud>::read(CdrReader& in, const FrameNames&, PointCloud& value) {
  skip_header(in);
  const auto height = in.read<std::uint32_t>();
  const auto width = in.read<std::uint32_t>();
  constexpr std::size_t kSmallestField = 16;
  const std::size_t fields = in.read_count(kSmallestField);
  const std::size_t count = std::size_t{height} * width;
  constexpr std::size_t kLabels = 2, kListed = fields_of<PackedPoint>().size(),
                        kOrganised = fields_of<OrganisedPoint>().size();
  static_assert(kListed + kLabels < kOrganised);
  const bool is_organised = fields >= kOrganised;
  const std::size_t more = fields - (is_organised ? kOrganised : kListed);
  if (fields < kListed || height == 0 || (more != 0 && more != kLabels)) return false;
  value.rows = is_organised ? height : 0;
  if (is_organised) return read_points<OrganisedPoint>(in, count, more > 0, value);
  return height == 1 && read_points<PackedPoint>(in, count, more > 0, value);
}

}  // namespace vinerow::record
