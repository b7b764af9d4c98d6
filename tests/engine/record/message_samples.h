#pragma once
/// Message values with every field filled by different numbers, and their comparison to the bit.

#include <array>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/api/message.h"
#include "engine/api/messages.h"
#include "engine/core/random.h"

namespace vinerow::test {

/// Fills the fields that have no special range.
struct FillField {
  RandomStream& random;

  template <class T>
  void operator()(const FieldInfo&, T& value) const {
    fill(value);
  }

 private:
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void fill(T& value) const {
    if constexpr (std::is_enum_v<T>) {
      // Ranges differ: set by fill() below.
    } else if constexpr (std::is_same_v<T, bool>) {
      value = random.uniform() < 0.5;
    } else if constexpr (std::is_integral_v<T>) {
      value = static_cast<T>(random.next_u64() % 100000) - 50000;
    } else {
      value = 100 * random.normal();
    }
  }
  void fill(std::string& text) const {
    text.clear();
    for (auto n = random.next_u64() % 20; n > 0; --n) {
      text.push_back(static_cast<char>('a' + random.next_u64() % 26));
    }
  }
  void fill(Eigen::Vector3d& v) const {
    for (double& x : v) fill(x);
  }
  void fill(Eigen::Quaterniond& q) const {
    for (double& x : q.coeffs()) fill(x);
    q.normalize();
  }
  void fill(Pose& pose) const {
    fill(pose.p);
    fill(pose.q);
  }
  template <HasFields T>
  void fill(T& record) const {
    T::fields(record, *this);
  }
  template <class T, std::size_t kCount>
  void fill(std::array<T, kCount>& values) const {
    for (T& value : values) fill(value);
  }
  template <class T>
  void fill(std::vector<T>& values) const {
    for (T& value : values) fill(value);
  }
  void fill(std::vector<std::uint8_t>& bytes) const {
    for (std::uint8_t& x : bytes) x = static_cast<std::uint8_t>(random.next_u64());
  }
};

template <class T>
void fill(RandomStream& random, T& value) {
  const auto size = static_cast<std::size_t>(random.next_u64() % 7);
  if constexpr (std::is_same_v<T, LaserScan>) value.ranges_m.resize(size);
  if constexpr (std::is_same_v<T, PointCloud>) {
    for (auto* list : {&value.x, &value.y, &value.z, &value.intensity, &value.time_s}) {
      list->resize(size);
    }
    value.ring.resize(size);
    value.return_number.resize(size);
    const bool has_labels = random.uniform() < 0.5;
    value.label.resize(has_labels ? size : 0);
    value.instance.resize(has_labels ? size : 0);
  }
  if constexpr (std::is_same_v<T, NamedValues>) {
    value.names.resize(size);
    value.values.resize(size);
  }
  if constexpr (std::is_same_v<T, LinkPoses>) {
    value.names.resize(size);
    value.X_WL.resize(size);
  }
  if constexpr (std::is_same_v<T, PlannedPath>) value.points.resize(size);
  if constexpr (std::is_same_v<T, ReferenceTrajectory>) value.points.resize(size);
  if constexpr (std::is_same_v<T, LineList>) value.points_W.resize(2 * size);
  T::fields(value, FillField{random});
  if constexpr (std::is_same_v<T, PointCloud>) {
    // Half of them organised, and there some points not seen.
    value.rows = size > 0 && random.uniform() < 0.5 ? static_cast<std::uint32_t>(size) : 0;
    for (std::size_t i = 0; value.rows > 0 && i < size; ++i) {
      value.return_number[i] = static_cast<std::uint8_t>(i % 3);
      if (value.return_number[i] > 0) continue;
      value.x[i] = value.y[i] = value.z[i] = value.intensity[i] = 0.0F;
    }
  }
  if constexpr (std::is_same_v<T, Picture>) {
    value.format = static_cast<Picture::Format>(random.next_u64() % 4);
    value.width = static_cast<std::uint32_t>(size);
    value.height = static_cast<std::uint32_t>(random.next_u64() % 5);
    if (value.width == 0 || value.height == 0) value.width = value.height = 0;
    value.data.resize(value.width * value.height * Picture::bytes_per_pixel(value.format));
    for (std::uint8_t& byte : value.data) byte = static_cast<std::uint8_t>(random.next_u64());
  }
  if constexpr (std::is_same_v<T, CameraInfo>) {
    value.lens = static_cast<CameraInfo::Lens>(random.next_u64() % 2);
    // A fisheye lens has four coefficients.
    if (value.lens == CameraInfo::Lens::kFisheye) value.distortion[4] = 0.0;
  }
  if constexpr (std::is_same_v<T, PlannedPath>) {
    for (PathPoint& point : value.points) point.kind = static_cast<PathKind>(random.next_u64() % 5);
  }
  if constexpr (std::is_same_v<T, ReferenceTrajectory>) {
    value.phase = static_cast<ReferenceTrajectory::Phase>(random.next_u64() % 9);
  }
  if constexpr (std::is_same_v<T, GnssFix>) {
    value.mode = static_cast<GnssFix::Mode>(random.next_u64() % 5);
  }
  if constexpr (std::is_same_v<T, PressureSample>) value.std_Pa = std::abs(value.std_Pa);
  if constexpr (std::is_same_v<T, MagneticSample>) value.std_T = std::abs(value.std_T);
  if constexpr (std::is_same_v<T, AirReference>) {
    value.phase = static_cast<AirReference::Phase>(random.next_u64() % 7);
  }
  if constexpr (std::is_same_v<T, LocalCommand>) {
    value.mode = static_cast<LocalCommand::Mode>(random.next_u64() % 3);
  }
  if constexpr (std::is_same_v<T, OccupancyGrid>) {
    value.columns = static_cast<int>(size);
    value.rows = static_cast<int>(random.next_u64() % 5);
    value.cells.resize(size * static_cast<std::size_t>(value.rows));
    for (std::uint8_t& cell : value.cells) cell = random.next_u64() % 2;
  }
  if constexpr (std::is_same_v<T, Event>) {
    value.level = static_cast<Event::Level>(20 + 10 * (random.next_u64() % 3));
  }
  if constexpr (std::is_same_v<T, Odometry>) {
    // A standard deviation has no sign.
    value.yaw_std_rad = std::abs(value.yaw_std_rad);
  }
  if constexpr (std::is_same_v<T, DeadReckoning>) {
    value.velocity_std_mps = value.velocity_std_mps.cwiseAbs().eval();
    value.yaw_rate_std_radps = std::abs(value.yaw_rate_std_radps);
  }
}

/// All fields as bytes, sizes included.
struct CollectField {
  std::vector<std::uint8_t>& bytes;

