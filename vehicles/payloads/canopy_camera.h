#pragma once
/// Scouting cameras that record rows from the side or from above: patches of the true canopy that
/// their pictures show well enough.
///
/// A picture is a grid of rays, evenly spaced in the picture plane. A patch is seen in a picture if
/// a ray meets it first, within the range, at an angle to the surface's normal below the limit, and
/// with a ground sampling distance (GSD) of at most the wanted one. The GSD is the side of a square
/// with the area of the surface that a pixel covers:
///   GSD = z sqrt(p_h p_v) sqrt(cos(theta) / cos(i)),    p = 2 tan(fov / 2) / pixels
/// with the depth z along the optical axis, the angle theta between ray and axis and the incidence
/// i. On a wall across the axis it is z p everywhere. Depth of field, motion blur and light are
/// left out.
///
/// Coverage: quantity "seen", amount = number of pictures that show the patch, wanted:
/// `wanted_views`.
///
/// Cost: cameras * ray_columns * ray_rows rays per picture; no heap in a step.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::vehicles {

PartSpec canopy_camera_spec();
/// @throws ConfigError if parameters contradict each other
std::unique_ptr<Payload> make_canopy_camera(const ParameterSet& parameters,
                                            const PayloadContext& context);

}  // namespace vinerow::vehicles
