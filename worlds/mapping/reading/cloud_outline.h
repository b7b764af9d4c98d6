#pragma once
/// Extent of a file's points, and the test that they can be a parcel.

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/io/clouds/point_cloud.h"

namespace vinerow::mapping {

/// Result of the first reading, in the file's frame and unit except members that end in _m.
struct CloudOutline {
  io::PointCloudInfo info;
  io::PointCloudTally tally;
  std::vector<Eigen::Vector3d> sample;  ///< at least one
  std::uint64_t window = 1;             ///< points represented by each of the sample
  Eigen::AlignedBox3d bounds;           ///< of all points

  Eigen::Vector3d unit_m = {1, 1, 1};  ///< m of one unit along each axis, at the cloud's middle
  Eigen::AlignedBox3d kept;            ///< points outside are far away
  Eigen::Vector3d middle = {0, 0, 0};  ///< of the bounds of the points that are kept
};

/// @throws ConfigError "point cloud '<file>' <sentence>"
[[noreturn]] void refuse_cloud(const std::filesystem::path& file, const std::string& sentence);

/// Reads the file once. @throws ConfigError as the reader, and if no points are left
CloudOutline outline_cloud(const std::filesystem::path& file);

/// Sets `kept` and `middle`. @param outline  with the unit
/// @throws ConfigError naming the file: larger than the limit, all points in one spot or on one
/// line
void find_parcel(const std::filesystem::path& file, double largest_extent_m, CloudOutline& outline);

}  // namespace vinerow::mapping
