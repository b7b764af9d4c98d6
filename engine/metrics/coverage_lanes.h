#pragma once
/// Picture footprints by lane, and the overlap of neighbouring lanes (picture_coverage.h).

#include <cstdint>
#include <vector>

#include "engine/math/polygon.h"

namespace vinerow::metrics {

struct PictureFootprint {
  Polygon polygon_W;  ///< convex, counter-clockwise
  double area_m2 = 0.0;
  std::int32_t index = 0;  ///< of its picture
  int lane = -1;
  bool touches_parcel = false;
};

/// Side overlaps of every picture that touches the parcel with each neighbouring lane, if that has
/// pictures abreast of it or both before and after it along the lanes. Empty for fewer than two
/// lanes.
std::vector<double> side_overlaps(const std::vector<PictureFootprint>& footprints);

}  // namespace vinerow::metrics
