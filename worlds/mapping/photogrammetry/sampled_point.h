#pragma once
/// Points that a survey of a world gives, with what nobody but the world knows of them.

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
  PointClass truth = PointClass::kUnclassified;  ///< what it is a point of
};

/// Takes points as they come, a few square metres of ground at a time, always in the same order.
using CloudSink = std::function<void(std::span<const SampledPoint>)>;

/// The class of a surface's points; posts and trunks are part of a plant row.
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
