#pragma once
/// The points of a parcel in memory, as the mapping stages read them.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vinerow::mapping {

/// What a point belongs to, by the codes of LAS.
enum class PointClass : std::uint8_t {
  kUnclassified = 1,
  kGround = 2,
  kLowVegetation = 3,  ///< grass, weeds, what lies under a canopy
  kCanopy = 5,         ///< of a plant row
  kOther = 6,          ///< as high as canopy, in no row: hedges, trees, buildings
};

/// What a thread takes of a cloud (for_chunks).
inline constexpr std::size_t kPointsAtOnce = 1 << 18;

/// 15 bytes a point, 16 with classes. Positions are single precision from a near origin: within
/// 1 km of it they are right to 0.03 mm.
struct ParcelCloud {
  Eigen::Vector3d origin_W = {0, 0, 0};              ///< whole metres
  std::vector<Eigen::Vector3f> points;               ///< m from origin_W, axes of W
  std::vector<std::array<std::uint8_t, 3>> colours;  ///< sRGB, one per point, or empty
  std::vector<PointClass> classes;                   ///< one per point once they are told apart

  Eigen::Vector3d point_W(std::size_t k) const { return origin_W + points[k].cast<double>(); }
};

}  // namespace vinerow::mapping
