#pragma once
/// Point cloud of a parcel in memory, as the mapping stages read it.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vinerow::mapping {

/// Class of a point, with the codes of LAS.
enum class PointClass : std::uint8_t {
  kUnclassified = 1,
  kGround = 2,
  kLowVegetation = 3,  ///< grass, weeds, anything under a canopy
  kCanopy = 5,         ///< of a plant row
  kOther = 6,          ///< as high as canopy, but in no row: hedges, trees, buildings
};

/// Number of points in one task of a thread (for_chunks).
inline constexpr std::size_t kPointsAtOnce = 1 << 18;

/// Uses 15 bytes per point, 16 with classes. Positions are in single precision relative to a near
/// origin: within 1 km of it they are accurate to 0.03 mm.
struct ParcelCloud {
  Eigen::Vector3d origin_W = {0, 0, 0};              ///< whole metres
  std::vector<Eigen::Vector3f> points;               ///< m from origin_W, axes of W
  std::vector<std::array<std::uint8_t, 3>> colours;  ///< sRGB, one per point, or empty
  std::vector<PointClass> classes;                   ///< one per point after the classification

  Eigen::Vector3d point_W(std::size_t k) const { return origin_W + points[k].cast<double>(); }
};

}  // namespace vinerow::mapping
