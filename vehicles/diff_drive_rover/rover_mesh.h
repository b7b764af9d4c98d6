#pragma once
/// Mesh of the rover's body for display: steel frame, white shell with green panels, battery box,
/// sensor bar, mast with GNSS antenna. The collision hull is in diff_drive_rover.cpp.

#include "engine/api/mesh.h"

namespace vinerow::vehicles {

struct RoverMeshParams {
  double wheel_base_m = 1.5;
  double track_m = 1.0;
  double wheel_radius_m = 0.2;
  double tyre_width_m = 0.16;
  double ground_to_origin_m = 0.38;  ///< height of the mesh's origin above level ground
};

/// x forward, y left, z up, origin at B.
TriangleMesh make_rover_mesh(const RoverMeshParams& params);

}  // namespace vinerow::vehicles
