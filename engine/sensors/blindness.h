#pragma once
/// Whether a sensor that looks out is where it sees nothing.

#include <Eigen/Core>
#include <span>
#include <string>

#include "engine/api/scene_query.h"
#include "engine/api/world_model.h"

namespace vinerow::sensors {

/// @param light  surfaces of the world
/// @param vehicles  null: there are none; they are moved to where they are now
/// @param view_W  directions all over what a camera sees; empty: no camera
/// @returns reason why a sensor here sees nothing: "is inside of rover/body". Empty: there is none.
std::string find_blindness(const Pose& X_WS, const WorldModel& world, const RayScene& light,
                           VehicleScene* vehicles, std::span<const Eigen::Vector3d> view_W = {});

/// Sensor that looks out.
class LooksOut {
 public:
  virtual ~LooksOut() = default;
  /// Checks what it would see from a vehicle that is at X_WB. For sensors that are rehearsed: those
  /// that run check it at their first step.
  /// @throws ConfigError "the camera is below the ground: change its position_m"
  virtual void check_view(const Pose& X_WB) = 0;
};

}  // namespace vinerow::sensors
