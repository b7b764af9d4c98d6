#pragma once
/// Colour of the ground for camera sensors: grass, bare soil under the vines, wheel tracks.
///
/// The colours are those of the pictures for people; the pattern is made of smooth noise at five
/// scales, and patterns smaller than a pixel are left out. Everything follows from the place alone,
/// so that a place looks the same from everywhere.

#include <Eigen/Core>

#include "engine/api/forward.h"
#include "engine/imaging/ground_look.h"
#include "engine/imaging/ground_mask.h"

namespace vinerow::sensors {

class Turf {
 public:
  explicit Turf(const WorldModel& world);

  /// Linear RGB reflectance at (x, y). @param footprint_m  width of a pixel there
  Eigen::Vector3f albedo(double x, double y, double footprint_m) const;

 private:
  imaging::GroundMask mask_;
  imaging::GroundLook look_;
};

}  // namespace vinerow::sensors
