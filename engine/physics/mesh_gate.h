#pragma once
/// Cheap proof that a body of several shapes does not touch a static mesh. The narrow phase
/// searches the mesh's tree once for every shape of the body. The posts of a row are one mesh whose
/// bounding box covers the alleys next to it, so a vehicle of six shapes between the rows would
/// always pay for that search.

#include <btBulletCollisionCommon.h>

namespace vinerow::physics {

/// Searches the mesh's tree once, with the bounding box of the whole body.
/// @param body  of a compound shape
/// @param margin_m  by which the box is widened
/// @returns true if no triangle's box meets it; false if one does, or the test does not apply
bool is_clear_of_mesh(const btCollisionObject& mesh, const btCollisionObject& body,
                      double margin_m);

}  // namespace vinerow::physics
