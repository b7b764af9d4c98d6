#pragma once
/// Points from a survey of a world, with their true classes.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <span>

#include "engine/api/surface.h"
#include "worlds/mapping/model/parcel_cloud.h"

namespace vinerow::mapping {

struct SampledPoint {
  Eigen::Vector3d p_W = {0, 0, 0};               ///< with its error
  std::array<std::uint8_t, 3> rgb{};             ///< sRGB
  PointClass truth = PointClass::kUnclassified;  ///< true class
};

/// Receives points in batches of a few square metres of ground, always in the same order.
using CloudSink = std::function<void(std::span<const SampledPoint>)>;

/// Class of a surface's points; posts and trunks belong to a plant row.
constexpr PointClass class_of(SurfaceClass surface) {
  switch (surface) {
    case SurfaceClass::kTerrain:
      return PointClass::kGround;
    case SurfaceClass::kCanopy:
    case SurfaceClass::kPost:
    case SurfaceClass::kTrunk:
    case SurfaceClass::kWire:
      return PointClass::kCanopy;
    case SurfaceClass::kObstacle:
    case SurfaceClass::kVehicle:
      break;
  }
  return PointClass::kOther;
}

}  // namespace vinerow::mapping
