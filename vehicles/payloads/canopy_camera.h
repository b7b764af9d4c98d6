#pragma once
/// Scouting cameras that look at the rows from beside or above: which patches of the true canopy
/// their pictures show well enough.
///
/// A picture is a grid of rays, even in the picture plane. A patch is seen in a picture if a ray
/// meets it first, within the range, at an angle to the surface's normal not larger than the
/// limit, with a ground sampling distance (GSD) not larger than the wanted one. The GSD is the side
/// of a square as large as what a pixel shows of the surface:
///   GSD = z sqrt(p_h p_v) sqrt(cos(theta) / cos(i)),    p = 2 tan(fov / 2) / pixels
/// with z the depth along the optical axis, theta the angle between ray and axis, i the incidence:
/// on a wall across the axis it is z p everywhere. Depth of field, motion blur and light are left
/// out.
///
/// Coverage: quantity "seen", amount = number of pictures that show the patch, wanted:
/// `wanted_views`.
///
/// Cost: cameras * ray_columns * ray_rows rays a picture; no heap in a step.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::vehicles {

PartSpec canopy_camera_spec();
/// @throws ConfigError if parameters do not go together
std::unique_ptr<Payload> make_canopy_camera(const ParameterSet& parameters,
                                            const PayloadContext& context);

}  // namespace vinerow::vehicles
