#include "worlds/mapping/reading/cloud_outline.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "engine/core/error.h"
#include "worlds/mapping/reading/cloud_sample.h"

namespace vinerow::mapping {
namespace {

constexpr double kMargin_m = 100.0;  // no point so near to the bulk is far away

/// A length as a reader wants it: "0.02 m", "1.85 km".
std::string metres(double length_m) {
  if (length_m < 5e-4) return "0 m";
  return length_m < 1000.0 ? fmt::format("{:.3g} m", length_m)
                           : fmt::format("{:.4g} km", 1e-3 * length_m);
}

/// What may help where the numbers can be degrees.
std::string degrees_hint(const CloudOutline& outline) {
  const Eigen::Vector3d max_abs =
      outline.kept.min().cwiseAbs().cwiseMax(outline.kept.max().cwiseAbs());
  const bool is_possible = outline.unit_m.x() == 1.0 && max_abs.x() <= 180.0 && max_abs.y() <= 90.0;
  return is_possible ? "; if its numbers are degrees, give their system by --crs EPSG:4326" : "";
}

/// The box of most points that is no larger than a parcel, with as little cut off as that takes.
Eigen::AlignedBox3d find_bulk(const std::filesystem::path& file, double largest_extent_m,
                              const CloudOutline& outline) {
  for (const double trim : {0.005, 0.02, 0.05}) {
    const Eigen::AlignedBox3d bulk = bulk_of(outline.sample, trim);
    const Eigen::Vector3d size_m = bulk.sizes().cwiseProduct(outline.unit_m);
    if (size_m.maxCoeff() <= largest_extent_m) return bulk;
  }
  const Eigen::Vector3d size_m = bulk_of(outline.sample, 0.05).sizes().cwiseProduct(outline.unit_m);
  refuse_cloud(
      file,
      fmt::format("extends over {} by {} and is {} high, must be at most {} in each direction; "
                  "cut the parcel out of it",
                  metres(size_m.x()), metres(size_m.y()), metres(size_m.z()),
                  metres(largest_extent_m)));
}

/// Refuses what no rows can be found in.
void check_footprint(const std::filesystem::path& file, const CloudOutline& outline) {
  constexpr double kShortest_m = 2.0, kNarrowest_m = 0.1;
  constexpr double kMaxInSpot = 1e6, kEnoughForShares = 100;
  std::vector<Eigen::Vector3d> points_m;
  points_m.reserve(outline.sample.size());
  for (const Eigen::Vector3d& p : outline.sample) {
    if (!outline.kept.contains(p)) continue;
    points_m.push_back((p - outline.middle).cwiseProduct(outline.unit_m));
  }
  const Footprint print = footprint_of(points_m);
  const std::string hint = degrees_hint(outline);
  if (print.length_m < kShortest_m) {
    refuse_cloud(
        file, fmt::format("has all of its {} points in one spot of {} by {}, a parcel is at least "
                          "{} long{}",
                          outline.tally.given, metres(print.length_m), metres(print.width_m),
                          metres(kShortest_m), hint));
  }
  if (print.width_m < kNarrowest_m) {
    refuse_cloud(
        file, fmt::format("has all of its {} points on one line, {} long and {} wide, a parcel is "
                          "at least {} wide{}",
                          outline.tally.given, metres(print.length_m), metres(print.width_m),
                          metres(kNarrowest_m), hint));
  }
  const auto densest = static_cast<double>(densest_square_centimetre(points_m));
  const double held = densest * static_cast<double>(outline.window);
  if (held > kMaxInSpot ||
      (densest > kEnoughForShares && densest > 0.5 * static_cast<double>(points_m.size()))) {
    refuse_cloud(
        file, fmt::format("has about {:.0f} of its {} points within one square centimetre, which "
                          "no survey sees; leave the repeated points out{}",
                          held, outline.tally.given, hint));
  }
}

}  // namespace

void refuse_cloud(const std::filesystem::path& file, const std::string& sentence) {
  throw ConfigError(fmt::format("point cloud '{}' {}", file.string(), sentence));
}

CloudOutline outline_cloud(const std::filesystem::path& file) {
  const std::unique_ptr<io::PointCloudReader> reader = io::open_point_cloud(file);
  CloudOutline outline;
  CloudSample sample;
  std::vector<io::CloudPoint> block(4096);
  std::size_t count = 0;
  do {
    count = reader->read(block);
    for (std::size_t k = 0; k < count; ++k) {
      outline.bounds.extend(block[k].position);
      sample.add(block[k].position);
    }
  } while (count == block.size());
  outline.info = reader->info();
  outline.tally = reader->tally();
  if (outline.tally.given == 0) {
    const io::PointCloudTally& t = outline.tally;
    refuse_cloud(
        file, t.not_finite + t.withheld == 0
                  ? "has no points"
                  : fmt::format("has no points left: {} are not finite, {} are marked as withheld",
                                t.not_finite, t.withheld));
  }
  outline.sample = sample.points();
  outline.window = sample.window();
  return outline;
}

void find_parcel(const std::filesystem::path& file, double largest_extent_m,
                 CloudOutline& outline) {
  const Eigen::AlignedBox3d bulk = find_bulk(file, largest_extent_m, outline);
  const Eigen::Vector3d margin = bulk.sizes().cwiseMax(kMargin_m * outline.unit_m.cwiseInverse());
  outline.kept = Eigen::AlignedBox3d(Eigen::Vector3d(bulk.min() - margin),
                                     Eigen::Vector3d(bulk.max() + margin));
  if (outline.kept.contains(outline.bounds)) {
    outline.middle = outline.bounds.center();
  } else {
    Eigen::AlignedBox3d near;
    for (const Eigen::Vector3d& p : outline.sample) {
      if (outline.kept.contains(p)) near.extend(p);
    }
    outline.middle = near.center();
  }
  outline.kept = outline.kept.intersection(outline.bounds);
  check_footprint(file, outline);
}

}  // namespace vinerow::mapping
