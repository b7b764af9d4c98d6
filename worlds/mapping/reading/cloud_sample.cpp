#include "worlds/mapping/reading/cloud_sample.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/check.h"
#include "engine/math/decomposition.h"
#include "engine/math/statistics.h"

namespace vinerow::mapping {
namespace {

/// The values below and above which a share of `trim` lies. @param values  changed
std::array<double, 2> trimmed_range(std::vector<double>& values, double trim) {
  VINEROW_DEMAND(!values.empty() && trim >= 0.0 && trim < 0.5);
  const auto cut = static_cast<std::size_t>(trim * static_cast<double>(values.size()));
  return {value_in_order(values, cut), value_in_order(values, values.size() - 1 - cut)};
}

}  // namespace

CloudSample::CloudSample() : random_(0, "", "cloud sample") {
  points_.reserve(kMax);
}

void CloudSample::keep(const Eigen::Vector3d& point) {
  if (points_.size() == kMax) {
    // Of each two windows that become one, either point: the later where a coin says so.
    for (std::size_t k = 0; k < kMax / 2; ++k) {
      points_[k] = points_[2 * k + (random_.uniform() < 0.5 ? 0 : 1)];
    }
    points_.resize(kMax / 2);
    window_ *= 2;
    windows_ /= 2;
    // This point opens the next window of the new length, whose own one may come later.
    next_ = windows_ * window_ + random_.next_u64() % window_;
    if (next_ >= count_) return;
  }
  points_.push_back(point);
  ++windows_;
  next_ = windows_ * window_ + random_.next_u64() % window_;
}

Eigen::AlignedBox3d bulk_of(const std::vector<Eigen::Vector3d>& points, double trim) {
  Eigen::AlignedBox3d box;
  std::vector<double> values(points.size());
  for (int k = 0; k < 3; ++k) {
    std::transform(points.begin(), points.end(), values.begin(),
                   [&](const Eigen::Vector3d& p) { return p[k]; });
    const auto [low, high] = trimmed_range(values, trim);
    box.min()[k] = low;
    box.max()[k] = high;
  }
  return box;
}

Footprint footprint_of(const std::vector<Eigen::Vector3d>& points_m) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector3d& p : points_m) mean += p.head<2>();
  mean /= static_cast<double>(points_m.size());
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector3d& p : points_m) {
    const Eigen::Vector2d d = p.head<2>() - mean;
    covariance += d * d.transpose();
  }
  const SymmetricEigen<2> axes = decompose_symmetric<2>(covariance);
  std::array<double, 2> sizes{};
  std::vector<double> values(points_m.size());
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector2d axis = axes.vectors.col(k);
    std::transform(points_m.begin(), points_m.end(), values.begin(),
                   [&](const Eigen::Vector3d& p) { return axis.dot(p.head<2>() - mean); });
    constexpr double kTrim = 0.005;
    const auto [low, high] = trimmed_range(values, kTrim);
    sizes[static_cast<std::size_t>(k)] = high - low;
  }
  return {std::max(sizes[0], sizes[1]), std::min(sizes[0], sizes[1])};
}

std::size_t densest_square_centimetre(const std::vector<Eigen::Vector3d>& points_m) {
  std::vector<std::array<std::int64_t, 2>> cells(points_m.size());
  std::transform(points_m.begin(), points_m.end(), cells.begin(), [](const Eigen::Vector3d& p) {
    return std::array{static_cast<std::int64_t>(std::floor(100.0 * p.x())),
                      static_cast<std::int64_t>(std::floor(100.0 * p.y()))};
  });
  std::sort(cells.begin(), cells.end());
  std::size_t max_run = 0, run = 0;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    run = k > 0 && cells[k] == cells[k - 1] ? run + 1 : 1;
    max_run = std::max(max_run, run);
  }
  return max_run;
}

}  // namespace vinerow::mapping
