#pragma once
/// Where a file's points lie, and whether they can be a parcel.

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/io/clouds/point_cloud.h"

namespace vinerow::mapping {

/// Of the first reading. In the file's frame and unit, but for what ends on _m.
struct CloudOutline {
  io::PointCloudInfo info;
  io::PointCloudTally tally;
  std::vector<Eigen::Vector3d> sample;  ///< at least one
  std::uint64_t window = 1;             ///< points that each of the sample stands for
  Eigen::AlignedBox3d bounds;           ///< of all points

  Eigen::Vector3d unit_m = {1, 1, 1};  ///< m of one unit along each axis, at the cloud's middle
  Eigen::AlignedBox3d kept;            ///< what lies outside of it is far away
  Eigen::Vector3d middle = {0, 0, 0};  ///< of the bounds of the points that are kept
};

/// @throws ConfigError "point cloud '<file>' <sentence>"
[[noreturn]] void refuse_cloud(const std::filesystem::path& file, const std::string& sentence);

/// Reads the file once. @throws ConfigError as the reader, and where no points are left
CloudOutline outline_cloud(const std::filesystem::path& file);

/// Sets `kept` and `middle`. @param outline  with the unit
/// @throws ConfigError naming the file: larger than the limit, all points in one spot or on one
/// line
void find_parcel(const std::filesystem::path& file, double largest_extent_m, CloudOutline& outline);

}  // namespace vinerow::mapping
