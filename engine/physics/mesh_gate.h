#pragma once
/// Cheap proof that a body of one or several shapes (a compound) does not touch a static mesh. The
/// posts of a row are one mesh whose bounding box covers the alleys next to it. The narrow phase
/// would search that mesh's tree for every shape of a vehicle between the rows, and compute the
/// distance of each triangle in a box along the mesh's axes, which is larger than the vehicle.

#include <btBulletCollisionCommon.h>

namespace vinerow::physics {

/// Searches the mesh's tree once, with the bounding box of the whole body, and compares the
/// triangles that it finds with the body's box in its own axes.
/// @param body  of a compound shape
/// @param margin_m  by which the boxes are widened
/// @returns true if no triangle meets them; false if one does, or the test does not apply
bool is_clear_of_mesh(const btCollisionObject& mesh, const btCollisionObject& body,
                      double margin_m);

}  // namespace vinerow::physics
