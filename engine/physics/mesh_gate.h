#pragma once
/// A cheap proof that a body of several shapes does not touch a static mesh. The narrow phase walks
/// the mesh's tree once for every shape of the body; a row's posts are one mesh whose bounding box
/// covers the alleys beside it, so that a vehicle of six shapes between the rows would pay for it
/// all the time.

#include <btBulletCollisionCommon.h>

namespace vinerow::physics {

/// One walk with the whole body's bounding box.
/// @param body  of a compound shape  @param margin_m  by which the box is widened
/// @returns true if no triangle's box meets it; false if some does, or the test does not apply
bool is_clear_of_mesh(const btCollisionObject& mesh, const btCollisionObject& body,
                      double margin_m);

}  // namespace vinerow::physics
