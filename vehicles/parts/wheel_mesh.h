#pragma once
/// Mesh of an agricultural wheel for display: tyre with chevron lugs, dished rim with holes and
/// bolts.

#include "engine/api/mesh.h"

namespace vinerow::vehicles {

struct WheelMeshParams {
  double radius_m = 0.2;  ///< over the lugs
  double width_m = 0.16;
  double rim_radius_m = 0.105;
  double lug_height_m = 0.016;
  int lugs = 15;     ///< per side
  bool left = true;  ///< side of the dish: +y for left wheels
  unsigned rim_srgb = 0xd9dcd6;
  unsigned hub_srgb = 0x2f7d32;
};

/// Axle along y, centre at the origin, rolling forward along x; the chevrons point forward on top.
TriangleMesh make_wheel_mesh(const WheelMeshParams& params);

}  // namespace vinerow::vehicles
