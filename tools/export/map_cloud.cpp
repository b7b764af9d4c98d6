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

MapCloud::MapCloud(CloudFormat format, const std::filesystem::path& file,
                   playback::Trace<Odometry> poses, const Pose& X_BS)
    : format_(format), output_(file), poses_(std::move(poses)), X_BS_(X_BS) {}

bool MapCloud::begin(const std::vector<CloudField>& fields) {
  const auto x = place_of(fields, "x"), y = place_of(fields, "y"), z = place_of(fields, "z");
  if (!x || !y || !z) return false;
  at_ = {*x, *y, *z, place_of(fields, "time")};
  fields_ = written_ = fields;
  // Single precision has steps of 0.1 ms after half an hour.
  if (at_.time) written_[*at_.time].kind = RosKind::kFloat64;
  output_.put_text(cloud_header(format_, written_, 0));
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
  const Eigen::Vector3f p_W = (R_WS_ * p_S + p_WS_).cast<float>();
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    if (k == at_.x) {
      output_.put(p_W.x());
    } else if (k == at_.y) {
      output_.put(p_W.y());
    } else if (k == at_.z) {
      output_.put(p_W.z());
    } else if (k == at_.time) {
      output_.put(time_->s());
    } else {
      output_.put_text({reinterpret_cast<const char*>(point + fields_[k].offset),
                        record::size_of(fields_[k].kind)});
    }
  }
  ++count_;
  output_.flush_if_long();
}

std::uint64_t MapCloud::finish() {
  output_.flush();
  output_.overwrite_text(0, cloud_header(format_, written_, count_));
  output_.close();
  return count_;
}

}  // namespace vinerow::tools
