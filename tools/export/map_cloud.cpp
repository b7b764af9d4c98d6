#include "tools/export/map_cloud.h"

#include <cmath>
#include <cstring>

#include "engine/record/cdr.h"

namespace vinerow::tools {
namespace {

using record::RosKind;

std::optional<std::size_t> place_of(const std::vector<CloudField>& fields, const char* name) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].name == name && fields[i].kind == RosKind::kFloat32) return i;
  }
  return std::nullopt;
}

}  // namespace

MapCloud::MapCloud(std::unique_ptr<MapCloudFile> file, playback::Trace<Odometry> poses,
                   const Pose& X_BS)
    : file_(std::move(file)), poses_(std::move(poses)), X_BS_(X_BS) {}

bool MapCloud::begin(const std::vector<CloudField>& fields) {
  const auto x = place_of(fields, "x"), y = place_of(fields, "y"), z = place_of(fields, "z");
  if (!x || !y || !z) return false;
  at_ = {*x, *y, *z, place_of(fields, "time")};
  fields_ = fields;
  file_->begin(fields);
  has_begun_ = true;
  return true;
}

bool MapCloud::add(std::int64_t stamp_ns, std::int64_t, std::span<const std::uint8_t> message) {
  record::CdrReader in(message);
  in.read<std::int32_t>();
  in.read<std::uint32_t>();
  in.read_text();
  const auto cloud = read_cloud(in);
  if (!cloud) return false;
  if (!has_begun_ && !begin(cloud->fields)) return false;
  if (cloud->fields != fields_) return false;
  for (std::size_t i = 0; i < cloud->size(); ++i) put_point(*cloud, i, stamp_ns);
  return true;
}

/// Sets the pose of the scanner. @returns false if there is none
bool MapCloud::move_to(Time t) {
  // Times within a frame are rounded to single precision.
  constexpr Duration kRounding{1000};
  if (t < poses_.times.front() - kRounding || t > poses_.times.back() + kRounding) return false;
  if (time_ == t) return true;
  const Pose X_WS = playback::odometry_at(poses_, t).X_WB * X_BS_;
  R_WS_ = X_WS.q.toRotationMatrix();
  p_WS_ = X_WS.p;
  time_ = t;
  return true;
}

void MapCloud::put_point(const CloudMessage& cloud, std::size_t i, std::int64_t stamp_ns) {
  const std::uint8_t* const point = cloud.point(i);
  const auto number = [&](std::size_t field) {
    float value;
    std::memcpy(&value, point + fields_[field].offset, sizeof value);
    return double{value};
  };
  const Eigen::Vector3d p_S(number(at_.x), number(at_.y), number(at_.z));
  if (!p_S.allFinite()) return;
  const double later_s = at_.time ? number(*at_.time) : 0.0;
  if (!(std::abs(later_s) < 1e3) ||
      !move_to(Time{stamp_ns + static_cast<std::int64_t>(std::llround(later_s * 1e9))})) {
    ++without_pose_;
    return;
  }
  file_->put(point, R_WS_ * p_S + p_WS_, *time_);
  ++count_;
}

std::uint64_t MapCloud::finish() {
  file_->finish(count_);
  return count_;
}

}  // namespace vinerow::tools
