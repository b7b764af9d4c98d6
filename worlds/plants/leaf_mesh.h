#pragma once
/// Blades of leaves as triangles.

#include <Eigen/Core>

#include "engine/api/forward.h"
#include "worlds/plants/leaf_outline.h"

namespace vinerow::worlds {

/// Blade of a leaf.
struct LeafOrgan {
  Eigen::Vector3d node;      ///< where its stalk leaves the shoot
  Eigen::Vector3d junction;  ///< where the stalk meets the blade
  Eigen::Vector3d along;     ///< unit, from the junction towards the tip
  Eigen::Vector3d normal;    ///< unit, of the upper face
  double area_m2 = 0.0;
  Eigen::Vector3f colour = Eigen::Vector3f::Zero();  ///< linear RGB
};

/// Appends a blade: a fan about the junction, folded along the midrib, its rim bent down. Seen
/// along its normal it has this area. @param area_m2  of the blade, if it stands for several leaves
/// @param level  of the outline @param widening  width of the blade over that of its kind
void append_blade(TriangleMesh& mesh, LeafKind kind, const LeafOrgan& leaf, double area_m2,
                  int level, double widening = 1.0);

}  // namespace vinerow::worlds