  template <class T>
  void operator()(const FieldInfo&, const T& value) const {
    collect(value);
  }

 private:
  void add(const void* data, std::size_t size) const {
    const auto* first = static_cast<const std::uint8_t*>(data);
    bytes.insert(bytes.end(), first, first + size);
  }
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void collect(const T& value) const { add(&value, sizeof value); }
  void collect(const std::string& text) const {
    collect(text.size());
    add(text.data(), text.size());
  }
  void collect(const Eigen::Vector3d& v) const { add(v.data(), 3 * sizeof(double)); }
  void collect(const Eigen::Quaterniond& q) const { add(q.coeffs().data(), 4 * sizeof(double)); }
  void collect(const Pose& pose) const {
    collect(pose.p);
    collect(pose.q);
  }
  template <HasFields T>
  void collect(const T& record) const {
    T::fields(record, *this);
  }
  template <class T, std::size_t kCount>
  void collect(const std::array<T, kCount>& values) const {
    for (const T& value : values) collect(value);
  }
  template <class T>
  void collect(const std::vector<T>& values) const {
    collect(values.size());
    for (const T& value : values) collect(value);
  }
};

template <class T>
std::vector<std::uint8_t> bytes_of(const T& value) {
  std::vector<std::uint8_t> bytes;
  T::fields(value, CollectField{bytes});
  return bytes;
}

}  // namespace vinerow::test
